"""A traced drawing: the program that the head made, its path, and the files that are written from them.

When the head loses the line, the files hold what it traced before, with `.incomplete` in their names.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from morfax.jobs.figures import FEW_PLACES, MOST_PLACES
from morfax.jobs.media import files as medium
from morfax.jobs.remarks.stub_lines import StubLines
from morfax.jobs.remarks.two_lines import TwoLines
from morfax.jobs.settings import zero
from morfax.jobs.settings.zero import ZeroOnSheet
from morfax.jobs.tracing import trace_figures
from morfax.motion.faults import MotionFault
from morfax.motion.usual import PLOTTER_MM

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.jobs.listener import Listener
    from morfax.jobs.machine.recording import RecordingUnit
    from morfax.jobs.remarks.who_led import WhoLed
    from morfax.motion.faults import Fault
    from morfax.motion.motion import Path
    from morfax.recorder.media import Report
    from morfax.tracer.cutter.cutter import Cutter, Left
    from morfax.tracer.ink.left_out import Area
    from morfax.tracer.program.program import Trace

Place = tuple[float, float]
REACHED_MM = PLOTTER_MM / 2  # half a step of a plotter: so far below 0 a place is written as 0
SHEET = ZeroOnSheet("sheet")
NOT_TWO, NO_STUBS = TwoLines(), StubLines()


@dataclass(frozen=True, slots=True)
class Traced:
    """The program that the head made, its motion thinned to a path, and what the cutter cannot reach."""

    trace: Trace
    path: Path
    several: bool = False  # lines were asked for, not one line
    zero: ZeroOnSheet = SHEET  # of the program
    cutter: Cutter | None = None
    left: Left | None = None  # by the cutter
    led: WhoLed | None = None  # who led the head along the lines
    two: TwoLines = NOT_TWO  # lines that may be two side by side
    stubs: StubLines = NO_STUBS  # along which lines go out and back
    on_edges: bool = False  # of filled shapes, which have no line's width

    @property
    def fault(self) -> Fault | None:
        """The fault of a line that was lost."""
        return self.trace.fault

    @property
    def places_mm(self) -> list[tuple[str, Place]]:
        """The numbers of several lines, or of pieces of one, and where each begins."""
        if not self.several:
            return []
        return [(str(line.number), line.start_mm) for line in self.trace.lines]

    @property
    def left_out(self) -> tuple[Area, ...]:
        """Solid areas and letters that were left out."""
        return () if self.trace.ink is None else self.trace.ink.areas

    @property
    def marked_mm(self) -> dict[str, Place]:
        """Places that a picture marks, by name: stops, and what the cutter cannot reach."""
        stops_mm: dict[str, Place] = {
            f"stop {row['stop']}": row["stop_place_mm"]
            for row in trace_figures.stops(self.trace)
        }
        stops_mm |= {
            f"tab {row['tab']}": row["tab_place_mm"] for row in trace_figures.tabs(self.trace)
        }
        if self.trace.ink is not None:
            lost = self.trace.ink.lost[:MOST_PLACES]
            stops_mm |= {f"left {k}": (x, y) for k, (x, y, _) in enumerate(lost, 1)}
            single = self.trace.ink.single[:MOST_PLACES]
            stops_mm |= {f"two lines {k}": (x, y) for k, (x, y, _) in enumerate(single, 1)}
            pale = self.trace.ink.pale[:FEW_PLACES]
            stops_mm |= {f"pale {k}": (x, y) for k, (x, y, _) in enumerate(pale, 1)}
        beside = enumerate(self.trace.unexplained[:MOST_PLACES], 1)
        stops_mm |= {f"unexplained {k}": place.place_mm for k, place in beside}
        lost_mm = enumerate(self.trace.lost_outlines[:MOST_PLACES], 1)
        stops_mm |= {f"lost outline {k}": lost.place_mm for k, lost in lost_mm}
        stops_mm |= self.two.marked_mm | self.stubs.marked_mm
        if self.left is None:
            return stops_mm
        lines_mm = {
            f"line {out.line} left out": out.room.place_mm
            for out in self.left.lines
            if out.room is not None
        }
        stretches_mm = {f"left {k}": u.place_mm for k, u in enumerate(self.left.stretches, 1)}
        return {**stops_mm, **lines_mm, **stretches_mm}

    def placed(
        self, unit: RecordingUnit, program: FilePath | None, source: str = "", tool: str = ""
    ) -> RecordingUnit:
        """The recording unit with the zero of this program, and with what its head says, if it has one: the
        drawing's name and the tool as text, the size of the part, and where the zero is.
        """
        from morfax.recorder.gcode.made import Made

        start_mm = self.path.positions_mm[0]
        placed = unit.at(self.zero.origin_mm(unit.placement.about(start_mm)))
        placement = placed.placement.about(start_mm)
        if program is None or not medium.has_machine(program):
            return placed
        zero_mm = zero.on_sheet_mm(self.zero.asked, placement)
        made = Made(source, tool, self.zero.part_size_mm(placement), zero_mm)
        return replace(placed, made=made)

    def zero_figures(self, unit: RecordingUnit) -> Figures:
        """Where on the sheet the zero of the program is, if it is not the sheet's own."""
        return zero.figures(self.zero.asked, unit.placement.about(self.path.positions_mm[0]))

    def figures(self) -> dict[str, Any]:
        """What the head found, as figures."""
        if self.cutter is None or self.left is None:
            return self._figures_of_head()
        return self._figures_of_head() | trace_figures.of_cutter(self.cutter, self.left)

    def _figures_of_head(self) -> dict[str, Any]:
        """The same without those of the cutter."""
        trace = self.trace
        return {
            "ending": trace.ending,
            "incomplete": self.fault is not None or None,
            "length_mm": trace.length_mm,
            "duration_s": float(self.path.t_s[-1] - self.path.t_s[0]),
            "line_width_mm": None if self.on_edges else trace.line_width_mm,
            "edge_roughness_mm": trace.roughness_mm,
            "start_place_mm": trace.start_mm,
            "reference_place_mm": trace.reference_mm,
            **self._figures_of_lines(),
            "unexplained": trace_figures.unexplained(trace) or None,
            "lost_outlines": trace_figures.lost_outlines(trace) or None,
            **self.two.figures(),
            **self.stubs.figures(),
            "leads": trace_figures.leads(trace) or None,
            "stops": trace_figures.stops(trace) or None,
            "tabs": trace_figures.tabs(trace) or None,
            "passes_mm": list(trace.work.depths_mm) if trace.work.passes_mm else None,
            "junctions": trace_figures.junctions(trace, numbered=self.several) or None,
        }

    def _figures_of_lines(self) -> dict[str, Any]:
        """Who led the head, and each line where there may be several."""
        led = self.led.figures() if self.led else {}
        if not self.several:
            return led
        cell_shares = self.led.of_lines if self.led else {}
        return led | trace_figures.lines(self.trace, cell_shares, on_edges=self.on_edges)

    def name(self, file: FilePath) -> FilePath:
        """The name for a result: marked if the line was lost."""
        return medium.incomplete(file) if self.fault else file

    def record(
        self, file: FilePath, unit: RecordingUnit, listener: Listener
    ) -> tuple[FilePath, Report]:
        """Record the motion on a tape, or in the medium that the name says; the program's name, and what the
        recorder made. Raises MotionFault for a plotter that cannot come to all that is cut.
        """
        if medium.is_plot(file):
            self._refuse_beyond_corner(unit)
        report = unit.record(self.trace, self.name(file), listener)
        return self.name(file), report

    def _refuse_beyond_corner(self, unit: RecordingUnit) -> None:
        """Raise MotionFault for what is cut left of a plotter's corner or below it, with a zero that goes."""
        import numpy as np

        runs = unit.placement.path(self.path).runs()
        low_mm = np.vstack(runs).min(axis=0) if runs else np.zeros(2)
        if low_mm.min() >= -REACHED_MM:
            return
        placement = unit.placement.about(self.path.positions_mm[0])
        corner_mm = np.minimum(np.floor(low_mm), 0.0)  # the next whole mm
        x_mm, y_mm = placement.places_back(corner_mm[None])[0].tolist()
        raise MotionFault(
            f"the tool reaches to X {low_mm[0]:.2f}, Y {low_mm[1]:.2f} mm, beside the lines and on leads,"
            f" and a plotter begins at 0, 0; give --zero {x_mm:.1f},{y_mm:.1f}"
        )

    def write(self, file: FilePath, unit: RecordingUnit) -> FilePath:
        """Write the path file, placed as the tape is; its name."""
        from morfax.motion.pathfile import write_path

        write_path(unit.placement.path(self.path), self.name(file))
        return self.name(file)
