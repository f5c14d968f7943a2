"""Knots on disk: where the head was on each of its runs, so that a run which was cut off goes on from there.

Signals in: knots of the head as they are kept (see `following.knots`), and what the run hangs on. Signals
out: files in a folder, one for each run of the head; and heads, when a killed server is started again.

Only the newest knot of a run is on disk, written beside and renamed, at most twice a second and for no more
than `SHARE` of the time. What is read back may hold plain values, arrays and classes of the tracer, and calls
nothing else: a panel's folder may come from anybody.

Source: our own. Questions: a knot of another version of morfax, or of a drawing, settings or corrections that
have changed, is passed over; the head begins anew then.
"""

from __future__ import annotations

import contextlib
import io
import pickle
import time
from collections.abc import Hashable
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from morfax.tracer.corrections.on_sheet import TurnAt
    from morfax.tracer.following.follower import Follower
    from morfax.tracer.following.knots import Memory

EVERY_S = 0.5  # between two writings
SHARE = 0.02  # of the time that may be spent on them
SUFFIX = ".knot"
DARKNESS = "darkness"  # stands for what the head sees, which is the drawing's
# of the packages that a head's state is made of; numpy's are those of its arrays and numbers
OF_NUMPY = {
    *("_reconstruct", "scalar", "_frombuffer", "ndarray", "dtype", "record"),
    *("float64", "float32", "int64", "int32", "int8", "bool_", "bool"),
}
OF_PYTHON = {"object", "set", "frozenset", "list", "dict", "tuple", "slice", "_reconstructor"}


class KeptKnots:
    """The folder with the newest knots of one run of the panel."""

    def __init__(self, folder: FilePath) -> None:
        self.folder = folder
        self._stamp = ""
        self._files: dict[Hashable, FilePath] = {}
        self._next_s, self._number = 0.0, 0

    def begin(self, stamp: str) -> None:
        """A run begins: what is kept of another is taken away."""
        self._stamp = stamp
        self.end()

    def end(self) -> None:
        """The run is done: nothing of it need be kept."""
        self._files, self._next_s = {}, 0.0
        with contextlib.suppress(OSError):
            for file in [*self.folder.glob(f"*{SUFFIX}"), *self.folder.glob("*.part")]:
                file.unlink()
            self.folder.rmdir()

    def keep(self, key: Hashable, at: tuple[TurnAt, ...], head: Follower) -> None:
        """Put a knot on disk, if the last one is some time ago; a full disk holds no head up."""
        if time.monotonic() < self._next_s or not head.carriage.travel_mm:
            return
        began_s = (
            time.thread_time()
        )  # of the processor: a busy computer is not the writing's fault
        if key not in self._files:
            self._number += 1
            self._files[key] = self.folder / f"{self._number}{SUFFIX}"
        file = self._files[key]
        with contextlib.suppress(OSError):
            self.folder.mkdir(exist_ok=True)
            content = _packed((self._stamp, key, at, head), head)
            beside = file.with_suffix(".part")
            beside.write_bytes(
                content
            )  # not flushed to the disk: a program that is killed loses none of it
            beside.replace(file)
        spent_s = time.thread_time() - began_s
        self._next_s = time.monotonic() + max(EVERY_S, spent_s / SHARE)

    def take_up(self, stamp: str, memory: Memory) -> float:
        """Have a memory know the knots of a run that was cut off; the travel of its heads, mm."""
        self._stamp, come_mm = stamp, 0.0
        for file in sorted(self.folder.glob(f"*{SUFFIX}")):
            kept = _read(file)
            if kept is None or kept[0] != stamp:
                continue
            _, key, at, head = kept
            self._number = max(self._number, int(file.stem) if file.stem.isdecimal() else 0)
            self._files[key] = file
            memory.take_in(key, at, head)
            come_mm += head.carriage.travel_mm / head.carriage.enlarged
        return come_mm


def _packed(kept: Any, head: Follower) -> bytes:
    """A knot as bytes, without what the head sees and who watches it."""
    out, seen = io.BytesIO(), head.view.cells.darkness
    watcher = head.carriage.shared()[0]

    class Packer(pickle.Pickler):
        def persistent_id(self, obj: Any) -> str | None:
            if obj is seen:
                return DARKNESS
            return "watcher" if obj is watcher and obj is not None else None

    Packer(out, protocol=pickle.HIGHEST_PROTOCOL).dump(kept)
    return out.getvalue()


class _Unpacker(pickle.Unpickler):
    """Reads values, arrays and classes of the tracer, and nothing else."""

    def __init__(self, content: bytes) -> None:
        super().__init__(io.BytesIO(content))
        self._seen = np.zeros((0, 0), np.float32)

    def persistent_load(self, pid: Any) -> Any:
        """What stands for the drawing is an empty one until the head is taken up on it."""
        return self._seen if pid == DARKNESS else None

    def find_class(self, module: str, name: str) -> Any:
        """A class by its name; raises UnpicklingError for one that a head is not made of."""
        package = module.split(".")[0]
        if module.startswith(("morfax.tracer.", "morfax.motion.")) and "." not in name:
            found = super().find_class(module, name)
            if isinstance(found, type) and found.__module__ == module:
                return found
        elif (package == "numpy" and name in OF_NUMPY) or (
            module in ("builtins", "copyreg") and name in OF_PYTHON
        ):
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"{module}.{name} is no part of a head")


def _read(file: FilePath) -> tuple[Any, Any, Any, Any] | None:
    """A knot on disk; None for a file that holds none."""
    try:
        kept = _Unpacker(file.read_bytes()).load()
        _, _, _, head = kept
        return kept if head.carriage.travel_mm > 0 else None
    except Exception:  # whatever a file may do to the reader
        return None
