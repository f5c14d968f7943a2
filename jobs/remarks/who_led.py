"""Who led the head: the share of its way by the swinging cell, by stations, from memory and by redrawn ink.

Signals in: the traced lines, as the head followed them. Signals out: figures, a remark, and the runs of each
leader for the picture.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion.arrays import NOT_ZERO
from morfax.motion.long_array import one_in
from morfax.motion.median import median
from morfax.motion.usual import THINNED

if TYPE_CHECKING:
    from morfax.motion.arrays import Array
    from morfax.tracer.following.line import Line
    from morfax.tracer.program.program import Trace

# of the way outside of corners, junctions and tangles, which memory runs on any drawing: below that the
# operator is told. Of 25 fetched sheets those followed well have 0.72 and more, coarse ones 0.25 to 0.54
LEAST_CELL_SHARE = 0.6
# the `LEADERS` as a reader of the figures understands them
IN_WORDS = ("its_own_cell", "places_felt_ahead", "memory_of_corners", "redrawn_tangles")


@dataclass(frozen=True, slots=True)
class WhoLed:
    """How far each of the `LEADERS` led the head, mm, and the runs of each with their places (n, 2) mm.

    `of_lines`: the cell's share of each line, by its number, of the way that the head went: a cutter's path
    is another.
    """

    lengths_mm: tuple[float, ...]
    runs_mm: tuple[tuple[int, Array], ...] = ()
    of_lines: Mapping[int, float] = field(default_factory=dict)
    width_mm: float = 0.0  # of most lines

    @classmethod
    def along(cls, trace: Trace) -> WhoLed | None:
        """Who led along the lines that the head followed; None if it went nowhere."""
        from morfax.tracer.head.leaders import share_of_cell

        lines = [line for line in trace.lines if len(line.xy_mm) > 1 and line.led.firsts]
        if not lines:
            return None
        each_mm = [line.led.lengths_mm(line.xy_mm) for line in lines]
        lengths_mm = np.sum(each_mm, axis=0)
        if not lengths_mm.sum() > 0:
            return None
        runs = [run for line in lines for run in _runs(line)]
        of_lines = {
            line.number: share_of_cell(mm) for line, mm in zip(lines, each_mm, strict=True)
        }
        width_mm = median(np.array([line.width_mm for line in lines]))
        return cls(tuple(lengths_mm.tolist()), tuple(runs), of_lines, width_mm)

    @property
    def cell_share(self) -> float:
        """The share of the way that the swinging cell led."""
        return self.lengths_mm[0] / sum(self.lengths_mm)

    @property
    def cell_on_lines_share(self) -> float:
        """The share that it led outside of corners, junctions and tangles."""
        cell_mm, stations_mm = self.lengths_mm[:2]
        return cell_mm / max(cell_mm + stations_mm, NOT_ZERO)

    def figures(self) -> dict[str, Any]:
        """The share of each leader, and of the cell outside of corners, junctions and tangles."""
        all_mm = sum(self.lengths_mm)
        return {
            "cell_share": self.cell_share,
            "cell_on_lines_share": self.cell_on_lines_share,
            "led_by": {
                f"{name}_share": mm / all_mm
                for name, mm in zip(IN_WORDS, self.lengths_mm, strict=True)
            },
        }

    def remarks(self) -> Iterator[str]:
        """A remark if the cell led less than it should."""
        from morfax.jobs.remarks.scale_doubts import BROADEST_MM

        share = self.cell_on_lines_share
        if share < LEAST_CELL_SHARE:
            helps = (
                f"; if lines {self.width_mm:.1f} mm wide are filled shapes, --edge follows their outlines"
                if self.width_mm > BROADEST_MM
                else ", or scan at a higher resolution"
            )
            yield (
                f"the swinging cell led the head only {100 * share:.0f} % of the way between corners and"
                " crossings, places felt ahead led the rest: --picture shows where; check the path there"
                f"{helps}"
            )


def _runs(line: Line) -> Iterator[tuple[int, Array]]:
    """The thinned runs of each leader along a line."""
    for leader, positions in line.led.runs(line.xy_mm):
        yield leader, np.vstack([one_in(positions[:-1], THINNED), positions[-1:]])
