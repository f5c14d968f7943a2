"""The crew: worker processes on this computer, each of which may die without harm to the others.

Signals in: names of drawings, one after the other. Signals out: a row for each, as it ends. Each worker has a
pipe of its own to the parent, and nothing in common with the others, so that one that is killed can hold no
lock that another waits for. A worker that dies, or takes longer than the limit, is replaced:

    free ── name ──> starting ── BEGUN ──> busy ── row ──> free
                        │                   ├── over the limit ──> row, new worker
                        └── died ──> the name goes to another ──────── died twice while busy ──> row

The parent holds one name for each worker, and those that are to be tried again: its memory does not grow.

Source: our own. Of the pools that there are, `concurrent.futures` gives everything up when one worker dies,
`multiprocessing.Pool` waits for ever, and those with one pipe for all workers (pebble, billiard) hang or give
up when a worker is killed while it holds the pipe's lock, or before it has taken up anything.
Questions: none.
"""

from __future__ import annotations

import multiprocessing
import os
import sys
import time
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing import connection, forkserver
from multiprocessing.context import ForkServerContext, SpawnContext
from multiprocessing.process import BaseProcess
from pathlib import Path

from morfax.batch import worker
from morfax.batch.row import KILLED, OVER_LIMIT, SPOILT, BatchRow
from morfax.motion.faults import Fault
from morfax.motion.units import format_time_s

DEATHS = 2  # of workers, over one drawing
# workers in a row that died before they had taken up anything: something else is wrong
FUTILE = 20
WARM = ("morfax.batch.warm",)
ENDS_WITHIN_S = 5.0  # a worker that was told to end


@dataclass(frozen=True, slots=True)
class WorkerLimits:
    """How many workers, how long one drawing may take, s, and how much memory a worker has, bytes."""

    workers: int = 1
    limit_s: float | None = 120.0
    memory_bytes: int | None = 2_000_000_000


@dataclass
class BatchWorker:
    """A process, the parent's end of its pipe, and what it does."""

    process: BaseProcess
    pipe: connection.Connection
    file: str | None = None
    begun_s: float | None = None  # when it took the drawing up, by the monotonic clock

    def end(self) -> None:
        """Let a free worker go, and kill one that works."""
        if self.file is None:
            try:
                self.pipe.send(None)
            except OSError:
                pass
            else:
                self.process.join(ENDS_WITHIN_S)
        if self.process.is_alive():
            self.process.kill()
        self.process.join()
        self.process.close()
        self.pipe.close()


class Crew:
    """The workers of a batch; `killed` counts those that died, whoever killed them.

    `clear` is called when a worker has gone, to remove what it has left unfinished. `preload` is imported
    once, before the workers are forked; only that of the first crew of a process counts.
    """

    def __init__(
        self,
        work: worker.Work,
        limits: WorkerLimits,
        clear: Callable[[], None],
        preload: tuple[str, ...] | None = None,
    ) -> None:
        self._work, self._limits, self._clear = work, limits, clear
        self._context = _context(WARM if preload is None else preload)
        self._workers: list[BatchWorker] = []
        self._again: deque[str] = deque()
        self._deaths: dict[str, int] = {}  # of drawings that are to be tried again
        self._futile = 0
        self.killed = 0

    def rows(self, files: Iterable[str]) -> Generator[BatchRow, None, None]:
        """Have the drawings traced; a row for each as it ends, that of a drawing that killed two workers
        without a hash. Whoever stops asking ends the workers. Raises Fault if no worker stays alive.
        """
        rest = iter(files)
        try:
            while self._give_out(rest):
                yield from self._collected()
        finally:
            for one in self._workers:
                one.end()
            self._workers.clear()
            self._clear()

    @property
    def processes(self) -> list[int]:
        """The numbers of the workers' processes."""
        return [one.process.pid for one in self._workers if one.process.pid is not None]

    def _give_out(self, rest: Iterator[str]) -> bool:
        """Give every free worker a drawing, starting workers as they are needed; whether any has one."""
        while any(one.file is None for one in self._workers) or self._has_room:
            file = self._again.popleft() if self._again else next(rest, None)
            if file is None:
                break
            free = next((one for one in self._workers if one.file is None), None)
            free = self._started() if free is None else free
            free.file = file
            with suppress(OSError):  # it died while it was free; `_collected` finds it
                free.pipe.send(file)
        return any(one.file is not None for one in self._workers)

    @property
    def _has_room(self) -> bool:
        """Whether there are fewer workers than there may be."""
        return len(self._workers) < self._limits.workers

    def _collected(self) -> Iterator[BatchRow]:
        """Wait until something happens, and see to all workers to which it did."""
        ready = set(connection.wait([one.pipe for one in self._workers], self._patience_s()))
        for one in list(self._workers):
            row = self._heard(one) if one.pipe in ready else self._late(one)
            if row is not None:
                yield row

    def _patience_s(self) -> float | None:
        """How long to wait until a worker may be over its limit, s."""
        limit_s = self._limits.limit_s
        begun_s = [one.begun_s for one in self._workers if one.begun_s is not None]
        if limit_s is None or not begun_s:
            return None
        return max(0.0, min(begun_s) + limit_s - time.monotonic())

    def _heard(self, one: BatchWorker) -> BatchRow | None:
        """Take what a worker says: that it has begun, a row, or nothing any more."""
        try:
            said = one.pipe.recv()
        except (EOFError, OSError):
            return self._died(one)
        if said == worker.BEGUN:
            one.begun_s, self._futile = time.monotonic(), 0
            return None
        assert isinstance(said, BatchRow)
        self._deaths.pop(said.file, None)
        one.file = one.begun_s = None
        if said.ending in SPOILT:
            self._dismiss(one)
        return said

    def _late(self, one: BatchWorker) -> BatchRow | None:
        """The row of a drawing that takes longer than it may; its worker is replaced."""
        limit_s = self._limits.limit_s
        if limit_s is None or one.begun_s is None or one.file is None:
            return None
        seconds = time.monotonic() - one.begun_s
        if seconds < limit_s:
            return None
        file = one.file
        self._deaths.pop(file, None)
        self._dismiss(one)
        told = f"took longer than {format_time_s(limit_s)}; give more with --limit"
        return BatchRow(
            file, "over limit", code=OVER_LIMIT, fault=told, seconds=round(seconds, 3)
        )

    def _died(self, one: BatchWorker) -> BatchRow | None:
        """Replace a worker that died; the row of its drawing if it was the second one over it."""
        file, had_begun = one.file, one.begun_s is not None
        self._dismiss(one)
        if file is None:
            return None
        self.killed += 1
        if not had_begun:
            self._again.append(file)
            self._count_futile()
            return None
        deaths = self._deaths.get(file, 0) + 1
        if deaths < DEATHS:
            self._deaths[file] = deaths
            self._again.append(file)
            return None
        self._deaths.pop(file, None)
        told = (
            f"{DEATHS} workers died over it; trace it alone to see why, or do it with --force"
        )
        return BatchRow(file, "killed", code=KILLED, fault=told)

    def _count_futile(self) -> None:
        """Give up if worker after worker dies before it takes up anything."""
        self._futile += 1
        if self._futile >= FUTILE:
            raise Fault(
                f"{FUTILE} workers in a row died as they started; give more with --memory, or see what "
                "ends them (dmesg)"
            )

    def _dismiss(self, one: BatchWorker) -> None:
        """Let a worker go, and clear what it has left unfinished."""
        self._workers.remove(one)
        one.end()
        self._clear()

    def _started(self) -> BatchWorker:
        """A new worker."""
        ours, theirs = self._context.Pipe()
        arguments = theirs, self._work, self._limits.memory_bytes
        process = self._context.Process(target=worker.serve, args=arguments, daemon=True)
        process.start()
        theirs.close()  # so that the pipe ends when the worker does
        one = BatchWorker(process, ours)
        self._workers.append(one)
        return one


def _context(preload: tuple[str, ...]) -> SpawnContext | ForkServerContext:
    """How processes are started: forked from one that is warm, where forking is safe; else anew."""
    if sys.platform != "linux":
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(preload))
    before = os.environ.get("PYTHONPATH")
    # Python up to 3.12 does not hand its search path on
    os.environ["PYTHONPATH"] = os.pathsep.join(path or str(Path.cwd()) for path in sys.path)
    try:
        forkserver.ensure_running()
    finally:
        if before is None:
            del os.environ["PYTHONPATH"]
        else:
            os.environ["PYTHONPATH"] = before
    return context
