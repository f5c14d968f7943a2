"""The wavefront: how a wave runs through the ink ahead of the head, and splits where the ink does.

A front is the ink that the wave reaches within one step of its way. In a line the fronts are as broad as the
line is, however it bends; in a tangle they are broader; at a tip they end.

Signals: darkness on a window of the sheet, pixels, in; a tree of fronts with their places and breadths, mm,
out.

            |  |  | |||                      in ink, not on paper: a ring of cells
                                                     would see the neighbour's ink too
      ------|--|--||  |||--|--|---
       wave |  |  |  || |  |  |
                  ----|------

Source: our own; distances within a shape by relaxing neighbours are the textbook's way.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.distances import away_from

FAR = 1e9  # pixels: where the wave has not come
STEP_MM, STEP_PX = 0.1, 1.5  # how far the wave runs from front to front, at least; by trial
LEAST_PX = 1e-6  # a distance is lowered by no less

OPEN, STARTS = 1, 2  # of ink: where the wave may run, and where it starts
# the start: so far ahead, and half a width less a little to either side
START_PX, START_ASIDE = 1.5, 0.4
# widths, pixels behind and widths aside of the start: shut off
SHUT, SHUT_PX, SHUT_ASIDE = 2.0, 2.0, 0.9
SHUT_WAY = 0.6  # widths from a way that was run: shut off
MARGIN_PX = 4  # of the window beyond the reach

# moves to a neighbour and by a knight's move (rows, columns), which is open if its half way is: distances
# are then true to 3 %
MOVES = np.array(
    [
        (i, j)
        for i in range(-2, 3)
        for j in range(-2, 3)
        if abs(i * j) == 2 or max(abs(i), abs(j)) == 1
    ]
)
LENGTHS = np.sqrt(np.sum(MOVES * MOVES, axis=1))
HALVES = np.trunc(MOVES / 2).astype(np.int64)


@dataclass(frozen=True, slots=True)
class Fronts:
    """Fronts in the order in which the wave comes to them, `at` steps from the start.

    `label` is each pixel's front in the window, -1 on paper and where the wave did not come; the window
    begins at the row and column `corner` of the sheet.
    """

    step_mm: float
    at: NDArray[np.int64]
    places_mm: Array
    breadth_mm: Array
    parents: list[list[int]]
    children: list[list[int]]
    label: NDArray[np.int32]
    corner: tuple[int, int]

    def beyond_mm(self) -> Array:
        """How far the wave runs on from each front, mm."""
        steps = np.zeros(len(self.at), int)
        for k in range(len(self.at) - 1, -1, -1):
            steps[k] = max((steps[b] + 1 for b in self.children[k]), default=0)
        return steps * self.step_mm

    def way_to(self, front: int) -> Array:
        """The way (n, 2) mm by which the wave came to a front, from its start on."""
        way = [front]
        while self.parents[way[-1]]:
            way.append(self.parents[way[-1]][0])
        return self.places_mm[way[::-1]]


def fronts_from(
    view: View,
    place: Array,
    heading: float,
    reach_mm: float,
    behind_mm: Array | None = None,
) -> Fronts:
    """The fronts of a wave that starts across the line at a place and runs ahead as far as `reach_mm`, and
    not into the ink along a way (n, 2) mm that ends there.
    """
    # 1. a window of the sheet about the place
    rows, pitch = view.cells.shape[0], view.pitch_mm
    half = math.ceil(reach_mm / pitch) + MARGIN_PX
    x, y = place[0] / pitch - 0.5, rows - place[1] / pitch - 0.5
    row, column = round(y), round(x)
    top, left = max(0, row - half), max(0, column - half)
    window = view.cells.window(top, row + half + 1, left, column + half + 1)
    # 2. the wave in it, and its fronts
    pose = float(x - left), float(y - top), float(heading)
    ground = _ground(window, view.level, pose, view.width_mm / pitch)
    if behind_mm is not None:
        corner_mm = np.array([left + 0.5, rows - top - 0.5]) * pitch
        _shut_along(ground, (behind_mm - corner_mm) / pitch * [1, -1], view.width_mm / pitch)
    step_px = max(STEP_MM / pitch, STEP_PX)
    label, table, links = _split(_wave(ground, reach_mm / pitch), step_px)
    # 3. in the order of the wave
    order = np.argsort(table[:, 0], kind="stable")
    number = np.argsort(order).astype(np.int32)
    parents: list[list[int]] = [[] for _ in order]
    children: list[list[int]] = [[] for _ in order]
    for a, b in dict.fromkeys(zip(*number[links].T.tolist(), strict=True)):
        parents[b].append(a)
        children[a].append(b)
    steps, pixels, at_row, at_column = table[order].T
    places = np.column_stack(
        [(at_column + left + 0.5) * pitch, (rows - at_row - top - 0.5) * pitch]
    )
    if len(number):
        label = np.where(label >= 0, number[label], np.int32(-1))
    at, breadth = steps.astype(np.int64), pixels * pitch / step_px
    return Fronts(step_px * pitch, at, places, breadth, parents, children, label, (top, left))


@njit(cache=True)
def _ground(darkness, level, pose, width_px):  # type: ignore[no-untyped-def]
    """Where the wave may run: OPEN ink, and where it STARTS, of a pose (column, row, heading rad).

    A strip of ink behind the start is closed, so that the wave runs ahead only.
    """
    rows, columns = darkness.shape
    out = np.zeros((rows, columns), np.int8)
    column, row, heading = pose
    c, s = math.cos(heading), -math.sin(heading)  # rows run down
    for i in range(rows):
        for j in range(columns):
            along = (j - column) * c + (i - row) * s
            aside = abs((i - row) * c - (j - column) * s)
            if darkness[i, j] <= level:
                continue
            if aside < SHUT_ASIDE * width_px and -SHUT * width_px - SHUT_PX < along < 0:
                continue
            starts = 0 <= along < START_PX and aside < START_ASIDE * width_px
            out[i, j] = STARTS if starts else OPEN
    return out


def _shut_along(ground: NDArray[np.int8], way_px: Array, width_px: float) -> None:
    """Close the ink along a way (n, 2), columns and rows, in place, but for what lies ahead of its end."""
    rows, columns = np.nonzero(ground)
    places = np.column_stack([columns, rows]).astype(float)
    end, ahead = way_px[-1], way_px[-1] - way_px[-2]
    away_px = away_from(places, way_px)
    from_end = places - end
    is_ahead = (np.hypot(*from_end.T) < away_px + LEAST_PX) & (from_end @ ahead >= 0)
    shut = (away_px < SHUT_WAY * width_px) & ~is_ahead
    ground[rows[shut], columns[shut]] = 0


@njit(cache=True)
def _wave(ground, reach_px):  # type: ignore[no-untyped-def]
    """How far each pixel of ink is from the start, within the ink, pixels; FAR where no wave comes."""
    rows, columns = ground.shape
    out = np.full((rows, columns), FAR)
    queue = np.empty((rows * columns, 2), np.int32)
    waiting = np.zeros((rows, columns), np.bool_)
    first, count = 0, _begin(ground, out, queue, waiting)
    # each pixel that waits passes its distance on; those that it lowers wait in turn
    while count > 0:
        i, j = queue[first, 0], queue[first, 1]
        first, count = (first + 1) % len(queue), count - 1
        waiting[i, j] = False
        for k in range(len(MOVES)):
            y, x = i + MOVES[k, 0], j + MOVES[k, 1]
            if not (0 <= y < rows and 0 <= x < columns):
                continue
            if not ground[y, x] or not ground[i + HALVES[k, 0], j + HALVES[k, 1]]:
                continue
            there = out[i, j] + LENGTHS[k]
            if there < out[y, x] - LEAST_PX and there < reach_px:
                out[y, x] = there
                if not waiting[y, x]:
                    last = (first + count) % len(queue)
                    queue[last, 0], queue[last, 1] = y, x
                    waiting[y, x] = True
                    count += 1
    return out


@njit(cache=True)
def _begin(ground, out, queue, waiting):  # type: ignore[no-untyped-def]
    """Put the pixels where the wave starts into the queue; how many."""
    count = 0
    for i in range(ground.shape[0]):
        for j in range(ground.shape[1]):
            if ground[i, j] == STARTS:
                out[i, j] = 0.0
                queue[count, 0], queue[count, 1] = i, j
                waiting[i, j] = True
                count += 1
    return count


@njit(cache=True)
def _split(distance, step_px):  # type: ignore[no-untyped-def]
    """The fronts as connected pixels within one step.

    Label of each pixel; (step, pixels, row, column) of each front; pairs of fronts that follow each other.
    """
    rows, columns = distance.shape
    label = np.full((rows, columns), -1, np.int32)
    stack = np.empty((rows * columns, 2), np.int32)
    table = np.empty((rows * columns, 4))
    count = 0
    for i in range(rows):
        for j in range(columns):
            if label[i, j] < 0 and distance[i, j] < FAR:
                label[i, j] = count
                stack[0, 0], stack[0, 1] = i, j
                _fill(distance, step_px, label, stack, table[count])
                count += 1
    table = table[:count].copy()
    return label, table, _links(label, table)


@njit(cache=True)
def _fill(distance, step_px, label, stack, row):  # type: ignore[no-untyped-def]
    """Label the pixels of the front that holds the first pixel of a stack; write its row of the table."""
    rows, columns = distance.shape
    i, j = stack[0, 0], stack[0, 1]
    number, step = label[i, j], int(distance[i, j] / step_px)
    waiting, pixels, at_row, at_column = 1, 0, 0.0, 0.0
    while waiting > 0:
        waiting -= 1
        i, j = stack[waiting, 0], stack[waiting, 1]
        pixels, at_row, at_column = pixels + 1, at_row + i, at_column + j
        for y in range(max(0, i - 1), min(rows, i + 2)):
            for x in range(max(0, j - 1), min(columns, j + 2)):
                free = label[y, x] < 0 and distance[y, x] < FAR
                if free and int(distance[y, x] / step_px) == step:
                    label[y, x] = number
                    stack[waiting, 0], stack[waiting, 1] = y, x
                    waiting += 1
    row[0], row[1] = step, pixels
    row[2], row[3] = at_row / pixels, at_column / pixels


@njit(cache=True)
def _links(label, table):  # type: ignore[no-untyped-def]
    """Pairs of fronts (n, 2) that touch, the second one step further than the first; some several times."""
    rows, columns = label.shape
    links, newest = np.empty((8 * rows * columns, 2), np.int32), np.full(len(table), -1)
    found = 0
    for i in range(rows):
        for j in range(columns):
            a = label[i, j]
            if a < 0:
                continue
            for y in range(max(0, i - 1), min(rows, i + 2)):
                for x in range(max(0, j - 1), min(columns, j + 2)):
                    b = label[y, x]
                    # most fronts lead on to one alone
                    if b < 0 or b == newest[a] or table[b, 0] != table[a, 0] + 1:
                        continue
                    links[found, 0], links[found, 1] = a, b
                    newest[a] = b
                    found += 1
    return links[:found].copy()
