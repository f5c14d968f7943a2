"""Scans of two levels: the rims of their ink are laid through the steps of the pixels.

Signals: darkness of a sheet whose pixels are paper or ink in; out darkness as a lens would have shown it: of
a pixel on a rim, the share of it that is ink.

    ▓▓▓▓▓▓▓▓╲_                 a rim goes through the middles of the sides between ink and paper, but half a
    ▓▓▓▓▓▓▓▓▓▓╲_               pixel to either side: each of its places moves onto the parabola through those
    ▓▓▓▓▓▓▓▓▓▓▓▓▓╲_            about it, as far before and behind as one parabola fits them all

Each step of a line that runs by 5 degrees off the rows is eleven pixels long: a head that feels the pixels'
own rims takes steps for bends. At a corner of the ink only places on one side tell the rim.

Source: our own. The share of a pixel is the area on the ink's side of the rim, exactly.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO
from morfax.motion.compiled import njit
from morfax.motion.moments import NO_PLACES, parabola_of, with_place
from morfax.tracer.drawing.blocks import BLOCK_PX, darkest, runs_in
from morfax.tracer.drawing.components import INK

Darkness = NDArray[np.float32]

# places of a rim before and behind one that tell it, the longest stretches first; at a corner those of one
# side tell it; by trial on nets at 200 and 300 dpi, and on corners
WINDOWS = (
    *((24, 24), (17, 17), (24, 6), (6, 24), (12, 12), (17, 4), (4, 17), (17, 0), (0, 17)),
    *((8, 8), (12, 0), (0, 12), (8, 0), (0, 8), (6, 6), (4, 4), (3, 3)),
)
OF_CHAIN = 0.75  # of a closed rim: a longer stretch of it closes on itself
# pixels, RMS: a rim that is anywhere within half a pixel of its places is 0.29 off, and noise adds a little
MISFIT_PX = 0.33
WITHIN_PX = 0.5  # a rim lies no further from the middle of its pixels' sides
# pixels: at a corner of the ink the ends of a stretch leave its parabola, while most of it fits
END_PX = 0.6
FOLDED = 0.6  # pixels from end to end for each place: both sides of a line of a pixel would fit a parabola
LEVELS = 255.0  # of a scan in grey: what rounding leaves of paper and of ink is less than one

# east, north, west and south, by rows and columns; and the pixel to the left of a way that sets out from a
# pixel's upper left corner
DOWN, RIGHT = (0, -1, 0, 1), (1, 0, -1, 0)
LEFT_DOWN, LEFT_RIGHT = (-1, -1, 0, 0), (0, -1, -1, 0)
BARE_PX = 256  # of a row, that are looked through at a time; chosen
PASSED = 2  # marks ink whose lower side a chain has come by


def with_rims(darkness: Darkness, darkest_there: Darkness | None = None) -> Darkness:
    """The darkness with its rims laid through the steps of the pixels, in its place. Paper is only written
    where it is lighter than that: a sheet takes no memory where nothing is drawn.

    The darkest of the sheet's blocks is told where it is known.
    """
    most = darkest(darkness) if darkest_there is None else darkest_there
    inked = np.nonzero(most > INK)
    if len(inked[0]):
        first, left = (BLOCK_PX * int(at.min()) for at in inked)
        last, right = (BLOCK_PX * (int(at.max()) + 1) for at in inked)
        row, begin, end = runs_in(darkness[first:last, left:right], INK)
        # and a pixel of paper about all ink, into which a rim may move
        rows = slice(max(first + int(row[0]) - 1, 0), first + int(row[-1]) + 2)
        _lay_rims(
            darkness[rows, max(left + int(begin.min()) - 1, 0) : left + int(end.max()) + 1]
        )
    _no_lighter(darkness)
    return darkness


def _lay_rims(darkness: Darkness) -> None:
    """Lay the rims of a part of a sheet, beyond which there is paper."""
    ink = np.pad(darkness > INK, 1).astype(np.uint8)
    places, begins = _chains(ink, _sides(ink))
    laid = np.empty_like(places)
    _lay(places, begins, np.array(WINDOWS), laid)
    covered = np.zeros(darkness.shape, np.float32)
    _cover(laid, begins, covered)
    # a pixel that no rim comes by stays as it is
    covered += darkness
    covered -= ink[1:-1, 1:-1] & 1
    darkness[:] = covered


@njit(cache=True)
def _no_lighter(darkness):  # type: ignore[no-untyped-def]
    """Make paper what is lighter than paper; stretches of a row without anything lighter are only read, in
    vectors: a bit of each number says so.
    """
    for row in darkness:
        for first in range(0, len(row), BARE_PX):
            stretch, signs = row[first : first + BARE_PX], np.int32(0)
            for bits in stretch.view(np.int32):
                signs |= bits
            if signs < 0:
                for k in range(len(stretch)):
                    stretch[k] = max(stretch[k], np.float32(0.0))


def _sides(ink: NDArray[np.uint8]) -> int:
    """How many sides of pixels lie between ink and paper."""
    return sum(
        int(np.count_nonzero(one != other))
        for one, other in ((ink[1:], ink[:-1]), (ink[:, 1:], ink[:, :-1]))
    )


@njit(cache=True)
def _chains(ink, sides):  # type: ignore[no-untyped-def]
    """The middles of the sides between ink and paper, (n, 2) column and row, pixels, one closed chain after
    the other with the ink to its left; and where each chain begins, and the last ends.

    Around the sheet lies a pixel of paper. Pixels that touch by a corner are one ink.
    """
    places = np.empty((sides, 2))
    begins = [0]
    k = 0
    for row in range(1, len(ink)):
        for column in range(1, ink.shape[1]):
            if ink[row - 1, column] != 1 or ink[row, column]:
                continue
            r, c, way = row, column, 0
            while way or ink[r - 1, c] == 1:
                if not way:
                    ink[r - 1, c] |= PASSED
                places[k, 0] = c + 0.5 * RIGHT[way] - 1.0
                places[k, 1] = r + 0.5 * DOWN[way] - 1.0
                k += 1
                r, c = r + DOWN[way], c + RIGHT[way]
                to_right = (way + 3) % 4
                if ink[r + LEFT_DOWN[to_right], c + LEFT_RIGHT[to_right]]:
                    way = to_right
                elif not ink[r + LEFT_DOWN[way], c + LEFT_RIGHT[way]]:
                    way = (way + 1) % 4
            begins.append(k)
    return places, np.array(begins)


@njit(cache=True)
def _lay(places, begins, windows, laid):  # type: ignore[no-untyped-def]
    """Fill `laid` with the places of closed chains, each on the parabola through the longest stretch about it
    that one fits.
    """
    for n in range(len(begins) - 1):
        chain = places[begins[n] : begins[n + 1]]
        for i in range(len(chain)):
            right, down = 0.0, 0.0
            for before, behind in windows:
                if before + behind < OF_CHAIN * len(chain):
                    fits, right, down = _fitted(chain, i, before, behind)
                    if fits:
                        break
            laid[begins[n] + i, 0] = chain[i, 0] + right
            laid[begins[n] + i, 1] = chain[i, 1] + down


@njit(cache=True)
def _fitted(chain, i, before, behind):  # type: ignore[no-untyped-def]
    """Whether a parabola fits the places about one of a closed chain, so many before and behind it; and by
    how much it passes beside that one, to the right and down.
    """
    first, last, count = i - before, (i + behind) % len(chain), len(chain)
    right, down = chain[last, 0] - chain[first, 0], chain[last, 1] - chain[first, 1]
    long = math.hypot(right, down)
    if long < FOLDED * (before + behind):
        return False, 0.0, 0.0
    c, s = right / long, down / long
    sums, squares = NO_PLACES, 0.0
    # its ends lie on one line along the chord
    x0 = x1 = y0 = 0.0
    for k in range(first, i + behind + 1):
        at = k - count if k >= count else k
        right, down = chain[at, 0] - chain[i, 0], chain[at, 1] - chain[i, 1]
        x1, y0 = right * c + down * s, down * c - right * s
        x0 = x1 if k == first else x0
        sums = with_place(sums, 1.0, x1, y0)
        squares += y0 * y0
    is_one, p0, p1, p2 = parabola_of(sums)
    left = squares - p0 * sums.b0 - p1 * sums.b1 - p2 * sums.b2
    off_ends = max(abs(p0 + x0 * (p1 + p2 * x0) - y0), abs(p0 + x1 * (p1 + p2 * x1) - y0))
    if not is_one or left > sums.s0 * MISFIT_PX**2 or off_ends > END_PX:
        return False, 0.0, 0.0
    # square to the parabola there
    steep = math.sqrt(1.0 + p1 * p1)
    aside = min(max(p0 / steep, -WITHIN_PX), WITHIN_PX) / steep
    return True, aside * (-s - p1 * c), aside * (c - p1 * s)


@njit(cache=True)
def _cover(places, begins, covered):  # type: ignore[no-untyped-def]
    """Fill pixels with the share of each that closed chains of places have to their left."""
    for n in range(len(begins) - 1):
        last = begins[n + 1] - 1
        for k in range(begins[n], begins[n + 1]):
            _add_area(places[last], places[k], covered)
            last = k
    for row in range(len(covered)):
        sum_to_left = 0.0
        for column in range(covered.shape[1]):
            sum_to_left += covered[row, column]
            covered[row, column] = round(LEVELS * min(max(sum_to_left, 0.0), 1.0)) / LEVELS


@njit(cache=True)
def _add_area(one, other, covered):  # type: ignore[no-untyped-def]
    """Add what a straight piece of a rim adds to the pixels to its right, less what it adds to those before
    them: so the sums along a row are shares of its pixels.
    """
    (x0, y0), (x1, y1) = one, other
    low, high = min(y0, y1), max(y0, y1)
    for row in range(max(math.floor(low), 0), min(math.ceil(high), len(covered))):
        top, bottom = max(low, float(row)), min(high, row + 1.0)
        if bottom <= top:
            continue
        # 1. the part in this row, from its left end to its right one
        a, b = (
            x0 + (top - y0) / (y1 - y0) * (x1 - x0),
            x0 + (bottom - y0) / (y1 - y0) * (x1 - x0),
        )
        left, right = min(a, b), max(a, b)
        height = (bottom - top) if y1 > y0 else top - bottom
        # 2. what lies before the sheet counts for its first pixel
        before = 0.0
        for column in range(max(math.floor(left), 0), math.floor(right) + 2):
            share = _share_before(left, right, column)
            if column < covered.shape[1]:
                covered[row, column] += height * (share - before)
            before = share


@njit(cache=True)
def _share_before(left, right, column):  # type: ignore[no-untyped-def]
    """The share of a straight piece from left to right that lies before a pixel's places, in the mean."""
    if right - left < NOT_ZERO:
        return min(max(column + 1.0 - left, 0.0), 1.0)
    # the integral of a ramp from 0 to 1
    a = min(max(column - left, 0.0), right - left)
    b = min(max(column + 1.0 - left, 0.0), right - left)
    return (b * b - a * a) / (2.0 * (right - left)) + max(
        column + 1.0 - max(right, column), 0.0
    )
