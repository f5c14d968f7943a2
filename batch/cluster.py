"""A batch on a Dask cluster: the same work as a worker's here, on workers that come and go.

Signals in: names of drawings, or addresses that fsspec knows. Signals out: a row for each, as it ends.

    drawings           results           who reads and writes
    scans/             out/              this computer: bytes are sent there and back
    scans/             s3://bucket/out   bytes are sent there, the worker writes
    s3://bucket/scans  out/              the worker reads, bytes are sent back
    s3://bucket/scans  s3://bucket/out   the worker; nothing but rows comes back

Dask itself gives a drawing to another worker when one dies, and gives it up after as many as the scheduler
allows (`distributed.scheduler.allowed-failures`). Only some drawings per worker are on their way at a time.

Source: dask.distributed, `Client.submit` and `as_completed`. Questions: files that options name (a card, a
machine) are opened by the workers, and have to be at the same place there.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from morfax.batch.one import failed, there_already, trace_one
from morfax.batch.order import Order
from morfax.batch.results import LocalResults, RemoteResults, Results, file_system
from morfax.batch.row import KILLED, BatchRow
from morfax.batch.search import is_address
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import MISTAKE, FileFault

if TYPE_CHECKING:
    from distributed import Client

AHEAD = 4  # drawings on their way for each thread of the cluster, so that none waits
CONNECT_S = 20.0
RETRIES = 2  # of a drawing whose worker could not be reached
EXTRA = "--scheduler needs dask: pip install 'morfax[cluster]'"

Files = dict[str, bytes]


@dataclass(frozen=True)
class There:
    """The work of a worker of a cluster; it writes to `address`, or sends its files back."""

    order: Order
    address: str | None

    def __call__(self, file: str, sent: Files | None) -> tuple[BatchRow, Files]:
        """Trace a drawing that was sent, or is read from its address; its row and its files."""
        from morfax.batch import worker

        worker.keep_to_one_core()
        with TemporaryDirectory(prefix="morfax-") as folder:
            here = Path(folder, "in")
            here.mkdir()
            for name, held in (_fetched(file) if sent is None else sent).items():
                (here / name).write_bytes(held)
            out = Path(folder, "out")
            results: Results = (
                LocalResults(out) if self.address is None else RemoteResults(self.address)
            )
            row = trace_one(self.order, here / _name(file), file, results)
            row = replace(row, fault=row.fault.replace(str(here / _name(file)), file))
            written = out / row.folder
            if self.address is not None or not row.folder:
                return row, {}
            return row, {made.name: made.read_bytes() for made in written.iterdir()}


@dataclass
class Cluster:
    """A cluster that traces drawings by the order; results go to an address, or to a folder here."""

    scheduler: str
    order: Order
    results: LocalResults | RemoteResults

    def rows(self, files: Iterable[str]) -> Iterator[BatchRow]:
        """Have the drawings traced; a row for each as it ends. Raises WrongUse without dask, FileFault if
        there is no scheduler.
        """
        try:
            from distributed import Client, as_completed
        except ImportError:
            raise WrongUse(EXTRA) from None
        try:
            client = Client(self.scheduler, timeout=CONNECT_S, set_as_default=False)
        except (OSError, ValueError) as error:
            raise FileFault(
                f"no scheduler answers at {self.scheduler} ({error}); start one with dask scheduler"
            ) from None
        with client:
            yield from self._gathered(client, iter(files), as_completed(loop=client.loop))

    def _gathered(self, client: Client, rest: Iterator[str], flight: Any) -> Iterator[BatchRow]:
        """Keep some drawings on their way, and give out rows as they come."""
        under_way: dict[str, str] = {}  # names, by the key of what is done with them
        while True:
            most = AHEAD * max(1, sum(client.nthreads().values()))
            while len(under_way) < most:
                file = next(rest, None)
                if file is None:
                    break
                before = self._before(file)
                if before is not None:
                    yield before
                    continue
                future = self._submitted(client, file)
                under_way[future.key] = file
                flight.add(future)
            if not under_way:
                return
            future = next(flight)
            yield self._row(under_way.pop(future.key), future)

    def _before(self, file: str) -> BatchRow | None:
        """The row of a drawing of this computer whose results are here already, or that cannot be read."""
        try:
            if not is_address(file) and isinstance(self.results, LocalResults):
                return there_already(self.order, Path(file), file, self.results)
            return None
        except FileFault as fault:
            return failed(file, "fault", fault.exit_code, str(fault))

    def _submitted(self, client: Client, file: str) -> Any:
        """Send a drawing, or its address, on its way."""
        address = self.results.address if isinstance(self.results, RemoteResults) else None
        sent = None if is_address(file) else self._files_of(Path(file))
        return client.submit(
            There(self.order, address), file, sent, pure=False, retries=RETRIES
        )

    def _files_of(self, file: Path) -> Files:
        """A drawing of this computer with its corrections, to be sent; without those that cannot be read."""
        found = Files()
        for part in (file, self.order.drawing.corrections.found(file)):
            if part is not None:
                with suppress(OSError):
                    found[part.name] = part.read_bytes()
        return found

    def _row(self, file: str, future: Any) -> BatchRow:
        """The row of a drawing that has ended; files that were sent back are written."""
        from distributed import KilledWorker

        try:
            row, files = future.result()
        except KilledWorker as error:
            return BatchRow(file, "killed", code=KILLED, fault=str(error))
        except Exception as error:
            return failed(file, "mistake", MISTAKE, f"{type(error).__name__}: {error}")
        assert isinstance(row, BatchRow)
        if files:
            with self.results.folder(row.folder) as folder:
                for name, held in files.items():
                    (folder / name).write_bytes(held)
        return row


def _name(file: str) -> str:
    """The name of a file or of an address without its folders."""
    return file.replace("\\", "/").rsplit("/", 1)[-1]


def _fetched(address: str) -> Files:
    """A drawing at an address, with its corrections if they are beside it; raises OSError."""
    from morfax.tracer.corrections import beside

    system, path = file_system(address)
    found = {_name(address): bytes(system.cat_file(path))}
    corrections = str(Path(path).parent / beside(Path(path)).name)
    if system.exists(corrections):
        found[_name(corrections)] = bytes(system.cat_file(corrections))
    return found
