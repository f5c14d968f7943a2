"""Tips: where a filled shape runs out so sharply that its outline ends short of where its legs meet.

Signals: outlines in pixels with the corners that were put back, and the softness of the edge (standard
deviation, pixels) in; out the tips that were not, each with its place and how far it ends short.

    ────────────╮            the lens leaves less than half of the darkness where the shape is thinner than
                 )  · · · >  about 1.5 standard deviations: there the outline turns round, and the legs, which
    ────────────╯            are felt further back, meet beyond

Source: our own. Questions: the legs are straight here; where bent ones meet is less certain.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import meeting
from morfax.motion.polyline import evenly
from morfax.tracer.drawing.sharpening import Edge, most_turned, turned_at
from morfax.tracer.effort import FINE_PX
from morfax.tracer.limits import FADES

SHARPEST, BLUNTEST = math.radians(3), math.radians(45)  # between the legs of a tip
TURNED = math.radians(100)  # the outline about it, at least
NEAR, FAR = 10.0, 30.0  # standard deviations from the tip, between which the legs are felt
STRAIGHT = 0.5  # standard deviations that they may be bent by
SHORT = 2.0  # standard deviations that a tip may end short by, untold: so do corners that are left round


class Tip(NamedTuple):
    """A tip: its end on the outline (row and column), the angle between its legs, how far short it ends."""

    place: Array
    angle_rad: float
    short_px: float


def tips_of(edge: Edge, softness_px: float) -> list[Tip]:
    """The tips of a closed outline that end short, the worst first."""
    places = evenly(edge.outline, FINE_PX)
    reach = max(2, round(FADES * softness_px / FINE_PX))
    if len(places) < 2 * round(FAR * softness_px / FINE_PX):
        return []
    found = most_turned(turned_at(places, reach), TURNED, 2 * reach)
    tips = [tip for k in found if (tip := _tip(places, k, softness_px)) is not None]
    return sorted(tips, key=lambda tip: -tip.short_px)


def note(tips: list[tuple[Tip, tuple[float, float]]], pitch_mm: float) -> str:
    """What the operator should know of some tips, each with its place (X, Y mm), the worst first."""
    tip, (x, y) = tips[0]
    many = "1 tip is" if len(tips) == 1 else f"{len(tips)} tips are"
    return (
        f"{many} too sharp for the scan to show: the path ends {tip.short_px * pitch_mm:.2g} mm short at "
        f"{x:.1f},{y:.1f} mm ({math.degrees(tip.angle_rad):.0f} degrees); printed twice as large, and with "
        "--scale 0.5, it ends half as far short"
    )


def _tip(places: Array, at: int, softness_px: float) -> Tip | None:
    """The tip about a place; None if its legs are not straight, or do not meet far enough beyond it."""
    near, far = (round(share * softness_px / FINE_PX) for share in (NEAR, FAR))
    legs = [_leg(places, at, side * near, side * far) for side in (-1, 1)]
    if any(off > STRAIGHT * softness_px for _, _, off in legs):
        return None
    (p, t, _), (q, w, _) = legs
    angle = math.acos(float(np.clip(t @ w, -1, 1)))
    if not SHARPEST < angle < BLUNTEST:
        return None
    vertex = meeting(p, t, q, w)
    short_px = float((vertex - places[at]) @ (t + w)) / float(np.hypot(*(t + w)))
    return Tip(places[at], angle, short_px) if short_px > SHORT * softness_px else None


def _leg(places: Array, at: int, near: int, far: int) -> tuple[Array, Array, float]:
    """A straight leg between two distances from a place: its middle, its direction towards the place, and by
    how much the outline is off it, pixels.
    """
    leg = places[(np.arange(min(near, far), max(near, far) + 1) + at) % len(places)]
    middle = leg.mean(axis=0)
    _, spread, ways = np.linalg.svd(leg - middle, full_matrices=False)
    towards = ways[0] * math.copysign(1.0, float((places[at] - middle) @ ways[0]))
    return middle, towards, float(spread[1]) / math.sqrt(len(leg))
