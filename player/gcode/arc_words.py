"""The words of an arc in RS-274: centre and angle turned, from I and J or from R.

Signals in: the words of a G2 or G3 in the program's unit, begin and end in mm. Signals out: the centre in mm
and the angle turned in rad, positive counter-clockwise. A centre that is not quite as far from both ends is
moved to be so.

Source: RS-274-D as LinuxCNC reads it. Questions: how far the radii may differ is the control's own; without
another one the limits are Grbl's: a thousandth of the radius, from 5 um to 0.5 mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from morfax.motion.arrays import NOT_ZERO
from morfax.recorder.gcode.takes import ARC_MM, ARC_SHARE

TURN = 2 * math.pi

Place = tuple[float, float, float]
Centre = tuple[float, float]


class WordError(ValueError):
    """A word that makes no arc, and what is wrong with it."""

    def __init__(self, word: str, what: str) -> None:
        super().__init__(f"{word} {what}")
        self.word, self.what = word, what


@dataclass(frozen=True, slots=True)
class ArcLimits:
    """How far the ends of an arc may lie off one circle, mm; whether it may climb.

    The radii of both ends may differ by `least_mm`, or by a share of the radius up to `most_mm`; half the
    chord may exceed R by `reach_mm`, or, if that is None, by half of what the radii may differ.
    """

    least_mm: float = ARC_MM
    share: float = ARC_SHARE
    most_mm: float = 0.5  # as these, Grbl's
    reach_mm: float | None = None
    helix: bool = False

    def slack_mm(self, radius_mm: float) -> float:
        """The allowed difference between the distances of an arc's ends from its centre, mm."""
        return min(max(self.least_mm, self.share * radius_mm), self.most_mm)

    def beyond_mm(self, radius_mm: float) -> float:
        """How far half the chord may exceed the radius, mm."""
        return self.slack_mm(radius_mm) / 2 if self.reach_mm is None else self.reach_mm


OURS = ArcLimits()


@dataclass(frozen=True, slots=True)
class ArcWords:
    """G2 or G3 with its sense (+1 counter-clockwise), its words by their letters, and mm per unit."""

    kind: str
    sense: int
    values: dict[str, float]
    scale: float
    limits: ArcLimits = OURS

    def arc(self, begin: Place, end: Place) -> tuple[Centre, float]:
        """Centre and angle turned between two places; raises WordError."""
        values, given = self.values, "R" in self.values
        if end[2] != begin[2] and not self.limits.helix:
            raise WordError(
                f"Z{values['Z']:g}",
                "makes the arc a helix; this control turns arcs in X and Y: keep Z",
            )
        if given and ("I" in values or "J" in values):
            raise WordError(
                f"R{values['R']:g}", "stands with a centre, I or J; give one of the two"
            )
        centre = self._by_radius(begin, end) if given else self._by_offset(begin, end)
        first = math.atan2(begin[1] - centre[1], begin[0] - centre[0])
        last = math.atan2(end[1] - centre[1], end[0] - centre[0])
        turned = self.sense * (last - first) % TURN
        whole = begin[:2] == end[:2] or (turned < NOT_ZERO and not given)
        return centre, self.sense * (TURN if whole else turned)

    def _by_radius(self, begin: Place, end: Place) -> Centre:
        """The centre that leaves less than half a turn, or with a negative radius more."""
        given = self.values["R"]
        across = end[0] - begin[0]
        up = end[1] - begin[1]
        radius = given * self.scale
        chord = math.hypot(across, up)
        if chord == 0 or chord / 2 > abs(radius) + self.limits.beyond_mm(abs(radius)):
            more = f"{chord / 2:.4f} mm or more, or other ends"
            raise WordError(
                f"R{given:g}",
                f"does not reach: the ends of the arc are {chord:.4f} mm apart; give "
                + ("I and J for a whole turn" if chord == 0 else more),
            )
        height = math.sqrt(max(radius**2 - chord**2 / 4, 0.0))
        off = height * math.copysign(self.sense, self.sense * radius) / chord
        middle = (begin[0] + end[0]) / 2, (begin[1] + end[1]) / 2
        return middle[0] - off * up, middle[1] + off * across

    def _by_offset(self, begin: Place, end: Place) -> Centre:
        """The centre from I and J, moved to be as far from both ends."""
        given_i, given_j = self.values.get("I", 0.0), self.values.get("J", 0.0)
        i, j = given_i * self.scale, given_j * self.scale
        centre = begin[0] + i, begin[1] + j
        radius = math.hypot(i, j)
        other = math.dist(end[:2], centre)
        if radius == 0:
            raise WordError(self.kind, "has no centre; give I and J, or R")
        slack_mm = self.limits.slack_mm(radius)
        if abs(other - radius) > slack_mm:
            raise WordError(
                f"I{given_i:g} J{given_j:g}",
                f"is no centre of both ends: {radius:.4f} mm from the start, {other:.4f} mm from the "
                f"end; they may differ by {slack_mm:.4f} mm",
            )
        across = end[0] - begin[0]
        up = end[1] - begin[1]
        chord_squared = across**2 + up**2
        if chord_squared == 0:
            return centre
        along = (i * across + j * up) / chord_squared - 0.5
        return centre[0] - along * across, centre[1] - along * up
