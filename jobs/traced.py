"""What comes of a traced drawing: the tape and the path, and the figures.

When the head loses the line, what it traced until then is kept, with `.incomplete` in the names, and the
fault is given beside.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from morfax.jobs import files as medium
from morfax.motion.faults import Fault

if TYPE_CHECKING:
    from morfax.jobs.listener import Listener
    from morfax.jobs.recording import RecordingUnit
    from morfax.motion.motion import Path
    from morfax.tracer.cutter.cutter import Cutter, Left
    from morfax.tracer.program.program import Trace


@dataclass(frozen=True, slots=True)
class Traced:
    """The program that the head made, its motion thinned to a path, and what the cutter cannot reach."""

    trace: Trace
    path: Path
    several: bool = False  # lines were asked for, not one line
    origin_mm: tuple[float, float] = (0.0, 0.0)  # the machine's zero on the sheet
    cutter: Cutter | None = None
    left: Left | None = None  # by the cutter

    @property
    def places_mm(self) -> list[tuple[str, tuple[float, float]]]:
        """Where each of several lines, or piece of one, begins, and its number."""
        return (
            [(str(line.number), line.start_mm) for line in self.trace.lines]
            if self.several
            else []
        )

    @property
    def fault(self) -> Fault | None:
        """The fault of a line that was lost."""
        return self.trace.fault

    def name(self, file: FilePath) -> FilePath:
        """The name for a result: marked if the line was lost."""
        return medium.incomplete(file) if self.fault else file

    def record(self, file: FilePath, unit: RecordingUnit, listener: Listener) -> FilePath:
        """Record the motion on a tape, or in the medium that the name says; the program's name."""
        unit.record(self.trace, self.name(file), listener)
        return self.name(file)

    def write(self, file: FilePath, unit: RecordingUnit) -> FilePath:
        """Write the path file, placed as the tape is; its name."""
        from morfax.motion.pathfile import write_path

        write_path(unit.placement.path(self.path), self.name(file))
        return self.name(file)

    def figures(self) -> dict[str, Any]:
        """What the head found, as figures."""
        return {
            "ending": self.trace.ending,
            "incomplete": True if self.fault else None,
            "length_mm": self.trace.length_mm,
            "duration_s": float(self.path.t_s[-1] - self.path.t_s[0]),
            "line_width_mm": self.trace.line_width_mm,
            "start_place_mm": self.trace.start_mm,
            "reference_place_mm": self.trace.reference_mm,
            "origin_place_mm": self.origin_mm if any(self.origin_mm) else None,
            **(self._of_lines() if self.several else {}),
            "stops": self._stops() or None,
            "junctions": self._junctions() or None,
            **self._of_cutter(),
        }

    def _of_cutter(self) -> dict[str, Any]:
        """The cutter, and what it cannot reach."""
        if self.cutter is None or self.left is None:
            return {}
        lines = [
            {
                "line_left_out": out.line,
                "length_mm": out.length_mm,
                "middle_place_mm": out.room.place_mm if out.room else None,
                "room_mm": out.room.wide_mm if out.room else None,
                "cutter_up_to_mm": out.room.passes_mm if out.room else None,
                "stops_left_out": list(out.stops) or None,
            }
            for out in self.left.lines
        ]
        rows = [
            {
                "unreached": k,
                "of_line": u.line,
                "place_mm": u.place_mm,
                "left_mm": u.left_mm,
                "stretch_mm": u.length_mm,
            }
            for k, u in enumerate(self.left.stretches, 1)
        ]
        told = {"cutter_diameter_mm": self.cutter.diameter_mm, "side": self.cutter.side}
        return {**told, "lines_left_out": lines or None, "unreached": rows or None}

    @property
    def marked_mm(self) -> dict[str, tuple[float, float]]:
        """Places to be marked in a picture: the stops, and what the cutter cannot reach, by name."""
        if self.left is None:
            return self.stops_mm
        out = {
            f"line {out.line} left out": out.room.place_mm
            for out in self.left.lines
            if out.room is not None
        }
        return {
            **self.stops_mm,
            **out,
            **{f"left {k}": u.place_mm for k, u in enumerate(self.left.stretches, 1)},
        }

    def _stops(self) -> list[dict[str, Any]]:
        """The stops, by number: what kind of mark, where, and where Z goes."""
        return [
            {
                "stop": action.halt.number,
                "mark": action.halt.kind,
                "stop_place_mm": action.halt.place_mm,
                "z_mm": [move.to_mm for move in action.moves],
            }
            for actions in self.trace.actions
            for action in actions
            if action.halt.number is not None
        ]

    def _junctions(self) -> list[dict[str, Any]]:
        """The junctions that the head came to on each line, in order, as the card's `turns` count them."""
        return [
            {
                "junction": k,
                **({"of_line": line.number} if self.several else {}),
                "junction_place_mm": place_mm,
            }
            for line in self.trace.lines
            for k, place_mm in enumerate(line.junctions_mm, 1)
        ]

    @property
    def stops_mm(self) -> dict[str, tuple[float, float]]:
        """Where the stops are, by number."""
        return {f"stop {row['stop']}": row["stop_place_mm"] for row in self._stops()}

    def _of_lines(self) -> dict[str, Any]:
        """What the head found of each line, in the order in which they are cut."""
        lines = [
            {
                "line": line.number,
                "ending": line.ending,
                "length_mm": line.length_mm,
                "line_width_mm": line.width_mm,
                "start_place_mm": line.start_mm,
            }
            for line in self.trace.lines
        ]
        return {
            "idle_mm": self.trace.idle_mm,
            "patches_left_out": self.trace.left_out,
            "ink_left_out_mm": self.trace.left_out_mm,
            "lines": lines,
        }
