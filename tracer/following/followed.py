"""Followed: what one run of the head came to.

Signals: positions of the X and Y screws (n, 2) mm at the motion rate, and what the head met on the way; out
the same, a run into its own way cut off there.

    closed    the head is back where it began, on the same heading
    ended     the line ended
    joined    the line ran into what the head has followed already: a lead line and its loop (see `loop`)
    lost      no clean line could be found from there on
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.motion.polyline import lengths_by_blocks
from morfax.tracer.head.leaders import Led
from morfax.tracer.head.loop import loop_in
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.sensing.view import View


@dataclass(slots=True)
class Followed:
    """What the head did: positions (n, 2) mm at the motion rate, the ending, and the fault of a lost line."""

    positions_mm: Array
    ending: str
    heading_rad: float
    travel_mm: float
    view: View
    junctions_mm: tuple[tuple[float, float], ...]  # in the order in which the head came to them
    fault: LineFault | None = None
    loop_from: int | None = None  # the position where the loop of a joined line begins
    guides: tuple[GuideLine, ...] = ()
    at_tip: bool = False  # another line, not followed yet, ends in the same tip
    went_slowly: bool = False  # the slow cell led for a stretch
    # junctions where another way out fits as well: the junction's number, and the rank of that way
    doubts: tuple[tuple[int, int], ...] = ()
    # numbers of the corrections that the head went by at junctions
    served: frozenset[int] = frozenset()
    led: Led = field(default_factory=Led)

    @property
    def loop_mm(self) -> Array:
        """Positions of the loop, without the lead line before it, (n, 2) mm."""
        return self.positions_mm[self.loop_from or 0 :]


def without_repeat(run: Followed) -> Followed:
    """A joined run cut off where it came back to its own way, with the loop that it made."""
    found = loop_in(run.positions_mm, run.view.width_mm)
    if found is None:
        return run
    first, last = found
    kept = run.positions_mm[: last + 1]
    *_, (_, _, lengths) = lengths_by_blocks(kept)
    travel_mm = float(lengths[-1])
    return replace(run, positions_mm=kept, travel_mm=travel_mm, loop_from=first)
