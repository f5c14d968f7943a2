"""Within reach: which places are near to a way, when it is not asked how near.

Signals: places (n, 2) and a way (m, 2), mm, in; for each place whether it is nearer than a reach out.

Source: our own. Questions: none.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.plane import NOTHING_MM2
from morfax.tracer.tangles.distances import BOXED, boxes_of, to_box2


def are_within(places: Array, way: Array, reach_mm: float) -> NDArray[np.bool_]:
    """Whether places (n, 2) are nearer to a way (m, 2) than a reach, mm."""
    within = np.empty(len(places), bool)
    _are_within(
        places, np.ascontiguousarray(np.hstack([way[:-1], way[1:]]).T), reach_mm, within
    )
    return within


@njit(cache=True, fastmath=True)
def _are_within(places, lines, reach_mm, out):  # type: ignore[no-untyped-def]
    """Fill in which places are nearer to some pieces than a reach: the first piece that is near tells.

    The piece that told of the place before comes first; the others only in boxes within reach.
    """
    x0, y0 = lines[0], lines[1]
    vx, vy = lines[2] - x0, lines[3] - y0
    per = 1.0 / (vx * vx + vy * vy + NOTHING_MM2)
    boxes, near, reach2 = boxes_of(lines), 0, reach_mm * reach_mm
    for k in range(len(places)):
        x, y = places[k, 0], places[k, 1]
        out[k] = False
        for b in range(-1, len(boxes)):
            if b >= 0 and to_box2(boxes, b, x, y) >= reach2:
                continue
            first, last = (near, near + 1) if b < 0 else (b * BOXED, (b + 1) * BOXED)
            for i in range(first, min(last, len(per))):
                wx, wy = x - x0[i], y - y0[i]
                t = min(max((wx * vx[i] + wy * vy[i]) * per[i], 0.0), 1.0)
                wx, wy = wx - t * vx[i], wy - t * vy[i]
                away2 = wx * wx + wy * wy
                if away2 < reach2 and math.sqrt(away2) < reach_mm:
                    out[k], near = True, i
                    break
            if out[k]:
                break
