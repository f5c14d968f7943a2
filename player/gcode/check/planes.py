"""Planes of arcs: XY (G17), ZX (G18), YZ (G19); and chords of arcs that are not level.

Signals in: places in mm, words of a centre. Signals out: the same as if the plane was XY, and chords back.

Source: NIST RS274/NGC interpreter, version 3, section 3.5.3; Grbl 1.1, gcode.c, step 11 (axis_0, axis_1).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from morfax.player.gcode.arc_words import Place

CHORD_RAD = math.radians(5)  # of an arc that becomes lines: 0.1 % of its radius off
LEVEL = 17.0  # G17


@dataclass(frozen=True, slots=True)
class Plane:
    """The axes of a plane in the order of its angle, then the one across it; the letters of a centre."""

    axes: tuple[int, int, int]
    letters: str

    @property
    def names(self) -> frozenset[str]:
        """The letters of the plane's own axes."""
        return frozenset("XYZ"[axis] for axis in self.axes[:2])

    def turned_to(self, place: Place) -> Place:
        """A place with the plane's axes first."""
        a, b, c = self.axes
        return place[a], place[b], place[c]

    def centre_words(self, values: dict[str, float]) -> dict[str, float]:
        """The words of a centre, as if the plane was XY."""
        if "R" in values:
            kept = ("R", *self.letters)
            names = {"R": "R", self.letters[0]: "I", self.letters[1]: "J"}
            return {names[name]: values[name] for name in kept if values.get(name)}
        return {to: values.get(name, 0.0) for to, name in zip("IJ", self.letters, strict=True)}

    def chords(
        self, begin: Place, end: Place, centre: tuple[float, float], turned: float
    ) -> list[Place]:
        """Places along an arc that is not level, the end the last."""
        from_, to = self.turned_to(begin), self.turned_to(end)
        count = max(1, math.ceil(abs(turned) / CHORD_RAD))
        across = from_[0] - centre[0]
        up = from_[1] - centre[1]
        places: list[Place] = []
        for k in range(1, count):
            cos = math.cos(turned * k / count)
            sin = math.sin(turned * k / count)
            place = [0.0, 0.0, 0.0]
            place[self.axes[0]] = centre[0] + cos * across - sin * up
            place[self.axes[1]] = centre[1] + sin * across + cos * up
            place[self.axes[2]] = from_[2] + (to[2] - from_[2]) * k / count
            places.append((place[0], place[1], place[2]))
        return [*places, end]


PLANES = {
    LEVEL: Plane((0, 1, 2), "IJ"),
    18.0: Plane((2, 0, 1), "KI"),
    19.0: Plane((1, 2, 0), "JK"),
}
