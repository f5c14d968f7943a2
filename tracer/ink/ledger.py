"""The ledger: how much of a sheet's ink the strokes have followed, and what is left.

Signals: the sheet as it was felt, and the ways of the head, (n, 2) sheet mm, in; the balance out, mm of line
by the area of its ink, and what was left out, by reason.

Thinned ink near to a way has been followed (see `bare`). Ink that two lines share is followed by two strokes.

Source: our own; the patent has one contour to a tape.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.neighbours import Neighbours
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.effort import LOOKED_MM
from morfax.tracer.ink.bare import Bare, Thinned, places_along
from morfax.tracer.ink.hatching import Hatching, hatching
from morfax.tracer.ink.left_out import Area, InkLeft
from morfax.tracer.ink.missed_ink import Missed, missed_ink
from morfax.tracer.ink.pale import Pale, pale_lines
from morfax.tracer.ink.stretches import FeltSheet

SPECK_MM = 2.0  # a shorter patch of ink on which no stroke runs is a speck ...
DOT_WIDTHS = 2.5  # ... and one that is no longer in its own widths a dot; 1.8 is a round one
HALF = 0.5
TWO_LINES = 1.0  # pen's widths: a way no further from the middle of doubled ink runs in it
# of doubled ink: its lines bend, and are a little longer or shorter than its middle
ONCE_SHARE = 0.1


Patch = tuple[float, float, float]  # about where its middle is, and its length, mm


class Balance(NamedTuple):
    """The ink of a sheet, mm of line by its area: followed, left, specks, and the rims of filled shapes.

    `lost`: parts of stretches on which no stroke runs, (place X, place Y, length) mm, the longest first.
    `letters_mm` of lettering were left out, `lettering_mm` followed. `areas`: solid areas and letters that
    were left out. `hatching`: families of strokes that are hatching, and were followed. `pale`: lines too
    pale to be ink. `single`: stretches of doubled ink (see `doubled`) along which only one stroke runs.
    `dots`: specks that are broader than two lines, and no solid areas: place X, Y and mm across.
    """

    followed_mm: float
    left_mm: float
    specks_mm: float
    solid_mm: float
    lost: tuple[Patch, ...] = ()
    letters_mm: float = 0.0
    lettering_mm: float = 0.0
    areas: tuple[Area, ...] = ()
    hatching: tuple[Hatching, ...] = ()
    pale: tuple[Pale, ...] = ()
    single: tuple[Patch, ...] = ()
    dots: tuple[Patch, ...] = ()
    outlines_asked: bool = False  # round the solid areas

    @property
    def pale_mm(self) -> float:
        """The length of all pale lines."""
        return sum(line.length_mm for line in self.pale)

    @property
    def single_mm(self) -> float:
        """The length of lines that share their ink with another, along which no stroke of their own runs."""
        return sum(length_mm for _, _, length_mm in self.single)

    @property
    def all_mm(self) -> float:
        """The length of the lines' ink: what was left out on purpose apart."""
        return max(self.followed_mm + self.left_mm + self.pale_mm + self.single_mm, NOT_ZERO)

    @property
    def solids(self) -> list[Area]:
        """The solid areas, the largest first."""
        return [area for area in self.areas if area.what == "solid area"]

    @property
    def followed_share(self) -> float:
        """Share of the lines' ink, pale and doubled lines too, along which strokes run."""
        return self.followed_mm / self.all_mm


def balance(
    sheet: Sheet, felt: FeltSheet, thinned: Thinned, left: InkLeft, ways: list[Array]
) -> Balance:
    """What has been followed along some ways (n, 2) mm, and what is left."""
    # 1. which of the thinned pixels are a way's
    graph, run = felt.graph, places_along(ways)
    places, patch = thinned.places_mm, thinned.patch
    is_near = thinned.near(run)
    # 2. by patches; a burr of a line's edge is the middle of no line
    are_on, count = graph.on_stretches(), sheet.patches.count
    pixels = np.maximum(np.bincount(patch[are_on], minlength=count), 1)
    shares = np.bincount(patch[are_on], is_near[are_on], count) / pixels
    lengths_mm, solid = _line_lengths_mm(sheet, left, thinned.usual_mm), sheet.are_solid
    are_small = lengths_mm < np.maximum(SPECK_MM, DOT_WIDTHS * sheet.widths_mm)
    specks = ~solid & ~left.letters & (shares == 0) & are_small
    lines = ~solid & ~left.letters & ~specks
    # 3. ink beside the strokes, of which the thinned pixels show nothing; strokes that swell, as those of
    # printed letters do, tell no pen
    single, lost = dict(_single(felt, places, run)), list(thinned.bare(graph, is_near))
    pen_mm = felt.doubled.pen_mm if felt.doubled.stations else math.inf
    are_of_a_pen = lines & (shares > 0) & ~left.lettering & (felt.doubled.pen_mm > 0)
    of_lines_mm = np.minimum(thinned.wide_mm, pen_mm) * are_of_a_pen
    pieces = missed_ink(sheet, left, run, of_lines_mm)
    told = np.zeros(len(places), bool)
    for n in single:
        told[graph.stretches[n].pixels] = True
    for part in lost:
        told[graph.stretches[part.stretch].pixels[part.first : part.last]] = True
    missed, missed_mm = _missed(pieces, Neighbours(places), told, is_near)
    return Balance(
        float(np.sum((shares * lengths_mm)[lines])) - missed_mm,
        float(np.sum(((1 - shares) * lengths_mm)[lines])) + missed_mm,
        float(lengths_mm[specks & (left.solid_px == 0)].sum()),
        float(lengths_mm[solid].sum()),
        _longest_first([*map(_patch, lost), *missed]),
        float(lengths_mm[left.letters].sum()),
        float((shares * lengths_mm)[lines & left.lettering].sum()),
        left.areas,
        tuple(hatching(ways)),
        tuple(pale_lines(sheet.drawing)),
        _longest_first(single.values()),
        _longest_first(_dots(sheet, specks & (left.solid_px == 0), thinned.usual_mm)),
    )


def _dots(sheet: Sheet, specks: NDArray[np.bool_], usual_mm: float) -> Iterator[Patch]:
    """The specks that are broader than two lines: their places, and how far across."""
    rows, pitch_mm = sheet.drawing.darkness.shape[0], sheet.drawing.pitch_mm
    for top, bottom, left, right in sheet.patches.boxes[specks].tolist():
        across_mm = min(bottom - top, right - left) * pitch_mm
        if across_mm > 2 * usual_mm:
            x_mm = 0.5 * (left + right) * pitch_mm
            y_mm = (rows - 0.5 * (top + bottom)) * pitch_mm
            yield round(x_mm, 1), round(y_mm, 1), round(across_mm, 1)


def _line_lengths_mm(sheet: Sheet, left: InkLeft, usual_mm: float) -> Array:
    """Lengths of the patches as lines, mm: without their solid areas."""
    has_solids = left.solid_px > 0
    if not has_solids.any():
        return sheet.lengths_mm
    ink_mm2 = (sheet.patches.areas - left.solid_px) * sheet.drawing.pitch_mm**2
    return np.where(has_solids, ink_mm2 / usual_mm, sheet.lengths_mm)


def _single(felt: FeltSheet, places: Array, run: Array) -> Iterator[tuple[int, Patch]]:
    """The stretches of doubled ink along which no second stroke runs, with their numbers."""
    doubled = felt.doubled
    if not doubled.stations:
        return
    # 1. how much of the ways, places `LOOKED_MM` apart, each thinned pixel has
    away, nearest = Neighbours(places).nearest(run)
    come = np.bincount(nearest[away < TWO_LINES * doubled.pen_mm], minlength=len(places))
    for n, flags in doubled.stations.items():
        # 2. along the doubled part of a stretch
        pixels = felt.graph.stretches[n].pixels
        at = np.round(np.linspace(0, len(flags) - 1, len(pixels))).astype(int)
        there, long_mm = pixels[flags[at]], doubled.length_mm(felt.felt, n)
        left_mm = float(np.clip(2 * long_mm - come[there].sum() * LOOKED_MM, 0.0, long_mm))
        if len(there) and left_mm > ONCE_SHARE * long_mm:
            x, y = places[there[len(there) // 2]]
            yield n, (round(float(x), 1), round(float(y), 1), round(left_mm, 1))


def _missed(
    pieces: Iterable[Missed],
    thinned: Neighbours,
    told: NDArray[np.bool_],
    is_near: NDArray[np.bool_],
) -> tuple[list[Patch], float]:
    """The pieces of missed ink that are not told by the thinned pixels nearest to them, and the length of
    those that these count as followed.
    """
    found, missed_mm = list[Patch](), 0.0
    for piece in pieces:
        nearest = thinned.nearest(piece.places_mm)[1]
        if np.mean(told[nearest]) < HALF:
            x, y = piece.places_mm.mean(axis=0)
            found.append((round(float(x), 1), round(float(y), 1), round(piece.length_mm, 1)))
            missed_mm += piece.length_mm * float(np.mean(is_near[nearest]))
    return found, missed_mm


def _patch(part: Bare) -> Patch:
    """About where the middle of a part of a stretch is, and how long it is."""
    x, y = part.places_mm[len(part.places_mm) // 2]
    return round(float(x), 1), round(float(y), 1), round(part.length_mm, 1)


def _longest_first(patches: Iterable[Patch]) -> tuple[Patch, ...]:
    """Patches in order of their lengths."""
    return tuple(sorted(patches, key=lambda patch: -patch[2]))
