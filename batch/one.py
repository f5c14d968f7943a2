"""One drawing of a batch: traced into a folder of its own. This is what a worker does, here or on a cluster.

Signals in: the order and the name of a drawing. Signals out: its files in `results`, and its row. Nothing
that the drawing does is raised: every fault of the tree, a lack of memory and a mistake of ours are rows.

Source: our own. Questions: the largest memory is that of the process since the drawing began; where the
system cannot be asked to count anew (any but Linux), since the process began.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from morfax.batch.order import Order
from morfax.batch.results import FIGURES, PATH, PICTURE, Results
from morfax.batch.row import NO_MEMORY, BatchRow, Ending
from morfax.jobs.listener import Silent
from morfax.jobs.trace import TraceJob, TraceOutputs
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import MISTAKE, Fault, FileFault
from morfax.motion.files import written_beside

if TYPE_CHECKING:
    from morfax.jobs.trace import TraceResult

OPENCV_NO_MEMORY = -4  # StsNoMem
NEEDED_MORE = (
    "needed more than the memory of one drawing; give more with --memory, or scan it coarser"
)


@dataclass(frozen=True)
class TraceOne:
    """The work of a worker: trace a drawing of this computer by the order, into the results."""

    order: Order
    results: Results

    def __call__(self, file: str) -> BatchRow:
        """Trace the drawing of this name."""
        return trace_one(self.order, Path(file), file, self.results)


@dataclass
class Remarks(Silent):
    """A listener that keeps warnings."""

    texts: list[str] = field(default_factory=list)

    def warning(self, text: str) -> None:
        """Keep a warning."""
        self.texts.append(text)


def trace_one(order: Order, file: Path, called: str, results: Results) -> BatchRow:
    """Trace a drawing, whose name in the manifest is `called`; its row."""
    began_s = time.monotonic()
    _count_memory_anew()
    try:
        row = _traced(order, file, called, results)
    except FileFault as fault:
        row = failed(called, "fault", fault.exit_code, str(fault))
    except Exception as error:
        if is_out_of_memory(error):
            row = failed(called, "no memory", NO_MEMORY, NEEDED_MORE)
        else:
            told = f"a mistake in morfax: {type(error).__name__}: {error}"
            row = failed(called, "mistake", MISTAKE, told)
    seconds = round(time.monotonic() - began_s, 3)
    return replace(row, seconds=seconds, memory_mb=_largest_memory_mb())


def is_out_of_memory(error: BaseException) -> bool:
    """Whether Python, numpy or OpenCV found no memory."""
    return isinstance(error, MemoryError) or getattr(error, "code", None) == OPENCV_NO_MEMORY


def there_already(order: Order, file: Path, called: str, results: Results) -> BatchRow | None:
    """The row of a drawing whose results are whole; None without any. Raises FileFault."""
    if order.force:
        return None
    name, hashed = order.folder_name(file)
    before = results.figures(name)
    if before is None:
        return None
    try:
        row = BatchRow.of(before)
    except TypeError:  # not ours
        return None
    return replace(
        row, file=called, hash=hashed, folder=name, kept=True, figures=_alone(row.figures)
    )


def left_out(order: Order, row: BatchRow, results: Results) -> BatchRow:
    """Write down that a drawing killed its workers, so that the next call leaves it out; the row."""
    try:
        name, hashed = order.folder_name(Path(row.file))
    except FileFault:
        return row
    row = replace(row, hash=hashed, folder=name)
    with results.folder(name) as folder:
        _write(folder, row)
    return row


def _traced(order: Order, file: Path, called: str, results: Results) -> BatchRow:
    """The row of a drawing that is there already, or is traced now."""
    before = there_already(order, file, called, results)
    if before is not None:
        return before
    name, hashed = order.folder_name(file)
    remarks = Remarks()
    with results.folder(name) as folder:
        outputs = TraceOutputs(folder / order.program.name, folder / PATH, folder / PICTURE)
        drawing = replace(order.drawing, file=file)
        job = TraceJob(drawing, outputs, order.settings, order.unit)
        try:
            result = job.run(remarks)
        except FileFault:
            raise
        except (Fault, WrongUse) as fault:
            row = failed(called, "fault", getattr(fault, "exit_code", 2), str(fault))
            _draw_sheet(job, folder / PICTURE)
        else:
            row = _ended(result, called, folder)
        row = replace(row, hash=hashed, folder=name, remarks=tuple(remarks.texts))
        _write(folder, row)
    return replace(row, figures=_alone(row.figures))


def _ended(result: TraceResult, called: str, folder: Path) -> BatchRow:
    """The row of a drawing that was traced, at least in part; draws its picture."""
    from morfax.reports.small_picture import draw_small, followed_share

    draw_small(result, folder / PICTURE)
    figures = dict(result.figures)
    figures.setdefault("ink_followed_share", followed_share(result))
    for key, value in figures.items():  # names of files, as they will be
        if isinstance(value, str) and value.startswith(str(folder)):
            figures[key] = Path(value).name
    figures["drawing"] = called
    fault = result.fault
    if fault is None:
        return BatchRow(called, "done", figures=figures)
    return BatchRow(
        called, "incomplete", code=fault.exit_code, fault=str(fault), figures=figures
    )


def _draw_sheet(job: TraceJob, picture: Path) -> None:
    """Draw the sheet of a drawing on which no line was found, if it can be read at all."""
    from morfax.reports.small_picture import draw_sheet

    try:
        scan = job.drawing.scanned()
    except (Fault, WrongUse):
        return
    draw_sheet(scan.pixels, picture)


def _write(folder: Path, row: BatchRow) -> None:
    """Write a row, with all of its figures, as the folder's figures.json."""
    from morfax.reports.table import as_json

    with written_beside(folder / FIGURES) as beside:
        beside.write_text(as_json(row.as_plain()) + "\n", encoding="utf-8")


def failed(called: str, ending: Ending, code: int, fault: str) -> BatchRow:
    """The row of a drawing that gave no result."""
    return BatchRow(called, ending, code=code, fault=" ".join(fault.split()))


def _alone(figures: Mapping[str, Any]) -> dict[str, Any]:
    """The figures that are one number or text each: lists are in figures.json."""
    return {
        key: value
        for key, value in figures.items()
        if isinstance(value, str | int | float) and value is not None
    }


def _count_memory_anew() -> None:
    """Have Linux count the largest memory of this process from here on."""
    if sys.platform != "linux":
        return
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        return


def _largest_memory_mb() -> float:
    """The largest memory of this process that was resident, MB."""
    try:
        status = Path("/proc/self/status").read_text()
        kib = next(line for line in status.splitlines() if line.startswith("VmHWM:")).split()[1]
        return round(int(kib) * 1024 / 1e6, 1)
    except (OSError, StopIteration):
        pass
    try:
        import resource
    except ImportError:  # Windows
        return 0.0
    unit = 1 if sys.platform == "darwin" else 1024
    return round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6, 1)
