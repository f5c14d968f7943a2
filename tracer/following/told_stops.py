"""Told stops: where the operator's corrections say that the head stops on a line, and where it does not.

Signals: the marks that were found along a way (n, 2) mm, and the corrections, in; the marks as the operator
wants them, and the numbers of the corrections that were served, out.

A stop that is told stands on the way where that comes nearest to its place. If a mark was found there it is
that mark's own place.

Source: patent ES 361967, figure 1, stop marks; that a person may strike one out, or add one, is our own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.corrections.on_sheet import REACH_MM, REACH_WIDTHS, StopAt
from morfax.tracer.marks.marks import Mark


def with_told(
    marks: Sequence[Mark], way_mm: Array, width_mm: float, stops: Sequence[StopAt]
) -> tuple[tuple[Mark, ...], frozenset[int]]:
    """The marks of a line of a width, with and without those that are told."""
    reach_mm, served = max(REACH_MM, REACH_WIDTHS * width_mm), set[int]()
    for stop in stops:
        near = [m for m in marks if math.dist(m.place_mm, stop.place_mm) < reach_mm]
        marks = [mark for mark in marks if mark not in near]
        if stop.do != "not-stop":
            near = _told(stop, near, way_mm, reach_mm)
            marks = [*marks, *near]
        if near:
            served.add(stop.number)
    return tuple(sorted(marks, key=lambda mark: mark.at)), frozenset(served)


def _told(stop: StopAt, near: list[Mark], way_mm: Array, reach_mm: float) -> list[Mark]:
    """The stop as a mark: one that was found near, or a new one where the way comes nearest; or none."""
    kind: Literal["tick", "dot"] = "dot" if stop.do == "drill" else "tick"
    if near:
        mark = min(near, key=lambda each: math.dist(each.place_mm, stop.place_mm))
        return [replace(mark, kind=kind, correction=stop.number)]
    away_mm = np.hypot(*(way_mm - stop.place_mm).T)
    at = int(np.argmin(away_mm))
    if away_mm[at] > reach_mm:
        return []
    x, y = way_mm[at]
    return [Mark(kind, (float(x), float(y)), float(at), stop.number)]
