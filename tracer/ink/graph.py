"""The graph of a sheet's ink: which stretches of line there are, and at which nodes they hang together.

Signals: a mask of ink in; out stretches between nodes, each a list of thinned pixels (`drawing.thinning`).
The graph only says where the head is to be put down and what leads where; the path is felt by the cells.

    ──────┬──────     three stretches that meet at a node; a node is an end of ink or a fork of it
          │           a ring without a node is a stretch from a place of it round to that place

A stretch that leaves a fork and ends within the line's own ink is a burr of its edge, and is taken off. Where
two stretches are left at a fork they are one.

Source: our own.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.tracer.drawing.components import Mask, grouped
from morfax.tracer.drawing.depth import depth_at
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.thinning import Indices, neighbours, thinned

# beyond the disc that fills the ink at a fork, in depths of the ink there, and pixels: a stretch that ends no
# further out is a burr; by trial on nets and line art
BURR_DEPTHS, BURR_PX = 0.5, 1.5
RING = -1  # in the place of a node: a stretch that comes round without one


@dataclass(frozen=True, slots=True)
class Stretch:
    """A stretch of ink between two nodes (`RING` for both if there is none): its pixels, numbered as in the
    graph, from the first node to the second.
    """

    nodes: tuple[int, int]
    pixels: Indices


@dataclass(frozen=True, slots=True)
class Graph:
    """Thinned pixels of a sheet, their depth in the ink (pixels from the paper), and the stretches."""

    rows: Indices
    columns: Indices
    depths_px: Array
    stretches: list[Stretch]

    @classmethod
    def of(cls, ink: Mask, top: int = 0, left: int = 0) -> Graph:
        """The graph of some ink on a sheet; the mask begins at that row and column of it."""
        rows, columns = thinned(ink)
        depths_px = np.asarray(depth_at(ink, rows, columns), float)
        graph = cls(rows + top, columns + left, depths_px, [])
        order, begins, ends = _stretches(neighbours(graph.rows, graph.columns))
        for begin, end in zip(begins, ends, strict=True):
            pixels = order[begin:end]
            is_ring = pixels[0] == pixels[-1] and not graph._is_fork(
                pixels[0], order, begins, ends
            )
            nodes = (RING, RING) if is_ring else (int(pixels[0]), int(pixels[-1]))
            graph.stretches.append(Stretch(nodes, pixels))
        graph._take_off_burrs()
        return graph

    def _is_fork(self, pixel: int, order: Indices, begins: Indices, ends: Indices) -> bool:
        """Whether another stretch than a single ring begins or ends at a pixel."""
        return bool(np.sum(order[begins] == pixel) + np.sum(order[ends - 1] == pixel) > 2)

    def places_mm(self, drawing: Drawing) -> Array:
        """The middles of its pixels, (n, 2) sheet mm."""
        rows = drawing.darkness.shape[0]
        places = np.column_stack([self.columns + 0.5, rows - self.rows - 0.5])
        return np.asarray(places * drawing.pitch_mm)

    def on_stretches(self) -> NDArray[np.bool_]:
        """Which of its pixels are on a stretch, and no burr that was taken off."""
        are_on = np.zeros(len(self.rows), bool)
        for stretch in self.stretches:
            are_on[stretch.pixels] = True
        return are_on

    def at_nodes(self) -> dict[int, list[int]]:
        """The stretches (their numbers, twice if both ends) at each node."""
        at = dict[int, list[int]]()
        for number, stretch in enumerate(self.stretches):
            for node in stretch.nodes if stretch.nodes[0] != RING else ():
                at.setdefault(node, []).append(number)
        return at

    def patches(self) -> Indices:
        """The patch of each stretch, by its number: stretches of one patch hang together at nodes."""
        pairs = [(some[0], n) for some in self.at_nodes().values() for n in some[1:]]
        return np.asarray(
            grouped(np.array(pairs, np.int64).reshape(-1, 2), len(self.stretches))
        )

    def _take_off_burrs(self) -> None:
        """Take off burrs, the shortest of a fork first; two stretches that are left at a fork are one."""
        while True:
            at = self.at_nodes()
            burrs = {
                n for n, stretch in enumerate(self.stretches) if self._is_burr(stretch, at)
            }
            taken = {
                self._one_of(at[fork], burrs) for fork in at if burrs.intersection(at[fork])
            }
            if not taken:
                break
            self.stretches[:] = [s for n, s in enumerate(self.stretches) if n not in taken]
            self._join_pairs()

    def _one_of(self, numbers: list[int], burrs: set[int]) -> int:
        """The shortest burr of those at a node."""
        return min(
            (n for n in numbers if n in burrs), key=lambda n: len(self.stretches[n].pixels)
        )

    def _is_burr(self, stretch: Stretch, at: dict[int, list[int]]) -> bool:
        """Whether a stretch leaves a fork and ends within the ink of the line there."""
        if stretch.nodes[0] == RING:
            return False
        counts = [len(at[node]) for node in stretch.nodes]
        if sorted(counts)[0] != 1 or sorted(counts)[1] < 3:
            return False
        fork = stretch.pixels[0 if counts[0] > 1 else -1]
        beyond_px = len(stretch.pixels) - 1 - self.depths_px[fork]
        return bool(beyond_px < BURR_DEPTHS * self.depths_px[fork] + BURR_PX)

    def _join_pairs(self) -> None:
        """Make one stretch of two that are alone at a node; those that are made come last."""
        at, left = self.at_nodes(), dict(enumerate(self.stretches))
        numbered_on = count(len(left))
        for node, numbers in at.items():
            if len(numbers) != 2:
                continue
            old, new = set(numbers), next(numbered_on)
            joined = left[new] = _joined([left.pop(n) for n in sorted(old)], node)
            for end in joined.nodes if joined.nodes[0] != RING else ():
                at[end][:] = [new if n in old else n for n in at[end]]
        self.stretches[:] = left.values()


def _joined(two: list[Stretch], node: int) -> Stretch:
    """One stretch of two that meet at a node, or the ring of one that comes back to it."""
    if len(two) == 1:
        return Stretch((RING, RING), two[0].pixels)
    one, other = two
    first = one.pixels if one.nodes[1] == node else one.pixels[::-1]
    last = other.pixels if other.nodes[0] == node else other.pixels[::-1]
    pixels = np.concatenate([first, last[1:]])
    return Stretch((int(pixels[0]), int(pixels[-1])), pixels)


class _Walk(NamedTuple):
    """What a walk along thinned pixels takes and leaves."""

    beside: Indices  # the neighbours of each pixel, (n, 8)
    links: Indices  # how many each has
    walked: NDArray[np.bool_]  # (n, 8): the links that were walked
    used: NDArray[np.bool_]  # the pixels that were come to
    order: Indices  # the pixels of all stretches, as they were walked


@njit(cache=True)
def _stretches(beside):  # type: ignore[no-untyped-def]
    """Pixels along each stretch, one after the other, and where each begins and ends among them."""
    count = len(beside)
    links = (beside >= 0).sum(axis=1)
    walked, used = np.zeros(beside.shape, np.bool_), np.zeros(count, np.bool_)
    walk = _Walk(beside, links, walked, used, np.empty(4 * count + 8, np.int64))
    begins, ends = np.empty(2 * count + 1, np.int64), np.empty(2 * count + 1, np.int64)
    written = made = 0
    # from every node along each of its links; then once round each ring, as what is left is
    for are_nodes in (True, False):
        for start in range(count):
            if (links[start] != 2) != are_nodes or (used[start] and not are_nodes):
                continue
            for link in range(8):
                if beside[start, link] < 0 or walked[start, link]:
                    continue
                begins[made] = written
                written = _walked(walk, start, link, written)
                ends[made] = written
                made += 1
                if not are_nodes:
                    break
    return walk.order[:written].copy(), begins[:made].copy(), ends[:made].copy()


@njit(cache=True)
def _walked(walk, start, link, written):  # type: ignore[no-untyped-def]
    """Walk from a pixel along one of its links to the next node, or round to where it began; the number of
    pixels written so far.
    """
    walk.order[written] = at = start
    while True:
        written += 1
        walk.walked[at, link] = True
        here = walk.beside[at, link]
        back = (link + 4) % 8
        walk.walked[here, back] = True
        walk.used[here] = True
        walk.order[written] = here
        if walk.links[here] != 2 or here == start:
            return written + 1
        for other in range(8):
            if walk.beside[here, other] >= 0 and other != back:
                at, link = here, other
                break
