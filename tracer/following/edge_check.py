"""The edge check: whether the head kept to the known edges of filled shapes.

Signals: edges and a run in (mm); out the run as it was, or as lost where it left the edge, or where it left
some of the edge out.

The head itself decides what is a line. The edges of filled shapes are known from the picture beforehand. They
do not lead the head: they only check what it did.

Source: our own.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.motion.faults import LineFault
from morfax.motion.neighbours import Neighbours
from morfax.motion.polyline import APART_MM, lengths_mm, with_places
from morfax.tracer.drawing.known_edges import KnownEdges
from morfax.tracer.following.followed import Followed
from morfax.tracer.head.slow_cell import CHECKED
from morfax.tracer.limits import DETAIL_PX

# a tip of 15 degrees that one of both has put back, and the other has left round, is as far off: six standard
# deviations of a lens (see `drawing.lens`); of a lens as soft as a pixel, where pixels are large
OFF_MM = 0.5
LEFT_MM = 0.15  # where the run was so far off it had left the edge; further than the head cuts a corner


def most_off_mm(pitch_mm: float) -> float:
    """How far from the edges a run may be on pixels of a size, mm; beyond `OFF_MM` it is told."""
    return max(OFF_MM, DETAIL_PX * pitch_mm)


def kept_to(edges: KnownEdges, run: Followed) -> Followed:
    """The run, if it kept to the edges and, closed, left none of its edge out; else lost at that place."""
    if not edges.all_mm:
        return run
    positions, most_mm = run.positions_mm[::CHECKED], most_off_mm(run.view.pitch_mm)
    # 1. every position lies on an edge; how far one is away is asked of all of them
    for some in (edges.near(positions, most_mm), edges.all_mm):
        lines = [with_places(edge, APART_MM) for edge in some]
        away_mm, nearest = Neighbours(np.vstack([*lines, np.empty((0, 2))])).nearest(positions)
        off = np.flatnonzero(away_mm > most_mm)
        if not len(off):
            break
    if len(off):
        why = f"it goes {away_mm.max():.2f} mm away from the edge"
        left = np.flatnonzero(away_mm[: off[0]] < LEFT_MM)
        return _lost(run, CHECKED * int(left[-1] if len(left) else 0), why)
    # 2. a closed run passed every place of its own edge
    if run.ending == "closed":
        owner = np.repeat(np.arange(len(lines)), [len(line) for line in lines])
        own = lines[int(np.bincount(owner[nearest]).argmax())]
        missed_mm, passed = Neighbours(positions).nearest(own)
        worst = int(np.argmax(missed_mm))
        if missed_mm[worst] > most_mm:
            why = f"it passes some of the edge {missed_mm[worst]:.2f} mm away"
            return _lost(run, CHECKED * int(passed[worst]), why)
    return run


def _lost(run: Followed, at: int, why: str) -> Followed:
    """The run up to a position, where it was lost."""
    kept = run.positions_mm[: max(at, 1)]
    x, y = kept[-1]
    travel_mm = float(lengths_mm(kept)[-1])
    fault = LineFault(
        f"edge lost at {x:.2f},{y:.2f} mm, after {travel_mm:.1f} mm: the shape is too fine for the head,"
        f" {why}; look at the drawing there, scan at a higher resolution, or print it larger (--scale"
        " brings it back)",
        x_mm=float(x),
        y_mm=float(y),
        heading_rad=run.heading_rad,
    )
    return replace(
        run, positions_mm=kept, travel_mm=travel_mm, ending="lost", fault=fault, loop_from=None
    )
