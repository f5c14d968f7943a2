"""Strokes: which lines are on a drawing, and where the head may be put down; plans only, never the path.

Signals: a Drawing in; strokes out, each a connected patch of ink with its length, width and places near its
middle (sheet mm).

Ink is what is darker than half. A patch's width follows from the mean distance of its pixels to the paper,
its length from its area over its width, so that a patch needs no skeleton. An end is where a disc about a
middle place holds much less ink than elsewhere on the line.

Source: patent ES 361967 leaves the choice of the line to the operator, who brings the head over it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault, LineFault
from morfax.motion.median import median
from morfax.tracer.drawing.components import Patches
from morfax.tracer.drawing.contrast import LEAST_STROKE_MM, LEAST_STROKE_PX
from morfax.tracer.drawing.depth import depth_along
from morfax.tracer.drawing.discs import disc
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.inked import DEEPEST_PX, are_solid, depths_px, inked
from morfax.tracer.drawing.lengths import PIXELS_OFF, Told, one_pen_mm, told
from morfax.tracer.drawing.middles import deepest, ink_about
from morfax.tracer.drawing.nearest_ink import nearest_run
from morfax.tracer.drawing.numbering import InkSpread, longest_first
from morfax.tracer.effort import MANY

Pixels = NDArray[Any]
Answer = TypeVar("Answer")
Window = tuple[int, int, int, int]  # first row and column, row and column after the last

TILE_PX = 2048  # the places of a line come tile by tile, so that its size decides where the head begins
FEW_PLACES = 2000  # of a stroke that is kept: 48 kB
SMALL_PART = 0.4  # of a sheet; by trial
FLAW_WIDTHS = 1.0  # areas of paper less than so many across are flaws of ink; by trial
LESS = 0.85  # ink about an end, of what is usual: half, and what the middle place lies within the end


@dataclass(frozen=True)
class Stroke:
    """A connected patch of ink: places near the middle of its line (n, 2) mm, and the ink about each."""

    length_mm: float
    width_mm: float
    middles_mm: Array
    filled: Array
    patch: int

    def is_at(self, place_mm: Array) -> bool:
        """Whether a place is on this line."""
        return bool(np.hypot(*(self.middles_mm - place_mm).T).min() < self.width_mm)

    @cached_property
    def ends_mm(self) -> Array:
        """Places that may be ends of the line, most likely first, two widths apart or more; (n, 2) mm."""
        order = np.argsort(self.filled)
        places = self.middles_mm[order[self.filled[order] < LESS * median(self.filled)]]
        kept: list[Array] = []
        while len(places) and len(kept) < MANY:
            kept.append(places[0])
            places = places[np.hypot(*(places - places[0]).T) > 2 * self.width_mm]
        return np.array(kept).reshape(-1, 2)


@dataclass(frozen=True)
class Sheet:
    """The patches of ink on a drawing: their lengths and widths as lines, and which are filled shapes.

    `window`, first row and column and those after the last, is where the head will be: cells see paper
    elsewhere. `taken` are patches of other lines, onto which the head does not go.
    """

    drawing: Drawing
    patches: Patches
    lengths_mm: Array
    widths_mm: Array
    are_solid: NDArray[np.bool_]
    window: Window | None = None
    has_references: bool = True  # small crosses and rings may be reference points
    bare_rings: bool = False  # rings are, whatever the line from them leads to
    taken: frozenset[int] = frozenset()
    _known: dict[int, Stroke] = field(default_factory=dict, repr=False, compare=False)
    # what was asked of all its patches, and whether rings are bare: the same whatever the window or is taken
    _asked: dict[tuple[Callable[[Sheet], Any], bool], Any] = field(
        default_factory=dict, repr=False, compare=False
    )
    # what the cells see of it through the aperture that was asked for last (see `plain_places.view_of`)
    seen: dict[float, Any] = field(default_factory=dict, init=False, repr=False, compare=False)

    @classmethod
    def of(cls, drawing: Drawing) -> Sheet:
        """Find the patches; raises DrawingFault if none is long enough to be a line."""
        runs = inked(drawing)
        patches = Patches.of([runs])
        areas, shape = patches.areas, drawing.darkness.shape
        deep = np.bincount(patches.patch, depths_px(runs, shape), patches.count) / areas
        # a line of w pixels has depths 1, 2 … w/2 … 2, 1
        widths = np.maximum(4 * deep - 2, 1.0)
        lengths_mm, widths_mm = areas / widths * drawing.pitch_mm, widths * drawing.pitch_mm
        solid = are_solid(drawing, patches, widths_mm)
        sheet = cls(drawing, patches, lengths_mm, widths_mm, solid)
        if not sheet._long_enough().any():
            raise DrawingFault(
                f"no line on the drawing: nothing on it is {LEAST_STROKE_MM:g} mm and {LEAST_STROKE_PX:g} "
                "pixels long; check the file and its scale"
            )
        return sheet

    @property
    def told(self) -> Told:
        """Lengths and widths of the patches as lines, mm, as a reader is told them."""
        return self.once(told)

    def once(self, ask: Callable[[Sheet], Answer]) -> Answer:
        """What is asked of all patches; asked once of a sheet, with any window, and with any lines taken."""
        asked = ask, self.bare_rings
        if asked not in self._asked:
            self._asked[asked] = ask(self)
        answer: Answer = self._asked[asked]
        return answer

    def counting(self, lengths_mm: Array, told_lengths_mm: Array) -> Sheet:
        """The sheet on which the patches have other lengths, and others are told of them."""
        counted = replace(self, lengths_mm=lengths_mm, _known={}, _asked={})
        counted._asked[told, self.bare_rings] = self.told._replace(lengths_mm=told_lengths_mm)
        return counted

    def about(self, patch: int, around_mm: float) -> Sheet:
        """The sheet with a window about a patch; itself if that is no small part of it."""
        around_px = math.ceil(around_mm / self.drawing.pitch_mm)
        rows, columns = self.drawing.darkness.shape
        top, bottom, left, right = (int(edge) for edge in self.patches.boxes[patch])
        first = max(0, top - around_px), max(0, left - around_px)
        last = min(rows, bottom + around_px), min(columns, right + around_px)
        if (last[0] - first[0]) * (last[1] - first[1]) > SMALL_PART * rows * columns:
            return self
        return replace(self, window=(*first, *last))

    def longest(self) -> Stroke:
        """The longest line; of a sheet that has nothing else the longest rim of a filled shape."""
        are_lines = self._long_enough() & ~self.are_solid
        lengths_mm = one_pen_mm(self)
        if are_lines.any():
            lengths_mm = np.where(are_lines, lengths_mm, 0.0)
        long = np.flatnonzero(lengths_mm >= (1 - 2 * PIXELS_OFF) * lengths_mm.max())
        return self.stroke(int(self.longest_first(long)[0]))

    def longest_first(self, patches: Pixels) -> Pixels:
        """Some patches in the order of their numbers."""
        if len(patches) < 2:
            return patches
        runs = self.patches
        places_mm = self.run_middles_mm(np.arange(len(runs.row)))
        weights = (runs.end - runs.begin).astype(float)
        sums = [np.bincount(runs.patch, weights * column, runs.count) for column in places_mm.T]
        middles_mm = np.column_stack(sums)[patches] / runs.areas[patches][:, None]
        lengths_mm = self.told.lengths_mm[patches]
        return patches[longest_first(lengths_mm, middles_mm, InkSpread.of(places_mm, weights))]

    def nearest(self, place_mm: tuple[float, float], within_mm: float) -> Stroke:
        """The line nearest to a place; raises LineFault, with its place, if it is out of reach."""
        here_mm = float(place_mm[0]), float(place_mm[1])
        distance_mm, (x, y), patch = self._nearest_ink(here_mm, self._long_enough())
        if distance_mm > within_mm:
            raise LineFault(
                f"no line within {within_mm:g} mm of {place_mm[0]:g},{place_mm[1]:g} mm:"
                f" the nearest is {distance_mm:.1f} mm away, at {x:.1f},{y:.1f};"
                " start there, or leave --start out for the longest line",
                x_mm=place_mm[0],
                y_mm=place_mm[1],
                nearest_mm=(float(x), float(y)),
            )
        return self.stroke(patch)

    def is_solid_at(self, place_mm: Array) -> bool:
        """Whether the ink nearest to a place is the rim of a filled shape."""
        return bool(self.are_solid.any() and self.are_solid[self.patch_at(place_mm)])

    def patch_at(self, place_mm: Array) -> int:
        """The number of the patch whose ink is nearest to a place."""
        return self._nearest_ink((float(place_mm[0]), float(place_mm[1])))[2]

    def loops(self, widths: float = FLAW_WIDTHS) -> NDArray[np.int64]:
        """How many areas of paper that are so many widths across each patch goes round."""
        least_px = (widths * self.widths_mm / self.drawing.pitch_mm) ** 2
        return self.patches.enclosure.loops(least_px)

    def are_speckled(self) -> NDArray[np.bool_]:
        """Which patches are dark areas full of specks of paper, and no lines: most of their holes are flaws,
        and most others less than twice as large.
        """
        every, areas, broad = (self.loops(times * FLAW_WIDTHS) for times in (0, 1, 2))
        return np.asarray((every > 2 * areas) & (areas > 2 * broad))

    def _long_enough(self) -> NDArray[np.bool_]:
        """Which patches are long enough to be lines."""
        return self.lengths_mm >= max(LEAST_STROKE_MM, LEAST_STROKE_PX * self.drawing.pitch_mm)

    def _nearest_ink(
        self, place_mm: tuple[float, float], among: NDArray[np.bool_] | None = None
    ) -> tuple[float, Array, int]:
        """Distance of the ink nearest to a place, mm, where it is, and its patch; among some patches.
        Infinitely far, and no patch, if there is none.
        """
        runs, sheet = self.patches, (self.drawing.darkness.shape[0], self.drawing.pitch_mm)
        if not len(runs.row):
            return math.inf, np.zeros(2), -1
        own, counts = (runs.begin, runs.end, runs.patch), runs.every if among is None else among
        away_mm, x_mm, y_mm, run = nearest_run(own, runs.firsts, place_mm, sheet, counts)
        return float(away_mm), np.array([x_mm, y_mm]), int(runs.patch[run])

    def middles_mm(self, patches: Pixels) -> Array:
        """The middles of the boxes of some patches, (n, 2) sheet mm."""
        top, bottom, left, right = self.patches.boxes[patches].T
        rows = self.drawing.darkness.shape[0]
        middles_px = np.column_stack([0.5 * (left + right), rows - 0.5 * (top + bottom)])
        return np.asarray(middles_px * self.drawing.pitch_mm)

    def run_middles_mm(self, runs: Pixels) -> Array:
        """Middles of some runs of ink, (n, 2) sheet mm."""
        patches = self.patches
        columns = 0.5 * (patches.begin[runs] + patches.end[runs] - 1)
        return self.places_mm(patches.row[runs], columns)

    def run_begins_mm(self, runs: Pixels) -> Array:
        """First pixels of some runs of ink, (n, 2) sheet mm."""
        return self.places_mm(self.patches.row[runs], self.patches.begin[runs])

    def run_ends_mm(self, runs: Pixels) -> Array:
        """Last pixels of some runs of ink, (n, 2) sheet mm."""
        return self.places_mm(self.patches.row[runs], self.patches.end[runs] - 1)

    def places_mm(self, rows: Pixels, columns: Pixels) -> Array:
        """Centres of pixels, (n, 2) sheet mm."""
        up = self.drawing.darkness.shape[0] - rows
        return np.column_stack([columns + 0.5, up - 0.5]) * self.drawing.pitch_mm

    def stroke(self, patch: int) -> Stroke:
        """A patch as a line, with its middle places; that of a small patch is looked for once."""
        if patch in self._known:
            return self._known[patch]
        stroke = self._stroke(patch)
        if len(stroke.middles_mm) < FEW_PLACES:
            self._known[patch] = stroke
        return stroke

    def _stroke(self, patch: int) -> Stroke:
        """A patch as a line, looked for on its ink."""
        disc_px = max(4, round(1.5 * self.widths_mm[patch] / self.drawing.pitch_mm))
        top, bottom, left, right = self.patches.boxes[patch].tolist()
        halo_px = max(disc_px, min(DEEPEST_PX, bottom - top, right - left)) + 1
        tiles = [
            self._middles(
                patch,
                (disc_px, halo_px),
                (row, min(row + TILE_PX, bottom)),
                (column, min(column + TILE_PX, right)),
            )
            for row in range(top, bottom, TILE_PX)
            for column in range(left, right, TILE_PX)
        ]
        rows, columns, filled = (np.concatenate(part) for part in zip(*tiles, strict=True))
        return Stroke(
            float(self.lengths_mm[patch]),
            float(self.widths_mm[patch]),
            self.places_mm(rows, columns),
            filled.astype(float),
            patch,
        )

    def _middles(
        self,
        patch: int,
        disc_and_halo_px: tuple[int, int],
        rows: tuple[int, int],
        columns: tuple[int, int],
    ) -> tuple[Pixels, Pixels, Array]:
        """Row, column and ink about it of the pixels in a tile that lie deeper in the ink than all about."""
        disc_px, halo = disc_and_halo_px
        part = [
            edge for (a, b), size in zip((rows, columns), self.drawing.darkness.shape, strict=True)
            for edge in (max(0, a - halo), min(size, b + halo))
        ]  # fmt: skip
        row, begin, end = self.patches.runs_within(patch, *part)
        inner = rows[0] - part[0], rows[1] - part[0], columns[0] - part[2], columns[1] - part[2]
        depth = depth_along(row, begin, end, (part[1] - part[0], part[3] - part[2]))
        i, j = deepest(row, begin, end, depth, inner)
        filled = ink_about(row, begin, end, (i, j), disc(disc_px))
        return i + part[0], j + part[2], filled
