"""Fronts: how a wave runs through the ink ahead of the head, and splits where the ink does.

Signals: darkness on a window of the sheet, pixels; out a tree of fronts, each the ink that the wave reaches
within one step of its way, with its place and its breadth. In a line the fronts are as broad as the line is,
however it bends; in a tangle they are broader; at a tip they end.

            |  |  | |||                      in ink, not on paper: a ring of cells would see the neighbour's ink too
      ------|--|--||  |||--|--|---
       wave |  |  |  || |  |  |
                  ----|------

Source: our own; distances within a shape by relaxing neighbours are the textbook's way.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.tracer.sensing.view import View

FAR = 1e9
STEP_MM, STEP_PX = 0.1, 1.5  # how far the wave runs from front to front, at least


@dataclass(frozen=True, slots=True)
class Fronts:
    """Fronts in the order in which the wave comes to them: number (at steps from the start), places (n, 2) mm
    and breadth, mm; and of which they come.
    """

    step_mm: float
    at: NDArray[np.int64]
    places_mm: Array
    breadth_mm: Array
    parents: list[list[int]]
    children: list[list[int]]
    label: NDArray[
        np.int32
    ]  # of each pixel of the window, -1 on paper and where the wave did not come
    corner: tuple[int, int]  # row and column of the window's first pixel on the sheet

    def beyond_mm(self) -> Array:
        """How far the wave runs on from each front, mm."""
        steps = np.zeros(len(self.at), int)
        for k in range(len(self.at) - 1, -1, -1):
            steps[k] = max((steps[b] + 1 for b in self.children[k]), default=0)
        return steps * self.step_mm


def fronts_from(view: View, place: Array, heading: float, reach_mm: float) -> Fronts:
    """The fronts of a wave that starts across the line at a place and runs ahead as far as `reach_mm`; the
    ink behind is shut off.
    """
    rows, pitch = view.cells.darkness.shape[0], view.pitch_mm
    half = math.ceil(reach_mm / pitch) + 4
    row, column = round(rows - place[1] / pitch - 0.5), round(place[0] / pitch - 0.5)
    top, left = max(0, row - half), max(0, column - half)
    window = view.cells.darkness[top : row + half + 1, left : column + half + 1]
    local = place[0] / pitch - 0.5 - left, rows - place[1] / pitch - 0.5 - top
    distance = _wave(
        window, view.level, local, heading, view.width_mm / pitch, reach_mm / pitch
    )
    step_px = max(STEP_MM / pitch, STEP_PX)
    label, table, links = _split(distance, step_px)
    order = np.argsort(table[:, 0], kind="stable")
    number = np.argsort(order).astype(np.int32)
    parents: list[list[int]] = [[] for _ in order]
    children: list[list[int]] = [[] for _ in order]
    for a, b in number[links]:
        parents[b].append(int(a))
        children[a].append(int(b))
    table = table[order]
    places = np.column_stack(
        [(table[:, 3] + left + 0.5) * pitch, (rows - table[:, 2] - top - 0.5) * pitch]
    )
    if len(number):
        label = np.where(label >= 0, number[label], np.int32(-1))
    at, breadth = table[:, 0].astype(np.int64), table[:, 1] * pitch / step_px
    return Fronts(step_px * pitch, at, places, breadth, parents, children, label, (top, left))


@njit(cache=True)
def _wave(darkness, level, start, heading, width_px, reach_px):  # type: ignore[no-untyped-def]
    """How far each pixel of ink is from the start, within the ink, pixels; FAR on paper, behind the start and
    out of reach.
    """
    rows, columns = darkness.shape
    out = np.full((rows, columns), FAR)
    queue = np.empty((rows * columns, 2), np.int32)
    waiting = np.zeros((rows, columns), np.bool_)
    open_to = np.zeros((rows, columns), np.bool_)
    c, s = math.cos(heading), -math.sin(heading)  # rows run down
    count = 0
    for i in range(rows):
        for j in range(columns):
            along = (j - start[0]) * c + (i - start[1]) * s
            aside = abs((i - start[1]) * c - (j - start[0]) * s)
            behind = aside < 0.9 * width_px and -2.0 * width_px - 2.0 < along < 0
            open_to[i, j] = darkness[i, j] > level and not behind
            if open_to[i, j] and 0 <= along < 1.5 and aside < 0.4 * width_px:
                out[i, j] = 0.0
                queue[count, 0], queue[count, 1] = i, j
                waiting[i, j] = True
                count += 1
    first = 0
    while count > 0:
        i, j = queue[first, 0], queue[first, 1]
        first, count = (first + 1) % len(queue), count - 1
        waiting[i, j] = False
        for di in range(-2, 3):
            for dj in range(-2, 3):
                y, x = i + di, j + dj
                knight = abs(di * dj) == 2
                if (
                    not (knight or max(abs(di), abs(dj)) == 1)
                    or y < 0
                    or x < 0
                    or y >= rows
                    or x >= columns
                ):
                    continue
                if not open_to[y, x] or (
                    knight and not open_to[i + int(di / 2), j + int(dj / 2)]
                ):
                    continue
                there = out[i, j] + math.sqrt(di * di + dj * dj)
                if there < out[y, x] - 1e-6 and there < reach_px:
                    out[y, x] = there
                    if not waiting[y, x]:
                        last = (first + count) % len(queue)
                        queue[last, 0], queue[last, 1] = y, x
                        waiting[y, x] = True
                        count += 1
    return out


@njit(cache=True)
def _split(distance, step_px):  # type: ignore[no-untyped-def]
    """The fronts as connected pixels within one step: label of each pixel, (step, pixels, row, column) of
    each front, pairs of fronts that follow.
    """
    rows, columns = distance.shape
    label = np.full((rows, columns), -1, np.int32)
    stack = np.empty((rows * columns, 2), np.int32)
    table = np.empty((rows * columns, 4))
    links = np.empty((8 * rows * columns, 2), np.int32)
    count = 0
    for i0 in range(rows):
        for j0 in range(columns):
            if label[i0, j0] >= 0 or distance[i0, j0] >= FAR:
                continue
            step = int(distance[i0, j0] / step_px)
            label[i0, j0] = count
            stack[0, 0], stack[0, 1] = i0, j0
            waiting, pixels, at_row, at_column = 1, 0, 0.0, 0.0
            while waiting > 0:
                waiting -= 1
                i, j = stack[waiting, 0], stack[waiting, 1]
                pixels, at_row, at_column = pixels + 1, at_row + i, at_column + j
                for y in range(max(0, i - 1), min(rows, i + 2)):
                    for x in range(max(0, j - 1), min(columns, j + 2)):
                        if (
                            label[y, x] < 0
                            and distance[y, x] < FAR
                            and int(distance[y, x] / step_px) == step
                        ):
                            label[y, x] = count
                            stack[waiting, 0], stack[waiting, 1] = y, x
                            waiting += 1
            table[count, 0], table[count, 1] = step, pixels
            table[count, 2], table[count, 3] = at_row / pixels, at_column / pixels
            count += 1
    found = 0
    for i in range(rows):
        for j in range(columns):
            if label[i, j] < 0:
                continue
            for y in range(max(0, i - 1), min(rows, i + 2)):
                for x in range(max(0, j - 1), min(columns, j + 2)):
                    a, b = label[i, j], label[y, x]
                    if b < 0 or table[b, 0] != table[a, 0] + 1:
                        continue
                    if not _known(links, max(0, found - 64), found, a, b):
                        links[found, 0], links[found, 1] = a, b
                        found += 1
    return label, table[:count].copy(), links[:found].copy()


@njit(cache=True)
def _known(links, first, last, a, b):  # type: ignore[no-untyped-def]
    """Whether a pair is among the latest ones."""
    found = False
    for k in range(last - 1, first - 1, -1):
        found = found or (links[k, 0] == a and links[k, 1] == b)
    return found
