"""How far a path is from the ink's own centre, and which ink no path covers; without the head.

It is the measure of `compare DRAWING PATH`.

Signals: a Drawing and a path's polylines (sheet mm) in; the signed distance of the path from the middle of
the ink at places along it, mm (positive: the path lies to the left of the ink's middle), and the length of
ink that lies beside the path.

Across the path, the ink's two edges are where the darkness falls through half of what it is between them;
the middle is halfway. It is held against the middle of the ink that a pen leaves along the path, which is the
path itself but at corners (see `pen_edges`). Where the ink is much wider than the line usually is (a
crossing) the middle means nothing, and the place is not measured.

Source: our own. The edges are found here once more, and not by `ray`: the measure has to be independent of
the head, so it interpolates the drawing's own darkness by scipy and sees nothing through the head's cells.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.compiled import njit
from morfax.motion.faults import MotionFault
from morfax.motion.median import NEARLY_ALL
from morfax.motion.motion import Path
from morfax.motion.plane import left_of_headings
from morfax.motion.polyline import APART_MM, lengths_mm
from morfax.tracer.drawing.between import between_at
from morfax.tracer.drawing.components import (
    INK,
    SOFTENED_PX,
    Mask,
    Numbers,
    Patches,
    draw_way,
    runs_of,
    strips,
)
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.pen_edges import PenEdges
from morfax.tracer.drawing.profiles import MOST_PROFILES
from morfax.tracer.effort import FINE_PX, LOOKED_MM
from morfax.tracer.limits import PAPER

# of APART_MM: where the cutter's edge moves less it stands, as at a corner; where it moves more it leaps from
# one leg to the other: there the edge is not on the line
STANDS, LEAP = 0.1, 10.0
WIDEST = 1.3  # of the usual width: beyond this the ink's middle means nothing
# the middle of the ink is averaged along the path over this, against the noise of the paper
AVERAGED_MM = 0.5
COVERS = 1.6  # widths: a path covers the ink within 0.8 of them


@dataclass(frozen=True, slots=True)
class Deviation:
    """Distances of a path from the ink's middle at places (n, 2) along it, and the ink that it missed.

    mm; NaN where the ink's middle cannot be measured.
    """

    points_mm: Array
    error_mm: Array
    line_width_mm: float
    missed_mm: float
    ink_mm: float

    @property
    def measured_share(self) -> float:
        """Share of the places where the ink's middle could be measured."""
        return float(np.mean(np.isfinite(self.error_mm)))

    @property
    def rms_mm(self) -> float:
        """Root mean square distance, mm."""
        return float(np.sqrt(np.nanmean(self.error_mm**2)))

    @property
    def p95_mm(self) -> float:
        """Distance that 95 % of the places stay within, mm."""
        return float(np.nanpercentile(np.abs(self.error_mm), NEARLY_ALL))

    @property
    def max_mm(self) -> float:
        """Largest distance, mm."""
        return float(np.nanmax(np.abs(self.error_mm)))

    @property
    def missed_share(self) -> float:
        """Share of the ink that no path covers."""
        return self.missed_mm / self.ink_mm if self.ink_mm else 0.0

    def __str__(self) -> str:
        figures = f"RMS {self.rms_mm:.4f}, 95 % {self.p95_mm:.4f}, max {self.max_mm:.4f} mm"
        return f"path to ink {figures}; {self.missed_mm:.2f} of {self.ink_mm:.2f} mm of the ink missed"


def deviation(
    drawing: Drawing, path: Path | Sequence[Array], over: Sequence[Array] = ()
) -> Deviation:
    """Measure a path, or its runs as (n, 2) polylines in sheet mm, against the drawing.

    Distances are those of the runs with the tool in the work. Ink is missed if the path nowhere goes over it,
    not even with the tool up as on a lead line, and no polyline of `over` does. Raises MotionFault if the
    path nowhere follows the ink.
    """
    runs = path.runs() if isinstance(path, Path) else list(path)
    places = [_places(run) for run in runs if len(run) > 1]
    places = [(points, headings) for points, headings in places if len(points)]
    if not places:
        raise MotionFault(
            "the path has no run with the tool in the work; nothing to compare with the drawing"
        )
    width_mm = _line_width(drawing, places)
    pen = PenEdges([run for run in runs if len(run) > 1], width_mm)
    errors = [
        _averaged(
            _across(drawing, points, headings, width_mm) + pen.middle_mm(points, headings)
        )
        for points, headings in places
    ]
    if not any(np.isfinite(error).any() for error in errors):
        raise MotionFault(
            "the path nowhere follows the drawing's ink, it only crosses it or runs beside it; check that"
            " both have the same scale and origin, and give the --cutter or --kerf of a path beside the lines"
        )
    missed, ink = _missed(
        drawing, [path.xy_mm] if isinstance(path, Path) else [*runs, *over], width_mm
    )
    return Deviation(
        np.vstack([p for p, _ in places]), np.concatenate(errors), width_mm, missed, ink
    )


def touched(drawing: Drawing, path: Path, radius_mm: float) -> list[Array]:
    """Where the edge of a cutter touches the ink, as (n, 2) polylines, when its middle runs along a path.

    The edge touches on that side of each run where there is more ink.
    """
    polylines = []
    for run in path.runs():
        points, headings = _places(run, APART_MM)
        if not len(points):
            continue  # a hole
        both = darkness_across(drawing, points, headings, np.array([radius_mm, -radius_mm]))
        left, right = both.mean(axis=0)
        arm_mm = radius_mm if left >= right else -radius_mm
        edge = points + arm_mm * left_of_headings(headings)
        steps = np.hypot(*np.diff(edge, axis=0).T) / APART_MM
        on_line = (steps > STANDS) & (steps < LEAP)
        ends = np.flatnonzero(np.diff(np.r_[False, on_line, False].astype(np.int8)))
        polylines += [edge[a : b + 1] for a, b in ends.reshape(-1, 2)]
    return polylines


def _places(run: Array, every_mm: float = LOOKED_MM) -> tuple[Array, Array]:
    """Places every so many mm along a polyline, and the heading there."""
    steps = np.hypot(*np.diff(run, axis=0).T)
    keep = np.r_[True, steps > 1e-9]
    run = run[keep]
    s = lengths_mm(run)
    at = np.arange(0.5 * every_mm, s[-1], every_mm)
    points, behind, ahead = (
        np.column_stack([np.interp(at + d * LOOKED_MM, s, column) for column in run.T[:2]])
        for d in (0.0, -0.5, 0.5)
    )
    way = ahead - behind
    return points, np.arctan2(way[:, 1], way[:, 0])


def darkness_across(drawing: Drawing, points: Array, headings: Array, across: Array) -> Array:
    """Darkness (places, across) at distances to the left of a path."""
    ways = np.column_stack([np.cos(headings), np.sin(headings)])
    at = np.empty((len(points), len(across), 2))
    sheet = float(drawing.darkness.shape[0]), float(drawing.pitch_mm)
    _beside(np.ascontiguousarray(points, float), ways, np.asarray(across, float), sheet, at)
    return between_at(drawing.darkness, at, edge_goes_on=False)


@njit(cache=True, _nrt=False)
def _beside(points, ways, across, sheet, at):  # type: ignore[no-untyped-def]
    """Fill in row and column, from the middle of the first pixel, of places to the left of others (n, 2) mm,
    by the unit vectors of the ways there. `sheet`: its rows, and the pixels' pitch, mm.
    """
    rows, pitch_mm = sheet
    for k in range(len(points)):
        for n in range(len(across)):
            x = points[k, 0] - ways[k, 1] * across[n]
            y = points[k, 1] + ways[k, 0] * across[n]
            at[k, n, 0], at[k, n, 1] = rows - y / pitch_mm - 0.5, x / pitch_mm - 0.5


def _line_width(drawing: Drawing, places: list[tuple[Array, Array]]) -> float:
    """Usual width of the ink under a path, mm."""
    points, headings = (np.concatenate(part) for part in zip(*places, strict=True))
    some = slice(None, None, max(1, len(points) // MOST_PROFILES))
    reach = 1.0
    while True:
        right, left = _edges(drawing, points[some], headings[some], reach)
        widths = left - right
        found = widths[np.isfinite(widths)]
        if len(found) > 0.3 * len(widths) or reach > 16:
            break
        reach *= 2
    if not len(found):
        raise MotionFault(
            "the path lies nowhere on the drawing's ink;"
            " check that both have the same scale and origin"
        )
    return float(np.median(found))


def _edges(
    drawing: Drawing, points: Array, headings: Array, reach_mm: float
) -> tuple[Array, Array]:
    """Edges of the ink nearest to a path, mm to its left; NaN without ink under it or an edge in reach."""
    step = FINE_PX * drawing.pitch_mm
    count = int(np.ceil(reach_mm / step))
    across = np.arange(-count, count + 1, dtype=float) * step
    seen = darkness_across(drawing, points, headings, across)
    # 1. the darkest place near to the path, of two as dark the nearer one, and half of its darkness
    near = np.abs(across) <= 0.5 * reach_mm
    peak_at = np.argmax(np.where(near, seen - 1e-3 * np.abs(across), -1.0), axis=1)[:, None]
    level = 0.5 * np.take_along_axis(seen, peak_at, 1)
    # 2. the nearest lighter places on either side
    last, index = len(across) - 1, np.arange(len(across))
    light = seen < level
    right = np.where(light & (index < peak_at), index, -1).max(axis=1)
    left = np.where(light & (index > peak_at), index, last + 1).min(axis=1)
    ok = (right >= 0) & (left <= last) & (level[:, 0] > PAPER)
    right, left = np.where(ok, right, 0), np.where(ok, left, last)
    # 3. where it is as dark, between them and the next ones
    rows = np.arange(len(points))
    edges = list[Array]()
    for outside, inside in (
        (right, np.minimum(right + 1, last)),
        (left, np.maximum(left - 1, 0)),
    ):
        a, b = seen[rows, outside], seen[rows, inside]
        share = (level[:, 0] - a) / np.where(np.abs(b - a) > NOT_ZERO, b - a, 1.0)
        found = across[outside] + share * (across[inside] - across[outside])
        edges.append(np.asarray(np.where(ok, found, np.nan), float))
    return edges[0], edges[1]


def _across(drawing: Drawing, points: Array, headings: Array, width_mm: float) -> Array:
    """Signed distance of each place from the ink's middle, mm; NaN where the ink has no single middle."""
    right, left = _edges(drawing, points, headings, 1.2 * width_mm + 4 * drawing.pitch_mm)
    odd = ~(np.abs((left - right) / width_mm - 1) < WIDEST - 1)
    return np.asarray(np.where(odd, np.nan, -0.5 * (left + right)), float)


def _averaged(errors: Array) -> Array:
    """Running mean along the path, over what could be measured."""
    span = np.ones(max(1, round(AVERAGED_MM / LOOKED_MM)))
    good = np.isfinite(errors)
    first = len(span) // 2
    total = np.convolve(np.where(good, errors, 0.0), span)[first : first + len(errors)]
    count = np.convolve(good.astype(float), span)[first : first + len(errors)]
    return np.asarray(np.where(good, total / np.maximum(count, 1), np.nan), float)


def _missed(drawing: Drawing, runs: Sequence[Array], width_mm: float) -> tuple[float, float]:
    """Length of ink that no path covers, and of all ink, mm: area over the line's width, without specks."""
    patches = Patches.of(_runs(drawing))
    counts = patches.areas * drawing.pitch_mm**2 >= width_mm**2
    covered, columns = _covered(drawing, runs, width_mm), drawing.darkness.shape[1]
    missed = sum(
        np.count_nonzero(patches.painted(counts, top, bottom, 0, columns) > covered[top:bottom])
        for top, bottom, _ in strips(covered.shape)
    )
    area_mm = drawing.pitch_mm**2 / width_mm
    return float(missed * area_mm), float(patches.areas[counts].sum() * area_mm)


def _runs(drawing: Drawing) -> Iterator[tuple[Numbers, Numbers, Numbers]]:
    """Runs of ink, strip by strip."""
    for top, bottom, rows in strips(drawing.darkness.shape, halo=8):
        ink = cv2.GaussianBlur(drawing.darkness[rows], (0, 0), SOFTENED_PX) > INK
        yield runs_of(np.asarray(ink[top - rows.start : bottom - rows.start], bool), top)


def _covered(drawing: Drawing, runs: Sequence[Array], width_mm: float) -> Mask:
    """Mask of the sheet where a pen a little wider than the line, run along the paths, would ink it."""
    rows, columns = drawing.darkness.shape
    covered = np.zeros((rows, columns), np.uint8)
    thickness = max(1, round(COVERS * width_mm / drawing.pitch_mm))
    for run in runs:
        x, y = run[:, :2].T / drawing.pitch_mm
        draw_way(covered, np.column_stack([x - 0.5, rows - y - 0.5]), thickness)
    return covered
