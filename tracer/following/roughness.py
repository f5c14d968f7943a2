"""Roughness: how far an edge strays from its own smooth way, beyond what the noise of the pixels explains.

    pieces    3 mm each, all along the edge, where it bends little and the head ran through no corner
    felt      stations along a piece, by a cell that goes in circles (see `edge_scout`)
    noise     of the same circles beside the edge, in paper and in shape, over the edge's steepness

    roughness² = median of (distance of the stations from their own parabola)² - noise²

Signals: what the head did on an edge, sheet mm, in; the edge's roughness, a standard deviation in mm, out.

Source: raggedness of ISO/IEC 13660, the standard deviation of an edge from the line that fits it. Questions:
there the edge is a straight line's; here the way may bend, so waves longer than a piece belong to the shape.
What is drawn finer than that counts as rough: a coast is.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.motion.plane import heading_of, left_of, unit
from morfax.motion.polyline import lengths_mm
from morfax.motion.usual import THINNED
from morfax.tracer.effort import MANY
from morfax.tracer.following.followed import Followed
from morfax.tracer.head.leaders import CELL, STATIONS
from morfax.tracer.limits import DETAIL_PX, PIECE_MM
from morfax.tracer.sensing.edge_scout import CIRCLE_PX, CIRCLE_SAMPLES
from morfax.tracer.sensing.leg import turn
from morfax.tracer.sensing.view import View

FEWEST_PIECES = 3
FELT = 0.9  # of a piece: where less is felt the edge ends, or turns back
# from the first third of a piece to its last: a parabola follows that within 2 um
BENT_RAD = 0.5
EVERY = 3  # one station in so many has circles beside it, as far apart as a circle is wide
AROUND = np.arange(CIRCLE_SAMPLES) * (2 * np.pi / CIRCLE_SAMPLES)  # where a circle looks


def roughness_mm(run: Followed) -> float | None:
    """The roughness of the edge that a head followed, mm; None for a line, or if too little of it is even."""
    if not run.view.on_edge:
        return None
    found = [
        deviations
        for place_mm, heading in _pieces(run)
        if (deviations := _deviations_mm(run.view, place_mm, heading)) is not None
    ]
    if len(found) < FEWEST_PIECES:
        return None
    strays_mm, noise_mm = np.median(np.square(found), axis=0).tolist()
    return math.sqrt(max(strays_mm - noise_mm, 0.0))


def _pieces(run: Followed) -> list[tuple[Array, float]]:
    """Where pieces of the edge begin that bend little and were not run from memory: places and headings."""
    places, leaders = run.led.thinned(run.positions_mm, THINNED)
    come_mm, led = lengths_mm(places), np.isin(leaders, (CELL, STATIONS))
    over_mm = float(come_mm[-1]) - PIECE_MM
    if over_mm < 0:
        return []
    pieces = list[tuple[Array, float]]()
    count = min(MANY, int(over_mm / PIECE_MM) + 1)
    for from_mm in np.linspace(0.0, over_mm, count):
        at = np.searchsorted(come_mm, from_mm + PIECE_MM * np.arange(4) / 3).clip(
            max=len(places) - 1
        )
        if not led[at[0] : at[-1] + 1].all() or not np.all(np.diff(at) > 0):
            continue
        first, _, last = (heading_of(way) for way in np.diff(places[at], axis=0))
        if abs(turn(first, last)) < BENT_RAD:
            pieces.append((places[at[0]], first))
    return pieces


def _deviations_mm(view: View, place_mm: Array, heading: float) -> tuple[float, float] | None:
    """By how much a piece of edge strays from its parabola, and stations from the edge by noise, mm."""
    seen = view.feel_edge(place_mm, heading, PIECE_MM)
    if len(seen) * view.step_mm < FELT * PIECE_MM:
        return None
    chord = seen[-1, :2] - seen[0, :2]
    along = unit(chord)
    left = left_of(along)
    x, y = seen[:, :2] @ along, seen[:, :2] @ left
    x, y = x - x.mean(), y - y.mean()
    strays_mm = float(np.std(y - np.polyval(np.polyfit(x, y, 2), x)))
    heard = [
        np.std(_circles(view, seen[::EVERY, :2] + side * DETAIL_PX * view.pitch_mm * left))
        for side in (-1, 1)
    ]
    per_mm = median(seen[:, 2]) / (CIRCLE_PX * view.pitch_mm)
    return strays_mm, math.sqrt(float(np.mean(np.square(heard)))) / per_mm


def _circles(view: View, places_mm: Array) -> Array:
    """The mean of what a cell sees once round each of some places (n, 2) mm."""
    circle = CIRCLE_PX * view.pitch_mm * np.column_stack([np.cos(AROUND), np.sin(AROUND)])
    around = (places_mm[:, None] + circle).reshape(-1, 2)
    return view.darkness_along(around).reshape(len(places_mm), -1).mean(axis=1)
