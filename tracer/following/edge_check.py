"""Whether the head kept to the edges of filled shapes: they are known, and a run that left them, or left some
of one out, is a fault.

Signals: edges and a run in; out the run as it was, or as lost where it left the edge.

Lines leave it to the head what is one; of filled shapes the picture says it beforehand. The edges do not lead
the head: they only judge it.

Source: our own.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.motion.polyline import lengths_mm, with_places
from morfax.tracer.following.follower import Followed

OFF_MM = 0.15  # further from the edge than the head cuts a corner
EVERY_MM = 0.02  # between the places of an edge
THINNED = 8  # of the positions one in so many is looked at


def kept_to(edges_mm: tuple[Array, ...], run: Followed) -> Followed:
    """The run, if it kept to the edges, and, closed, left nothing of its edge out; else a run lost at the
    first place where it did not.
    """
    if not edges_mm:
        return run
    lines = [with_places(edge, EVERY_MM) for edge in edges_mm]
    edge = np.repeat(np.arange(len(lines)), [len(line) for line in lines])
    positions = run.positions_mm[::THINNED]
    away_mm, nearest = cKDTree(np.vstack(lines)).query(positions)
    off = np.flatnonzero(away_mm > OFF_MM)
    if len(off):
        return _lost(
            run, THINNED * int(off[0]), f"it goes {away_mm.max():.2f} mm away from the edge"
        )
    if run.ending == "closed":
        own = lines[int(np.bincount(edge[nearest]).argmax())]
        missed_mm, passed = cKDTree(positions).query(own)
        worst = int(np.argmax(missed_mm))
        if missed_mm[worst] > OFF_MM:
            return _lost(
                run,
                THINNED * int(passed[worst]),
                f"it leaves the edge out {missed_mm[worst]:.2f} mm beside its way",
            )
    return run


def _lost(run: Followed, at: int, why: str) -> Followed:
    """The run up to a position, where it was lost."""
    kept = run.positions_mm[: max(at, 1)]
    x, y = kept[-1]
    travel_mm = float(lengths_mm(kept)[-1])
    fault = LineFault(
        f"edge lost at {x:.2f},{y:.2f} mm, after {travel_mm:.1f} mm: the shape is too fine there for the head, {why};"
        " look at the drawing there, scan it at a higher resolution, or print it larger (--scale brings it back)",
        x_mm=float(x),
        y_mm=float(y),
        heading_rad=run.heading_rad,
    )
    return replace(
        run, positions_mm=kept, travel_mm=travel_mm, ending="lost", fault=fault, loop_from=None
    )
