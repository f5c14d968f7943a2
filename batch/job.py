"""The job `batch`: many drawings traced alike, each into a folder of its own, with one manifest.

Signals in: a folder of drawings, or an address; where results go; what is done with each. Signals out: a row
for each drawing as it ends, which is in the manifest by then.

Source: our own. Questions: none.
"""

from __future__ import annotations

import os
from collections.abc import Generator, Iterator
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path

from morfax.batch import search
from morfax.batch.crew import Crew, WorkerLimits
from morfax.batch.manifest import Manifest
from morfax.batch.one import TraceOne, left_out
from morfax.batch.order import Order
from morfax.batch.results import LocalResults, RemoteResults
from morfax.batch.row import BatchRow
from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.tracing.tracing import Tracing
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import FileFault


@dataclass(frozen=True)
class BatchJob:
    """Trace all drawings of a folder; `out` is a folder, or an address on a cluster, whose manifest is here:
    in a folder of the address's last name.
    """

    drawings: str
    out: str
    order: Order = field(default_factory=Order)
    pattern: str | None = None
    limits: WorkerLimits = field(default_factory=WorkerLimits)
    scheduler: str | None = None

    def check(self) -> None:
        """Raise WrongUse and FileFault for what cannot be, before anything starts."""
        if self.scheduler is None:
            for place in (self.drawings, self.out):
                if search.is_address(place):
                    raise WrongUse(
                        f"{place} is read and written by a cluster's workers; give --scheduler, or a folder"
                    )
        if not search.is_address(self.drawings) and not Path(self.drawings).is_dir():
            raise FileFault(
                f"{self.drawings} is no folder; give a folder of drawings, and one drawing to morfax trace"
            )
        if not search.is_address(self.drawings) and next(self.names(), None) is None:
            what = "drawing" if self.pattern is None else f"file that fits {self.pattern}"
            raise FileFault(
                f"no {what} in {self.drawings}; check the folder, and the pattern (--glob)"
            )
        self.order.drawing.check()
        self.order.unit.check(self.order.program)
        Tracing.prepared(self.order.settings)  # reads the card and the settings

    def names(self) -> Iterator[str]:
        """The drawings, one after the other."""
        return search.drawings(self.drawings, self.pattern)

    @property
    def folder(self) -> Path:
        """The folder of the manifest."""
        return Path(
            self.out.rstrip("/").rsplit("/", 1)[-1] if search.is_address(self.out) else self.out
        )

    def rows(self, listener: Listener = SILENT) -> Generator[BatchRow, None, None]:
        """Trace; each row as it ends. Whoever stops asking ends the drawings that run and leaves the rest.

        Raises WrongUse, FileFault, CardFault, and Fault if no worker stays alive.
        """
        self.check()
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FileFault(
                f"cannot make the folder {self.folder}: {error.strerror}; give another one with -o"
            ) from None
        listener.compiling("the head", ("motion", "tracer", "recorder"))
        with Manifest(self.folder) as manifest, closing(self._ended()) as rows:
            for row in rows:
                manifest.append(row)
                yield row

    def _ended(self) -> Generator[BatchRow, None, None]:
        """The rows, from workers here or on a cluster."""
        local = LocalResults(self.folder)
        if self.scheduler is not None:
            from morfax.batch.cluster import Cluster

            results = RemoteResults(self.out) if search.is_address(self.out) else local
            yield from Cluster(self.scheduler, self.order, results).rows(self.names())
            return
        local.clear()
        crew = Crew(TraceOne(self.order, local), self.limits, local.clear)
        with closing(crew.rows(self.names())) as rows:
            for row in rows:
                yield left_out(self.order, row, local) if row.ending == "killed" else row


def cores() -> int:
    """How many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
