"""How the head sees the line that it follows: through which cells, how wide, and how dark at its edges.

Signals: the darkness behind the aperture; places and headings in sheet mm in, clean stations of the line out.
Other rooms see through a `View`; its methods call the kernels of this room.

Source: our own (see `rings`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from morfax.motion.arrays import Array, bounds
from morfax.motion.median import median
from morfax.motion.polyline import lengths_mm
from morfax.tracer.drawing.drawing import Darkness
from morfax.tracer.limits import ABOUT_WIDTHS, CLEAR_WIDTHS, FOLLOWS
from morfax.tracer.sensing import edge_scout, photocell, ray
from morfax.tracer.sensing.gauge import gauge
from morfax.tracer.sensing.photocell import STEP_PX, Cells
from morfax.tracer.sensing.scout import (
    CLEAN,
    FEWEST,
    LEG_MM,
    LEG_PX,
    REACH,
    REACH_PX,
    scout,
)

EDGE_LEG_PX = 4  # of a leg along an edge, at least
GRAIN = 0.4  # of the line's width: standard deviation of a cell that averages its grain
GRAIN_LEVEL = 0.3  # an edge is at this share of the darkness then
GRAIN_STATIONS = 20
STEP_WIDTHS = 0.1  # between the places that stand for a way where it is held against another


@dataclass(frozen=True)
class OtherInk:
    """The ink of other lines, onto which the head does not go: patches of the sheet by their numbers, and
    what finds the patch at a place. A head that is copied or kept on disk takes no copy of the sheet along.
    """

    patches: frozenset[int]
    patch_at: Callable[[Array], int] | None = field(default=None, compare=False, repr=False)

    def holds(self, place_mm: Array) -> bool:
        """Whether the ink at a place (2,) mm of the sheet is that of another line."""
        assert self.patch_at is not None
        return self.patch_at(place_mm) in self.patches

    def __deepcopy__(self, memo: dict[int, object]) -> OtherInk:
        return self

    def __getstate__(self) -> dict[str, object]:
        return {"patches": self.patches, "patch_at": None}


def leg_mm(width_mm: float, pitch_mm: float, pixels: float = LEG_PX) -> float:
    """How much of a leg is felt for its direction, of a line of a width, mm."""
    return max(LEG_MM, pixels * pitch_mm, CLEAR_WIDTHS * width_mm)


@dataclass(frozen=True, slots=True)
class View:
    """What the head knows of the line it is on: what the cells see, and the line's width.

    `usual_mm` is the line's width as a rule, where the width here differs. What the head sees is `enlarged`
    times as large as on the drawing. `on_edge`: it is the edge of a filled shape, dark to one side, and the
    width is that of a line which would be as fine. `parted`: so many of the sheet's pixels lie side by side
    in one of the scan's. `grainy`: the ink is that of a pencil or a dry pen, seen through a slit. `others` is
    the ink of other lines. `square`: the cell's sweep stands square to bends, and not to the heading.
    """

    cells: Cells
    width_mm: float
    usual_mm: float | None = None
    enlarged: float = 1.0
    on_edge: bool = False
    parted: int = 1
    grainy: bool = False
    others: OtherInk | None = None
    square: bool = False

    @property
    def pitch_mm(self) -> float:
        """Distance of the drawing's pixels."""
        return self.cells.pitch_mm

    @property
    def level(self) -> float:
        """Darkness at an edge."""
        return self.cells.level

    @property
    def step_mm(self) -> float:
        """Distance of stations and rings."""
        if self.on_edge:
            return STEP_PX * self.pitch_mm
        return max(0.05, 0.6 * self.pitch_mm)

    @property
    def leg_mm(self) -> float:
        """How much of a leg is felt for its direction."""
        return leg_mm(self.width_mm, self.pitch_mm, EDGE_LEG_PX if self.on_edge else LEG_PX)

    def at_level(self, level: float) -> View:
        """The view with another darkness at an edge."""
        return replace(self, cells=self.cells._replace(level=float(level)))

    def without_cells(self) -> View:
        """The view for those who ask for widths only: its cells see nothing."""
        return replace(self, cells=Cells(photocell.nothing(), self.pitch_mm, self.level))

    def darkness_at(self, place: Array) -> float:
        """Darkness at a place."""
        return float(photocell.darkness_at(self.cells, place[0], place[1]))

    def darkness_along(self, places: Array) -> Array:
        """Darkness at each of many places (n, 2) mm."""
        return np.asarray(photocell.darkness_along(self.cells, np.ascontiguousarray(places)))

    def dark(self, place: Array) -> bool:
        """Whether there is ink at a place."""
        return self.darkness_at(place) > self.level

    def seen_about(
        self, places: Array, reach_mm: float
    ) -> tuple[Darkness, tuple[int, int], Array]:
        """The darkness of a window that reaches so far about some places (n, 2) mm; the row and the column of
        the sheet at which it begins; and where its pixels are, (rows, columns, 2) mm.
        """
        (rows, columns), pitch = self.cells.shape, self.pitch_mm
        low, high = bounds(places)
        left, lowest = np.floor((low - reach_mm) / pitch).astype(int).tolist()
        right, highest = np.ceil((high + reach_mm) / pitch).astype(int).tolist()
        top, left = max(0, rows - highest), max(0, left)
        seen = self.cells.window(top, min(rows, rows - lowest), left, min(columns, right))
        i, j = np.indices(seen.shape)
        x, y = (j + left + 0.5) * pitch, (rows - i - top - 0.5) * pitch
        return seen, (top, left), np.stack([x, y], axis=-1)

    def is_others(self, place: Array) -> bool:
        """Whether the ink at a place is that of another line, onto which the head does not go."""
        return self.others is not None and self.others.holds(place / self.enlarged)

    def edges(self, place: Array, heading: float, reach_mm: float) -> tuple[float, float]:
        """Where the line under a place ends to the right and to the left of a heading, mm (see `ray`)."""
        found: tuple[float, float] = ray.edges(
            self.cells, place[0], place[1], heading, reach_mm
        )
        return found

    def ink_along(self, place: Array, heading: float, reach_mm: float) -> float:
        """How far the ink under a place goes on along a heading, past specks of paper, mm (see `ray`)."""
        return float(ray.edge_along(self.cells, place[0], place[1], heading, reach_mm))

    def ring(self, centre: Array, radius_mm: float) -> Array:
        """The arcs of ink round a centre, (n, 2) rad (see `photocell`)."""
        return np.asarray(photocell.ring(self.cells, centre, radius_mm))

    def feel(self, place: Array, heading: float, length_mm: float) -> Array:
        """Centres and widths (n, 3) of the line from a place on it along a heading, while it is clean."""
        stations = max(FEWEST, round(length_mm / self.step_mm) + 1)
        pose = float(place[0]), float(place[1]), float(heading)
        if self.on_edge:
            seen = edge_scout.along_edge(self.cells, pose, self.step_mm, stations)
            seen[:, 2] = self.width_mm
            return np.asarray(seen)
        return np.asarray(scout(self.cells, pose, self.width_mm, self.step_mm, stations))

    def feel_edge(self, place: Array, heading: float, length_mm: float) -> Array:
        """Places of an edge and how steep it is there (n, 3), from a place near it along a heading."""
        pose = float(place[0]), float(place[1]), float(heading)
        stations = max(FEWEST, round(length_mm / self.step_mm) + 1)
        return np.asarray(edge_scout.along_edge(self.cells, pose, self.step_mm, stations))

    def edge_at(self, place: Array) -> tuple[Array, float] | None:
        """The place on an edge next to a place, and the heading along it with the shape to the left."""
        x, y, inward_x, inward_y, _ = edge_scout.onto_edge(self.cells, place[0], place[1])
        if math.isnan(x):
            return None
        return np.array([x, y]), math.atan2(-inward_x, inward_y)

    def feel_along(self, way: Array) -> Array:
        """Centres and widths (n, 3) of the line across a way (n, 2) mm, a step apart, where it is clean."""
        if len(way) < 3:
            return np.empty((0, 3))
        come_mm = lengths_mm(way)
        every = way[np.searchsorted(come_mm, np.arange(0.0, come_mm[-1], self.step_mm))]
        reach = REACH * self.width_mm + REACH_PX * self.pitch_mm
        seen: list[tuple[float, float, float]] = []
        for place, before, after in zip(every[1:-1], every[:-2], every[2:], strict=True):
            heading = math.atan2(*(after - before)[::-1])
            right, left = self.edges(place, heading, reach)
            aside, width = 0.5 * (left + right), left - right
            if abs(width - self.width_mm) < CLEAN * self.width_mm:
                x = place[0] - aside * math.sin(heading)
                y = place[1] + aside * math.cos(heading)
                seen.append((x, y, width))
        return np.array(seen).reshape(-1, 3)

    def like(self, place: Array, heading: float, follows: float = FOLLOWS) -> View:
        """The view with the line's width and darkness about a place, if they are like those before.

        Lines swell and fade. The usual width follows by a share of how far the width differs from it.
        """
        widths_mm = float(self.width_mm), float(self.usual_mm or self.width_mm)
        pose = float(place[0]), float(place[1]), float(heading)
        level, width, usual = gauge(self.cells, pose, widths_mm, self.step_mm, follows)
        if math.isnan(level):
            return self
        cells = self.cells._replace(level=level)
        return replace(self, cells=cells, width_mm=width, usual_mm=usual)

    def through_larger(
        self, stations: Array, heading: float, looks_mm: Callable[[View], float]
    ) -> View:
        """The line through cells as large as it is wide, which average its grain.

        Its width and its darkness are those that these cells see at some stations (n, 3) of it. They see as
        far about the last station as `looks_mm` says of that view, and paper beyond.
        """
        places = stations[-GRAIN_STATIONS:, :2]
        larger = self._larger(places, ABOUT_WIDTHS * self.width_mm)
        darkness = median([larger.darkness_at(place) for place in places])
        larger = larger.at_level(GRAIN_LEVEL * darkness)
        found = [larger.edges(place, heading, ABOUT_WIDTHS * self.width_mm) for place in places]
        widths = [left - right for right, left in found if math.isfinite(left - right)]
        if not widths:
            return self
        larger = replace(larger, width_mm=median(widths))
        cells = self._larger(places[-1:], looks_mm(larger)).cells
        return replace(larger, cells=cells._replace(level=larger.level))

    def _larger(self, places: Array, beyond_mm: float) -> View:
        """The sheet about some places through cells as large as the line is wide."""
        sigma_px = GRAIN * self.width_mm / self.pitch_mm
        return replace(self, cells=self.cells.wider(sigma_px, places, beyond_mm))
