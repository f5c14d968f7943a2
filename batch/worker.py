"""The worker's side of a batch: a process that traces one drawing after the other, on one core.

Signals in, through its own pipe: names of drawings; None ends it. Signals out: BEGUN when it takes up a
drawing, then its row. Its memory is limited by the system (RLIMIT_AS); it hears no Ctrl-C, since the parent
ends it.

Source: our own. Questions: Windows has no such limit, macOS does not keep it; there memory is not limited.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from functools import cache
from multiprocessing.connection import Connection

from morfax.batch.row import BatchRow
from morfax.jobs.damaged_kernels import compile_damaged_again

Work = Callable[[str], BatchRow]  # of the name of a drawing; can be pickled
BEGUN = "begun"
ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def serve(pipe: Connection, work: Work, memory_bytes: int | None) -> None:
    """Do what comes through the pipe, until it is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    keep_to_one_core()
    forgive_damaged_kernels()
    limit_memory(memory_bytes)
    while True:
        try:
            file = pipe.recv()
            if file is None:
                return
            pipe.send(BEGUN)
            pipe.send(work(file))
        except (EOFError, BrokenPipeError, ConnectionResetError):  # the parent is gone
            return


def keep_to_one_core() -> None:
    """Have numerical libraries use one thread; those that are loaded later as well."""
    for name in ONE_THREAD:
        os.environ[name] = "1"
    import cv2

    cv2.setNumThreads(1)


@cache  # a worker that is forked from a process that does need not begin again
def forgive_damaged_kernels() -> None:
    """Have kernels that numba keeps, and that are damaged on disk, compiled again, and told of once."""
    compile_damaged_again(lambda line: print(line, file=sys.stderr, flush=True))


def limit_memory(memory_bytes: int | None) -> None:
    """Limit the addresses of this process, where the system can."""
    if memory_bytes is None:
        return
    try:
        import resource
    except ImportError:  # Windows
        return
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    if most != resource.RLIM_INFINITY:
        memory_bytes = min(memory_bytes, most)
    try:
        resource.setrlimit(resource.RLIMIT_AS, (memory_bytes, most))
    except (ValueError, OSError):  # macOS: less than it has already
        return
