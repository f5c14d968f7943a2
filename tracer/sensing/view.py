"""How the head sees the line that it is on: through which cells, how wide, and how dark at its edges.

Signals: the darkness behind the aperture; places and headings in sheet mm in, clean stations of the line out.

Source: our own (see `knot`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import lengths_mm
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.photocell import Cells

LEVEL = 0.5  # an edge is at this share of the line's darkness
LEG_MM = 1.2  # how much of a leg is felt for its direction, at a line of 0.5 mm
GRAIN = 0.4  # of the line's width: standard deviation of a cell that averages its grain
GRAIN_LEVEL = 0.3  # an edge is at this share of the darkness then
GRAIN_STATIONS = 20


@dataclass(frozen=True, slots=True)
class View:
    """What the head knows of the line it is on: the cells' picture, the line's width, and the darkness at an
    edge.
    """

    cells: Cells
    pitch_mm: float
    width_mm: float
    level: float
    usual_mm: float | None = None  # the line's width as a rule, where the width here differs
    # times: what the head sees is so many times as large as on the drawing
    enlarged: float = 1.0

    @property
    def step_mm(self) -> float:
        """Distance of stations and rings."""
        return max(0.05, 0.6 * self.pitch_mm)

    @property
    def leg_mm(self) -> float:
        """How much of a leg is felt for its direction."""
        return max(LEG_MM, 12 * self.pitch_mm, 1.5 * self.width_mm)

    def feel(self, place: Array, heading: float, length_mm: float) -> Array:
        """Centres and widths (n, 3) of the line from a place on it along a heading, while it is clean."""
        stations = max(4, round(length_mm / self.step_mm) + 1)
        return photocell.scout(
            self.cells,
            self.pitch_mm,
            place,
            heading,
            self.step_mm,
            stations,
            self.width_mm,
            self.level,
        )

    def feel_along(self, way: Array) -> Array:
        """Centres and widths (n, 3) of the line across a way (n, 2) mm, a station's distance apart, wherever
        it is clean.
        """
        if len(way) < 3:
            return np.empty((0, 3))
        come_mm = lengths_mm(way)
        every = way[np.searchsorted(come_mm, np.arange(0.0, come_mm[-1], self.step_mm))]
        reach, seen = (
            photocell.REACH * self.width_mm + photocell.REACH_PX * self.pitch_mm,
            list[tuple[float, ...]](),
        )
        for place, before, after in zip(every[1:-1], every[:-2], every[2:], strict=True):
            heading = math.atan2(*(after - before)[::-1])
            right, left = photocell.edges(
                self.cells, self.pitch_mm, place[0], place[1], heading, reach, self.level
            )
            aside = 0.5 * (left + right)
            if abs(left - right - self.width_mm) < photocell.CLEAN * self.width_mm:
                seen.append(
                    (
                        place[0] - aside * math.sin(heading),
                        place[1] + aside * math.cos(heading),
                        left - right,
                    )
                )
        return np.array(seen).reshape(-1, 3)

    def like(self, place: Array, heading: float, follows: float = 0.1) -> View:
        """The view with the width and the darkness that the line has about a place, if they are like what
        they were: lines swell and fade.

        The usual width follows by a share of how far the width differs from it.
        """
        way = np.array([math.cos(heading), math.sin(heading)])
        places = [
            place + 2 * k * self.step_mm * way for k in range(5)
        ]  # more of them than a speck spoils
        ink = float(
            np.median(
                [photocell.darkness_at(self.cells, self.pitch_mm, p[0], p[1]) for p in places]
            )
        )
        level = LEVEL * min(max(ink, self.level), 4 * self.level)
        reach = 1.5 * self.width_mm + 2 * self.pitch_mm
        found = [
            photocell.edges(self.cells, self.pitch_mm, p[0], p[1], heading, reach, level)
            for p in places
        ]
        width = float(
            np.median([left - right for right, left in found])
        )  # NaN if any has no edge
        usual = self.usual_mm or self.width_mm
        if not 0.5 < width / usual < 1.6:
            return self
        return replace(
            self, width_mm=width, level=level, usual_mm=usual + follows * (width - usual)
        )

    def through_larger(self, stations: Array, heading: float) -> View:
        """The line through cells as large as it is wide, which average its grain; its width and its darkness
        as seen so at some stations (n, 3) of it.
        """
        sigma_px = GRAIN * self.width_mm / self.pitch_mm
        cells = np.asarray(cv2.GaussianBlur(self.cells, (0, 0), sigma_px), np.float32)
        places = stations[-GRAIN_STATIONS:, :2]
        level = GRAIN_LEVEL * float(
            np.median([photocell.darkness_at(cells, self.pitch_mm, x, y) for x, y in places])
        )
        reach = 3 * self.width_mm
        found = [
            photocell.edges(cells, self.pitch_mm, x, y, heading, reach, level)
            for x, y in places
        ]
        widths = [left - right for right, left in found if math.isfinite(left - right)]
        return (
            replace(self, cells=cells, level=level, width_mm=float(np.median(widths)))
            if widths
            else self
        )

    def dark(self, place: Array) -> bool:
        """Whether there is ink at a place."""
        return bool(
            photocell.darkness_at(self.cells, self.pitch_mm, place[0], place[1]) > self.level
        )
