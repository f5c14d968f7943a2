"""Work for the workers of the tests, which need no tracer: what a name says is done."""

from __future__ import annotations

import importlib
import os
import signal
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from morfax.batch.row import BatchRow

EATEN = bytearray()


@dataclass(frozen=True)
class Toy:
    """Sleep 1 ms, die, die once, hang, or eat memory; `folder` keeps who has died once."""

    folder: Path

    def __call__(self, file: str) -> BatchRow:
        """Do what the name's first word says."""
        kind = file.split("-")[0]
        once = self.folder / file
        if kind == "dies" or (kind == "once" and not once.exists()):
            once.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        if kind == "hangs":
            time.sleep(600)
        if kind == "eats":
            return self._eaten(file)
        time.sleep(0.001)
        return BatchRow(file, "done", seconds=0.001)

    def _eaten(self, file: str) -> BatchRow:
        """Ask for more memory than there is."""
        try:
            EATEN.extend(bytes(3_000_000_000))
        except MemoryError:
            return BatchRow(file, "no memory", code=3)
        return BatchRow(file, "done")


@dataclass(frozen=True)
class Twice:
    """Twice 21 s, by a kernel that numba keeps in `folder`; the module there is called `twice_loop`."""

    folder: Path

    def __call__(self, file: str) -> BatchRow:
        """Run the kernel."""
        sys.path.insert(0, str(self.folder))
        loop = importlib.import_module("twice_loop")
        return BatchRow(file, "done", seconds=float(loop.twice(21)))


class Stillborn:
    """Work over which a worker dies before it has begun anything."""

    def __reduce__(self) -> tuple[Any, ...]:
        return os._exit, (1,)

    def __call__(self, file: str) -> BatchRow:
        """Never be called."""
        raise AssertionError(file)
