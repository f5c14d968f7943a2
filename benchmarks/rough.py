"""Rough lines: ballpoint, felt pen, marker, chalk; a shadow, folds, and what shows through the paper.

    python -m benchmarks rough [COUNT [FIRST]] [KIND] [-v]

COUNT drawings of each kind (20), their numbers from FIRST (0), or those of one kind; -v names those that are
not right.

Closed outlines as in `benchmarks.pencil`, at 300 dpi, with its lens and noise:

    ballpoint   0.3 to 0.5 mm, 70 % as dark as ink, a groove of paper in the middle; it skips 0.2 to 0.8 mm,
                every 25 mm or so
    felt        0.6 to 1.0 mm on rough paper: the ink runs out to 0.08 mm (standard deviation) to either side
    marker      0.8 to 3 mm, the width swells over some 8 mm of line
    chalk       0.8 to 1.5 mm, light on a board with smears, grain of 45 % behind a spot of two pixels
    shadow      a pen of 0.4 to 0.6 mm; half of the sheet is in shadow (55 to 75 % of the light), the edge of
                the shadow, 0.3 to 3 mm soft, is across the line
    fold        the same pen; two folds across the sheet, each a dark and a light rim of 0.2 mm, a tenth to a
                quarter as dark as ink
    through     the same pen; another outline, mirrored and soft, shows through at 10 to 25 % of ink

Every drawing is traced as `morfax trace` does without options; right, told, wrong: see `benchmarks.pencil`.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.pencil import (
    BLACK,
    DPI,
    HEAD,
    NOISE,
    PAPER,
    SOFTNESS_MM,
    Levels,
    Points,
    coverage,
    measured,
    outline,
    told,
)
from morfax.motion.polyline import lengths_mm
from morfax.motion.units import MM_PER_INCH

Random = np.random.Generator
PX_PER_MM = DPI / MM_PER_INCH
# from one skip of the ballpoint to the next, and their lengths
EVERY_MM, SKIPS_MM = 25.0, (0.2, 0.8)
BALLPOINT, GROOVE = 0.7, 0.35  # of ink's darkness; how much lighter the groove is
RUNS_OUT_MM = 0.08
SWELLS_MM = 8.0
BOARD, CHALK, CHALK_GRAIN, SMEARS = 55.0, 215.0, 0.45, 8.0


def pen_mm(rng: Random) -> float:
    """A pen of 0.4 to 0.6 mm."""
    return float(rng.uniform(0.4, 0.6))


def lens(picture: NDArray[np.float64] | Levels) -> NDArray[np.float64]:
    """A picture behind the scanner's lens."""
    return np.asarray(cv2.GaussianBlur(picture, (0, 0), SOFTNESS_MM * PX_PER_MM), float)


def noise(shape: tuple[int, ...], rng: Random) -> NDArray[np.float64]:
    """The scanner's noise, levels."""
    return rng.normal(0, NOISE, shape)


def inked(ink: NDArray[np.float64] | Levels, rng: Random) -> NDArray[np.float64]:
    """Levels of paper under ink, 0..1, with noise."""
    return PAPER - (PAPER - BLACK) * ink + noise(ink.shape, rng)


def texture(shape: tuple[int, ...], spot_px: float, rng: Random) -> NDArray[np.float64]:
    """Normal noise behind a spot, of standard deviation 1."""
    wave = cv2.GaussianBlur(rng.normal(size=shape), (0, 0), spot_px)
    return np.asarray(wave / wave.std(), float)


def ballpoint(line: Points, rng: Random) -> tuple[float, NDArray[np.float64]]:
    """A ballpoint that skips, and leaves a groove."""
    width_mm = float(rng.uniform(0.3, 0.5))
    ink = coverage(line, width_mm) - GROOVE * coverage(line, width_mm / 4)
    along_mm = lengths_mm(line)
    for at_mm in np.arange(EVERY_MM / 2, along_mm[-1] - 2, EVERY_MM):
        begin_mm = at_mm + rng.uniform(-8, 8)
        skip = begin_mm + np.array([0.0, rng.uniform(*SKIPS_MM)])
        part = np.column_stack([np.interp(skip, along_mm, column) for column in line.T])
        rows, columns = np.indices(ink.shape)
        x_mm, y_mm = (columns + 0.5) / PX_PER_MM, (len(ink) - rows - 0.5) / PX_PER_MM
        ink[_within(x_mm, y_mm, part, width_mm)] = 0
    return width_mm, inked(BALLPOINT * lens(ink), rng)


def _within(
    x_mm: NDArray[np.float64], y_mm: NDArray[np.float64], part: Points, width_mm: float
) -> NDArray[np.bool_]:
    """Pixels between the ends of a short piece of line, within a width of it."""
    way = part[-1] - part[0]
    if not way.any():
        return np.zeros(x_mm.shape, bool)
    dx_mm, dy_mm = x_mm - part[0, 0], y_mm - part[0, 1]
    along = (dx_mm * way[0] + dy_mm * way[1]) / (way @ way)
    aside = dx_mm * way[1] - dy_mm * way[0]
    return (along > 0) & (along < 1) & (np.abs(aside) < width_mm * np.hypot(*way))


def felt(line: Points, rng: Random) -> tuple[float, NDArray[np.float64]]:
    """A felt pen on rough paper."""
    width_mm = float(rng.uniform(0.6, 1.0))
    # 1. away from the rim of the ink, mm, inside positive
    mask = (coverage(line, width_mm) > 0.5).astype(np.uint8)
    away = cv2.distanceTransform(mask, cv2.DIST_L2, 5) - cv2.distanceTransform(
        1 - mask, cv2.DIST_L2, 5
    )
    # 2. and as far as the ink has run
    run_px = RUNS_OUT_MM * PX_PER_MM * texture(mask.shape, 1.5, rng)
    ink = np.clip(away + run_px + 0.5, 0, 1)
    return width_mm, inked(0.9 * lens(ink), rng)


def marker(line: Points, rng: Random) -> tuple[float, NDArray[np.float64]]:
    """A marker whose line swells."""
    along_mm = lengths_mm(line)
    at_mm = np.arange(0, along_mm[-1], 0.2)
    places = np.column_stack([np.interp(at_mm, along_mm, column) for column in line.T])
    knots = max(4, round(along_mm[-1] / SWELLS_MM))
    swells = rng.uniform(0, 1, knots)
    share = np.interp(
        at_mm / along_mm[-1] * knots, np.arange(knots + 1), np.r_[swells, swells[:1]]
    )
    widths = 0.8 + 2.2 * share * rng.uniform(0.6, 1)
    fine = 4
    rows, columns = coverage(line, 0.5).shape
    ink = np.zeros((rows * fine, columns * fine), np.uint8)
    scale = fine * PX_PER_MM
    for (x_mm, y_mm), width_mm in zip(places, widths, strict=True):
        at = round(x_mm * scale * 16), round((len(ink) - y_mm * scale) * 16)
        cv2.circle(ink, at, round(width_mm / 2 * scale * 16), 255, -1, cv2.LINE_AA, 4)
    small = cv2.resize(ink, (columns, rows), interpolation=cv2.INTER_AREA) / 255
    return float(np.median(widths)), inked(lens(small), rng)


def chalk(line: Points, rng: Random) -> tuple[float, NDArray[np.float64]]:
    """Chalk on a board."""
    width_mm = float(rng.uniform(0.8, 1.5))
    ink = lens(coverage(line, width_mm))
    grain = np.clip(1 + CHALK_GRAIN * texture(ink.shape, 2.0, rng), 0, 1.6)
    board = BOARD + SMEARS * texture(ink.shape, 40.0, rng)
    return width_mm, board + (CHALK - BOARD) * np.clip(ink * grain, 0, 1) + noise(
        ink.shape, rng
    )


def shadow(line: Points, rng: Random) -> tuple[float, NDArray[np.float64]]:
    """A shadow's edge across the line."""
    width_mm = pen_mm(rng)
    levels = inked(lens(coverage(line, width_mm)), rng)
    away_mm = _from_straight(levels.shape, rng)
    light = rng.uniform(0.55, 0.75)
    lit = 1 / (1 + np.exp(-away_mm / (rng.uniform(0.3, 3.0) / 4)))
    return width_mm, levels * (light + (1 - light) * lit)


def fold(line: Points, rng: Random) -> tuple[float, NDArray[np.float64]]:
    """Two folds across the sheet."""
    width_mm = pen_mm(rng)
    ink = coverage(line, width_mm).astype(float)
    for _ in range(2):
        away_mm = _from_straight(ink.shape, rng)
        depth = rng.uniform(0.1, 0.25)
        for side, sign in ((-0.1, 1), (0.1, -1)):
            ink = ink + sign * depth * np.exp(-0.5 * ((away_mm - side) / 0.1) ** 2) * (1 - ink)
    return width_mm, inked(lens(ink), rng)


def through(line: Points, rng: Random) -> tuple[float, NDArray[np.float64]]:
    """Another outline shows through."""
    width_mm = pen_mm(rng)
    ink = coverage(line, width_mm).astype(float)
    other = outline(rng)
    behind = coverage((other - other.min(axis=0)) * 0.8 + 8.0, 0.6)
    seen = np.zeros_like(ink)
    rows, columns = (min(a, b) for a, b in zip(ink.shape, behind.shape, strict=True))
    seen[:rows, :columns] = behind[:rows, :columns][:, ::-1]
    faint = rng.uniform(0.1, 0.25) * cv2.GaussianBlur(seen, (0, 0), 0.2 * PX_PER_MM)
    return width_mm, inked(lens(np.maximum(ink, faint)), rng)


def _from_straight(shape: tuple[int, ...], rng: Random) -> NDArray[np.float64]:
    """Distances of the pixels from a straight line through about the middle of a sheet, mm, signed."""
    rows, columns = np.indices(shape)
    middle = np.array(shape) * rng.uniform(0.35, 0.65, 2)
    turn = rng.uniform(0, math.tau)
    away = (rows - middle[0]) * math.cos(turn) + (columns - middle[1]) * math.sin(turn)
    return np.asarray(away / PX_PER_MM)


Kind = Callable[[Points, Random], tuple[float, NDArray[np.float64]]]
KINDS: dict[str, Kind] = {
    kind.__name__: kind for kind in (ballpoint, felt, marker, chalk, shadow, fold, through)
}


def main(arguments: list[str] | None = None) -> None:
    """Print the table."""
    words = [word for word in arguments or [] if word != "-v"]
    numbers = [int(word) for word in words if word.isdigit()]
    count, first = (*numbers, *(20, 0)[len(numbers) :])
    wanted = [word for word in words if not word.isdigit()] or list(KINDS)
    print(HEAD)
    for name in wanted:
        found = []
        for number in range(first, first + count):
            rng = np.random.default_rng([number, len(name), ord(name[0])])
            line = outline(rng)
            width_mm, levels = KINDS[name](line, rng)
            one = measured(line, width_mm, np.asarray(levels, np.float32))
            found.append(one)
            if one.verdict != "right" and "-v" in sys.argv:
                print(number, name, f"{width_mm:.2f}", one.verdict, one.said)
        told(name, found)
