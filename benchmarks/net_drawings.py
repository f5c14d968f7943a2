"""Drawings of nets with known truth: the strokes of a pen, mm, from a generator of random numbers."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.spatial import Voronoi

Points = NDArray[np.float64]
Strokes = list[Points]

SHEET_MM, MARGIN_MM = 100.0, 8.0
# one-stroke letters, 6 wide and 9 high: places as "xy", of a curve behind "~"; no Y, for no ink tells into
# which arm its stem goes on
LETTERS = {
    "A": ("00 39 60", "13 53"),
    "C": ("~58 39 18 05 04 11 30 51",),
    "D": ("00 09", "~09 39 58 65 64 51 30 00"),
    "E": ("60 00 09 69", "05 45"),
    "G": ("~58 39 18 05 04 11 30 51 64", "64 34"),
    "H": ("00 09", "60 69", "05 65"),
    "K": ("00 09", "69 03", "25 60"),
    "L": ("09 00 60",),
    "M": ("00 09 34 69 60",),
    "N": ("00 09 60 69",),
    "O": ("~39 18 05 04 11 30 51 64 65 58 39",),
    "P": ("00 09", "~09 49 68 66 45 05"),
    "S": ("~58 39 18 06 25 44 63 51 30 11",),
    "T": ("09 69", "30 39"),
    "U": ("~09 03 11 30 51 63 69",),
    "W": ("09 10 36 50 69",),
    "X": ("00 69", "09 60"),
    "Z": ("09 69 00 60",),
}
# exact, so that the ends of strokes lie on other strokes
LETTER_UNITS, UNIT_MM = (11, 19), 1 / 16
CURVE = 60  # places of a curve


def chords(rng: np.random.Generator) -> Strokes:
    """Straight lines across each other."""
    ends = rng.uniform(MARGIN_MM, SHEET_MM - MARGIN_MM, (60, 2, 2))
    return [e for e in ends if np.hypot(*(e[1] - e[0])) > 25][:20]


def circles(rng: np.random.Generator) -> Strokes:
    """Circles laid over each other."""
    turns = np.linspace(0, 2 * np.pi, 1500)
    round_one = np.column_stack([np.cos(turns), np.sin(turns)])
    return [rng.uniform(32, 68, 2) + radius * round_one for radius in rng.uniform(8, 24, 8)]


def cells(rng: np.random.Generator) -> Strokes:
    """The walls of Voronoi cells."""
    found = Voronoi(rng.uniform(MARGIN_MM, SHEET_MM - MARGIN_MM, (40, 2)))
    walls = [found.vertices[[a, b]] for a, b in found.ridge_vertices if a >= 0 and b >= 0]
    inside = [w for w in walls if (w > 5).all() and (w < SHEET_MM - 5).all()]
    return [w for w in inside if np.hypot(*(w[1] - w[0])) > 1.5]


def grid(rng: np.random.Generator) -> Strokes:
    """Lines at right angles, at uneven distances."""
    at = np.sort(10 + np.cumsum(rng.uniform(6, 12, 8)))
    low, high = at[0], at[-1]
    across = [np.array([[low, y], [high, y]]) for y in at]
    return [*across, *(np.array([[x, low], [x, high]]) for x in at)]


def tree(rng: np.random.Generator) -> Strokes:
    """Branches that fork."""
    out: Strokes = []

    def grow(root: Points, heading: float, long_mm: float, forks: int) -> None:
        tip = root + long_mm * np.array([np.cos(heading), np.sin(heading)])
        out.append(np.array([root, tip]))
        for turned in (-0.5, 0.45) if forks else ():
            grow(tip, heading + turned + rng.normal(0, 0.1), 0.72 * long_mm, forks - 1)

    grow(np.array([50.0, 6.0]), np.pi / 2, 24.0, 4)
    return out


def lissajous(rng: np.random.Generator) -> Strokes:
    """One line that crosses itself."""
    turns, phase = np.linspace(0, 2 * np.pi, 3000), rng.uniform(0.2, 0.5)
    a, b = [(3, 4), (3, 5), (4, 5)][rng.integers(3)]
    return [50 + 40 * np.column_stack([np.sin(a * turns + phase), np.sin(b * turns)])]


def text(rng: np.random.Generator) -> Strokes:
    """Lines of letters in a one-stroke font, 6 to 10 mm high."""
    out, y = Strokes(), MARGIN_MM
    while True:
        unit_mm = UNIT_MM * float(rng.integers(*LETTER_UNITS))
        if y + 9 * unit_mm > SHEET_MM - MARGIN_MM:
            return out
        for x in np.arange(MARGIN_MM, SHEET_MM - MARGIN_MM - 6 * unit_mm, 9 * unit_mm):
            for stroke in LETTERS[str(rng.choice(list(LETTERS)))]:
                out.append((x, y) + unit_mm * _places(stroke))
        y += 13 * unit_mm


def _places(stroke: str) -> Points:
    """The places of a stroke of a letter, in units."""
    places = np.array([(int(x), int(y)) for x, y in stroke.lstrip("~").split()], float)
    if not stroke.startswith("~"):
        return places
    come = np.r_[0, np.cumsum(np.hypot(*np.diff(places, axis=0).T))]
    is_ring = bool((places[0] == places[-1]).all())
    curve = CubicSpline(come, places, bc_type="periodic" if is_ring else "natural")
    return np.asarray(curve(np.linspace(0, come[-1], CURVE)))


KINDS: dict[str, Callable[[np.random.Generator], Strokes]] = {
    kind.__name__: kind for kind in (chords, circles, cells, grid, tree, lissajous, text)
}
