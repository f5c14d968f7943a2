"""Felt lines: a net's lines between its junctions, and how they come in there.

Signals: clean runs of a line in; the legs at its ends out.

Source: our own.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.tracer.ink.doubled import BROADER, LEAST_WIDTHS
from morfax.tracer.ink.run import Run
from morfax.tracer.sensing.leg import TURNS_OFF, Leg, turn

TRIMMED_SHARE = 0.3  # of a run is left out at an end at most; by trial on drawings of nets


@dataclass(slots=True)
class FeltLine:
    """A line between two junctions: its clean runs in order, and the numbers of the junctions at its ends.

    A ring has the same junction at both, where it was cut open. `length_mm` is that of its ink, and `parted`
    holds what was felt between one run and the next, (n, 2) mm. `ends_mm` is how far beyond its runs it ends,
    where that is known.
    """

    runs: list[Run]
    parted: list[Array]
    junctions: tuple[int, int]
    width_mm: float
    length_mm: float
    stretch: int = -1
    felt_mm: Array = field(default_factory=lambda: np.empty(0))  # the widths along all its ink
    ends_mm: tuple[float | None, float | None] = (None, None)

    @property
    def places_mm(self) -> Array:
        """Places along its clean runs, (n, 2) mm."""
        return np.vstack([run.places_mm for run in self.runs])


def end_leg(line: FeltLine, last: bool) -> Leg:
    """The leg at an end of a line as it comes in there."""
    return line.runs[-1].leg_in() if last else line.runs[0].leg_out().turned_round()


def trimmed(line: FeltLine, last: bool, trim_mm: float, legs_mm: float) -> None:
    """Leave out the stations at an end of a line that may have felt the junction, and make its leg longer."""
    k = len(line.runs) - 1 if last else 0
    run = line.runs[k]
    off = round(min(trim_mm, TRIMMED_SHARE * run.length_mm) / run.view.step_mm)
    kept = run.part(0, len(run) - off) if last else run.part(off, len(run))
    line.runs[k] = replace(
        kept, legs_mm=max(run.legs_mm, min(legs_mm, kept.length_mm)), _legs={}
    )


def without_waist(line: FeltLine, last: bool) -> None:
    """Leave out the run at an end of a line that is short, broader than the next, and straight before it.

    There another line crosses the line's own and ends: the ink of both is nearly as narrow as one's, and its
    middle is neither's.
    """
    while len(line.runs) > 1:
        ends = line.runs[::-1] if last else line.runs
        run, onward = ends[0], ends[1]
        legs = (
            (run.leg_in(), onward.leg_out()) if not last else (onward.leg_in(), run.leg_out())
        )
        is_straight = abs(turn(legs[0].heading_rad, legs[1].heading_rad)) < TURNS_OFF
        is_short = run.length_mm < LEAST_WIDTHS * line.width_mm
        is_broad = median(run.widths_mm) > BROADER * median(onward.widths_mm)
        if not (is_straight and is_short and is_broad and len(onward) > len(run)):
            return
        line.runs = line.runs[:-1] if last else line.runs[1:]
        line.parted = line.parted[:-1] if last else line.parted[1:]
