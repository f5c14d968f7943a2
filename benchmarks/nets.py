"""Nets of lines: how much of the ink is followed, how often, and in how few strokes.

    python -m benchmarks nets [COUNT [FIRST]]    COUNT drawings of each kind (2), their numbers from FIRST (0)

Drawings are made with known truth (`net_drawings`): chords, circles laid over each other, Voronoi cells,
grids, trees, Lissajous figures and text in one-stroke letters, as a pen of 0.4 mm draws them, scanned at
300 dpi with noise. For each kind: the share of the true lines that strokes run along (all, and the worst
drawing), the length that is run more than once, strokes against the least of a pen that goes straight on
where lines cross, the distance of strokes from the true lines outside of junctions and at them, how often
a true line that passes a junction is one stroke there, and processor time; at the end the worst drawing of
each figure, by which it can be made again, and by how much the ledger told too much of one. Beside it the
pieces into which scikit-image's skeleton falls at its junctions, and, where `pyautotrace` is installed, the
paths that autotrace makes of the middle lines.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
import shapely
from numpy.typing import NDArray
from PIL import Image
from scipy.ndimage import convolve, label, minimum_filter1d
from scipy.spatial import cKDTree
from skimage.morphology import skeletonize

from benchmarks.net_drawings import KINDS, SHEET_MM, Points, Strokes
from morfax.motion.polyline import evenly, length_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.trace_ink import trace_ink

PEN_MM, DPI, FINER, NOISE = 0.4, 300.0, 4, 4.0
ON_IT_MM = 0.5 * PEN_MM  # a true place is followed if a stroke comes as near
AT_JUNCTION_MM = 2.0  # places nearer to a junction are left out of the RMS
# pens: ends of true lines so near to each other share their ink, or have a pixel of paper between
MET_WIDTHS = 1.5
STEP_MM = 0.05
PASSED_MM = 2.0  # before and behind a junction, where the partners are looked up
# a quarter of the pen's width: a line so near to the true one there is its stroke
PASSED_ASIDE_MM = 0.1
UM = 1000.0
LOW_SHARE = 0.995  # asked of a net


class Found(NamedTuple):
    """What one drawing came to: mm, strokes, um, s; pieces of a skeleton; the share that the ledger told."""

    true_mm: float
    followed_mm: float
    twice_mm: float
    strokes: int
    least: int
    rms_um: float
    at_junctions_um: float
    passes: int
    right: int
    took_s: float
    pieces: int
    autotraced: int | None
    told: float
    name: str


def main(arguments: list[str] | None = None) -> None:
    """Print the table."""
    count, first = (*map(int, arguments or []), *(2, 0)[len(arguments or []) :])
    print(
        "kind        share  worst  twice  strokes/least  RMS um, at junctions  right partners"
        "  skeleton, autotrace pieces/stroke  s/m"
    )
    every = list[Found]()
    with tempfile.TemporaryDirectory() as folder:
        for name, kind in KINDS.items():
            found = [
                measured(
                    kind(np.random.default_rng([k, len(name)])),
                    Path(folder) / "net.png",
                    k,
                    name,
                )
                for k in range(first, first + count)
            ]
            every += found
            _tell(name, found)
    _tell("all", every)
    _tell_worst(every)


def measured(strokes: Strokes, file: Path, seed: int, name: str = "net") -> Found:
    """Draw a net, follow it, and hold what was followed against what was drawn."""
    drawn(strokes, file, seed)
    drawing, begun = Drawing.open(file), time.process_time()
    trace = trace_ink(drawing)
    lines = [line.xy_mm for line in trace.lines]
    took_s = time.process_time() - begun
    # 1. the truth: each stretch once
    net = shapely.unary_union([shapely.LineString(stroke) for stroke in strokes])
    edges = [np.asarray(edge.coords) for edge in getattr(net, "geoms", [net])]
    truth = np.vstack([evenly(edge, STEP_MM) for edge in edges])
    junctions = junctions_of(edges)
    # 2. what was followed of it
    run = np.vstack([evenly(line[::10], STEP_MM) for line in lines])
    near = cKDTree(run).query(truth)[0] < ON_IT_MM
    run_mm = sum(length_mm(line) for line in lines)
    # 3. how far the strokes are from it
    away = np.array(shapely.distance(shapely.points(run), net))
    there = np.zeros(len(run), bool)
    if len(met := np.vstack([junctions, nearly_met(strokes)])):
        there = cKDTree(met).query(run)[0] < AT_JUNCTION_MM
    right = partners(strokes, junctions, lines)
    twice_mm = max(0.0, run_mm - net.length * float(near.mean()))
    return Found(
        net.length,
        net.length * float(near.mean()),
        twice_mm,
        len(lines),
        least_strokes(strokes),
        rms_um(away[~there]),
        rms_um(away[there]),
        len(right),
        sum(right),
        took_s,
        skeleton_pieces(drawing),
        autotrace_pieces(drawing),
        trace.ink.followed_share if trace.ink is not None else 0.0,
        f"{name} {seed}",
    )


def rms_um(away_mm: Points) -> float:
    """Root of the mean square of distances, um; 0 of none."""
    return UM * float(np.sqrt(np.mean(away_mm**2))) if len(away_mm) else 0.0


def partners(strokes: Strokes, junctions: Points, lines: Strokes) -> list[bool]:
    """For each true stroke at each junction that it passes, whether one line goes on through there."""
    right = list[bool]()
    placed = [evenly(line[::10], STEP_MM) for line in lines]
    tree = cKDTree(np.vstack(placed))
    which = np.repeat(np.arange(len(placed)), [len(line) for line in placed])
    at = np.concatenate([np.arange(len(line)) for line in placed])
    reach = round(PASSED_MM / STEP_MM)
    counts = np.array([len(line) for line in placed])
    is_ring = np.array([np.hypot(*(line[0] - line[-1])) < PEN_MM for line in placed])
    for stroke in strokes if len(junctions) else ():
        truth = evenly(stroke, STEP_MM)
        away = cKDTree(junctions).query(truth)[0]
        nearest = (away < STEP_MM) & (away == minimum_filter1d(away, 2 * reach))
        for k in np.flatnonzero(nearest):
            if not reach <= k < len(truth) - reach:
                continue
            # at either place another line may cross as near
            before, behind = tree.query_ball_point(
                truth[[k - reach, k + reach]], PASSED_ASIDE_MM
            )
            a, b = np.array(np.meshgrid(before, behind), int)
            of_one_line = which[a] == which[b]
            a, b = a[of_one_line], b[of_one_line]
            apart = abs(at[a] - at[b])
            round_it = np.where(is_ring[which[a]], counts[which[a]] - apart, apart)
            apart = np.minimum(apart, round_it)
            right.append(bool(np.any(abs(apart - 2 * reach) < 0.5 * reach)))
    return right


def drawn(strokes: Strokes, file: Path, seed: int) -> None:
    """A net as a pen draws it, scanned."""
    pixels = round(SHEET_MM * DPI / 25.4)
    scale = DPI / 25.4 * FINER  # the sheet is as large as its whole pixels
    fine = np.zeros((pixels * FINER,) * 2, np.uint8)
    for stroke in strokes:
        x = stroke[:, 0] * scale - 0.5
        y = pixels * FINER - stroke[:, 1] * scale - 0.5
        places = np.round(16 * np.column_stack([x, y])).astype(np.int32)
        cv2.polylines(fine, [places], False, 255, round(PEN_MM * scale), cv2.LINE_AA, 4)
    ink = cv2.resize(fine, (pixels, pixels), interpolation=cv2.INTER_AREA) / 255.0
    ink = cv2.GaussianBlur(ink, (0, 0), 0.6)
    grey = 235 - 195 * ink + np.random.default_rng(seed).normal(0, NOISE, ink.shape)
    Image.fromarray(np.clip(grey, 0, 255).astype(np.uint8)).save(file, dpi=(DPI, DPI))


def least_strokes(strokes: Strokes) -> int:
    """The fewest strokes of a pen that goes straight on where lines cross, and may go on into another where
    lines end: half of the ends that are left over there, one at least of lines that hang together.
    """
    _, node, degree = _nodes(strokes)
    part = np.arange(len(degree))
    for a, b in node.reshape(-1, 2):
        part[part == part[a]] = part[b]
    used = np.unique(node)
    odd = np.bincount(part[used], degree[used] % 2)
    return int(np.maximum(1, odd[np.unique(part[used])] // 2).sum())


def junctions_of(edges: Strokes) -> Points:
    """The places at which more than two edges end, (n, 2) mm."""
    ends, node, degree = _nodes(edges)
    return ends[degree[node] > 2]


def nearly_met(strokes: Strokes) -> Points:
    """The ends of strokes that come near those of others without meeting them, (n, 2) mm."""
    ends, node, _ = _nodes(strokes)
    has_ends = np.repeat(node[::2] != node[1::2], 2)
    ends, node = ends[has_ends], node[has_ends]
    if not len(ends):
        return ends
    near = cKDTree(ends).query_pairs(MET_WIDTHS * PEN_MM, output_type="ndarray")
    return ends[np.unique(near[node[near[:, 0]] != node[near[:, 1]]])]


def _nodes(lines: Strokes) -> tuple[Points, NDArray[np.int64], NDArray[np.int64]]:
    """The ends of lines, two for each, mm; which are one node, by the first of them; how many end at each."""
    ends = np.vstack([line[[0, -1]] for line in lines])
    tree = cKDTree(ends)
    node = np.full(len(ends), -1)
    for k in range(len(ends)):
        if node[k] < 0:
            node[tree.query_ball_point(ends[k], 1e-6)] = k
    return ends, node, np.bincount(node, minlength=len(ends))


def skeleton_pieces(drawing: Drawing) -> int:
    """Into how many pieces a skeleton of the ink falls at its junctions."""
    thin = skeletonize(drawing.darkness > 0.5)
    neighbours = convolve(thin.astype(np.uint8), np.ones((3, 3), np.uint8)) - 1
    return int(label(thin & (neighbours < 3), np.ones((3, 3)))[1])


def autotrace_pieces(drawing: Drawing) -> int | None:
    """How many paths autotrace makes of the middle lines of the ink; None where it is not installed."""
    try:
        from autotrace import Bitmap
    except ImportError:
        return None
    levels = np.where(drawing.darkness > 0.5, 0, 255).astype(np.uint8)
    bitmap = Bitmap(np.dstack([levels] * 3))
    return len(bitmap.trace(centerline=True, background_color=(255, 255, 255)).paths)


def _tell(name: str, found: list[Found]) -> None:
    """Print one row."""
    true_mm, followed_mm = sum(f.true_mm for f in found), sum(f.followed_mm for f in found)
    strokes, least = sum(f.strokes for f in found), sum(f.least for f in found)
    worst = min(f.followed_mm / f.true_mm for f in found)
    outside_um, there_um = (
        float(np.sqrt(np.mean([um**2 for um in ums])))
        for ums in ([f.rms_um for f in found], [f.at_junctions_um for f in found])
    )
    passes = sum(f.passes for f in found)
    right = f"{sum(f.right for f in found) / passes:18.2%}" if passes else f"{'–':>18s}"
    counts = [f.autotraced for f in found if f.autotraced is not None]
    autotraced = f"{sum(counts) / strokes:6.1f}" if counts else "     –"
    print(
        f"{name:10s} {followed_mm / true_mm:6.1%} {worst:6.1%} "
        f"{sum(f.twice_mm for f in found) / true_mm:6.1%} {strokes:5d}/{least:<5d} {strokes / least:5.2f}"
        f"{outside_um:8.1f}{there_um:8.1f}{right} {sum(f.pieces for f in found) / strokes:14.1f}"
        f"{autotraced}{1000 * sum(f.took_s for f in found) / true_mm:16.1f}",
        flush=True,
    )


def _tell_worst(found: list[Found]) -> None:
    """Print the worst drawing of each figure."""
    shares = [f.followed_mm / f.true_mm for f in found]
    worst = {
        "share": (min(shares), found[int(np.argmin(shares))].name, ".1%"),
        "RMS um": max((f.rms_um, f.name, ".1f") for f in found),
        "at junctions um": max((f.at_junctions_um, f.name, ".1f") for f in found),
        "share told above the true one": max(
            (f.told - f.followed_mm / f.true_mm, f.name, ".2%") for f in found
        ),
        "wrong partners": max((f.passes - f.right, f.name, "d") for f in found),
    }
    for figure, (value, name, form) in worst.items():
        print(f"worst {figure}: {value:{form}} at {name}")
    low = sum(share < LOW_SHARE for share in shares)
    outside_um = float(np.median([f.rms_um for f in found]))
    there_um = float(np.median([f.at_junctions_um for f in found]))
    print(
        f"drawings below {LOW_SHARE:.1%}: {low} of {len(found)}; "
        f"median RMS {outside_um:.1f} um, at junctions {there_um:.1f} um"
    )


if __name__ == "__main__":
    main(sys.argv[1:])
