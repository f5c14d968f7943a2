"""How far apart edges are: how fine the line along them has to be, so that it does not run into itself.

Signals: edges in pixels and the lens's softness in; out by how much finer than the picture the line is drawn.

    ____      ____        A rib, a slot, the top of a tooth: the edge comes back beside itself. So do the
        \\____/            two legs of a corner; a corner that was put back (see `sharpening`) does not count.

Source: our own. Questions: edges nearer than `CLEAR` move one another: by an eighth of their distance at two
standard deviations of the lens, and by more and more below that (two half-planes, seen through a normal
distribution). They are closed across (see `closing`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault
from morfax.motion.polyline import lengths_mm as lengths_px
from morfax.motion.polyline import with_places
from morfax.motion.usual import AT_ONCE
from morfax.tracer.drawing import memory
from morfax.tracer.drawing.sharpening import Edge
from morfax.tracer.limits import DETAIL_PX

# width of the line along edges (see `shapes`): at 300 dpi less than five pixels; with 0.3 mm a gear of 24
# teeth did not close
EDGE_MM = 0.4
FINEST = 4
CLEAR = 2.0  # standard deviations of the lens: edges that are nearer move one another
# times as far along the edge as straight across: it comes back, as round a hole (1.57)
BACK = 1.5
LEG = 0.95  # of the way along the edge is straight to a corner and straight on from it: legs of one corner
# times as far along, and it is another edge, and no corner that the lens has blurred
ROUND_ABOUT = 8


def finer(edges: list[Edge], shape: tuple[int, ...], pitch_mm: float) -> int:
    """By how much finer the line has to be drawn for edges that are near one another."""
    # of lines nearer than three of their widths the head would see two
    clear_mm = max(3 * EDGE_MM, DETAIL_PX * pitch_mm)
    apart_mm = nearest_px(edges, clear_mm / pitch_mm) * pitch_mm
    times = FINEST if apart_mm * FINEST < clear_mm else max(1, math.ceil(clear_mm / apart_mm))
    _make_room(apart_mm, times, shape)
    return times


def nearest_px(edges: list[Edge], within_px: float) -> float:
    """How near an edge comes to itself or another, if nearer than so much; the legs of a corner do not count.

    Looked for within an eighth of that first: millions of pairs may be within all of it.
    """
    for part in (0.125, 0.25, 0.5, 1.0):
        comes_back = Pairs.of(edges, part * within_px, BACK)
        nearest = comes_back.some(~_legs_of_corners(edges, comes_back)).nearest_px
        if nearest < math.inf:
            break
    return nearest


def too_near(edges: list[Edge], softness_px: float) -> Pairs:
    """The places of edges that are too near one another for the lens to show both where they are."""
    return Pairs.of(edges, CLEAR * softness_px, ROUND_ABOUT)


def _make_room(apart_mm: float, times: int, shape: tuple[int, ...]) -> None:
    """Raise DrawingFault if there is not the memory for a line that is so many times finer."""
    free, needed = memory.free_bytes(), memory.PER_PIXEL * times**2 * shape[0] * shape[1]
    if times > 1 and free is not None and needed > free:
        raise DrawingFault(
            f"edges {apart_mm:.2f} mm apart have to be drawn {times} times finer; that needs"
            f" {needed / memory.GB:.1f} GB of memory, {free / memory.GB:.1f} GB are free;"
            " cut out the part to be traced, or close other programs"
        )


@dataclass(frozen=True, slots=True)
class Pairs:
    """Pairs of places of edges that are near each other, pixels.

    The places (n, 2, 2), the numbers of their edges (n, 2), how far along these they are (n, 2), and how many
    times as far apart along the edge as straight across (n,), infinite from one edge to another.
    """

    places: Array
    edge: NDArray[np.int64]
    along: Array
    back: Array

    @classmethod
    def of(cls, edges: list[Edge], within_px: float, back: float) -> Pairs:
        """All pairs within so many pixels that are more than `back` times as far apart along the edge.

        At 600 dpi there are fifty within reach of each place, and hardly one of them comes back.
        """
        from scipy.spatial import cKDTree

        lines = [with_places(edge.outline, 1.0)[:-1] for edge in edges]
        places = np.vstack(lines)
        edge = np.repeat(np.arange(len(lines)), [len(line) for line in lines])
        along = np.concatenate([lengths_px(line) for line in lines])
        pairs = cKDTree(places).query_pairs(within_px, output_type="ndarray")
        lengths, found, backs = _lengths(edges), [pairs[:0]], [np.zeros(0)]
        for first in range(0, len(pairs), AT_ONCE):
            some = pairs[first : first + AT_ONCE]
            between = _between(along[some], lengths[edge[some[:, 0]]])
            between[edge[some[:, 0]] != edge[some[:, 1]]] = np.inf
            times = between / np.hypot(*(places[some[:, 0]] - places[some[:, 1]]).T)
            found.append(some[times > back])
            backs.append(times[times > back])
        pairs = np.vstack(found)
        return cls(places[pairs], edge[pairs], along[pairs], np.concatenate(backs))

    def some(self, which: NDArray[np.bool_]) -> Pairs:
        """Some of the pairs."""
        return Pairs(self.places[which], self.edge[which], self.along[which], self.back[which])

    @property
    def across(self) -> Array:
        """How far apart the places of each pair are, (n,)."""
        return np.asarray(np.hypot(*(self.places[:, 0] - self.places[:, 1]).T))

    @property
    def nearest_px(self) -> float:
        """How near the places of a pair are; infinite if there is none."""
        return float(self.across.min(initial=np.inf))


def _legs_of_corners(edges: list[Edge], pairs: Pairs) -> NDArray[np.bool_]:
    """Which pairs are on the two legs of one corner."""
    legs, lengths = np.zeros(len(pairs.back), bool), _lengths(edges)
    of_edge = np.where(pairs.edge[:, 0] == pairs.edge[:, 1], pairs.edge[:, 0], -1)
    by_edge = np.argsort(of_edge, kind="stable")
    firsts = np.searchsorted(of_edge, np.arange(len(edges) + 1), sorter=by_edge)
    for number, edge in enumerate(edges):
        own = by_edge[firsts[number] : firsts[number + 1]]
        if not len(own) or not len(edge.corners):
            continue
        along = np.sort(pairs.along[own], axis=1)
        # 1. the corner that is nearest to the middle between the two places, along the edge
        length = lengths[number]
        forward = along[:, 1] - along[:, 0] <= 0.5 * length
        middle = (along.mean(axis=1) + np.where(forward, 0.0, 0.5 * length)) % length
        apart = np.abs(middle[:, None] - lengths_px(edge.outline)[edge.corners])
        nearest = np.minimum(apart, length - apart).argmin(axis=1)
        corner = edge.outline[edge.corners[nearest]]
        # 2. straight to the corner and straight on is nearly as far as along the edge
        ways = pairs.places[own] - corner[:, None]
        straight = np.hypot(*ways.transpose(2, 0, 1)).sum(axis=1)
        between = _between(pairs.along[own], np.full(len(own), length))
        legs[own] = straight > LEG * between
    return legs


def _lengths(edges: list[Edge]) -> Array:
    return np.array([lengths_px(edge.outline)[-1] for edge in edges])


def _between(along: Array, length: Array) -> Array:
    """How far apart two places (n, 2) are along closed edges of some lengths (n,), the shorter way."""
    apart = np.abs(along[:, 0] - along[:, 1])
    return np.asarray(np.minimum(apart, length - apart))
