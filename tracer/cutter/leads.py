"""Leads: how the tool comes to a cut through the scrap and leaves it again.

Signals: a place of a path with its heading, and the lines about it, in; leads (n, 2) mm out.

        scrap   ◜ down                     ◝ up        a quarter circle of the radius asked for, which
               │                            │          touches the path; or a straight line of the
               ╰────▶ path        path ────▶╯          length asked for, at 45 degrees to the path
        part

A lead lies in the scrap if no place of it is nearer to any line than the cutter's radius, and the place where
the tool goes down or up is further still, by half of the lead's depth. Without a cutter it may not cross its
own line, nor come within `KEPT_MM` of another. Where a lead has no room it is tried in smaller sizes.

Source: our own; arc and line are what CAM programs offer.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.crossings import crossings
from morfax.motion.offset import DriveCurve
from morfax.motion.polyline import APART_MM, Nearest, with_places
from morfax.tracer.cutter import sides
from morfax.tracer.cutter.contouring import Lead
from morfax.tracer.effort import EVERY_MM

# a lead without a cutter stays so far from other lines: our own choice, for thin cuts; a kerf can be given
# a place is clear if it is no nearer to a contour or line than the radius less this
CLEAR_MM = 0.001
KEPT_MM = 0.25
AWAY = 0.5  # of a lead's depth: the tool goes down so far from every cut; by trial
TOUCHES_MM = 0.02  # so deep in the scrap a lead has left the line that it touches
# of the size asked for, tried one after the other, down to 9 %; by trial
SIZES = tuple(0.85**k for k in range(16))
LEAST_MM = 0.1  # a smaller lead is none
ACROSS = math.radians(45)  # at which a straight lead meets the path


def shaped(place_mm: Array, along: Array, across: Array, lead: Lead, size_mm: float) -> Array:
    """A lead of a size from its place on the path outwards, (n, 2) mm.

    It begins in the direction `along` the path and turns `across`, into the scrap; both are unit vectors.
    """
    if lead.kind == "line":
        end = math.cos(ACROSS) * along + math.sin(ACROSS) * across
        return with_places(np.array([place_mm, place_mm + size_mm * end]), APART_MM)
    count = max(8, math.ceil(size_mm * math.pi / 2 / APART_MM))
    angle = np.linspace(0.0, math.pi / 2, count + 1)[:, None]
    return np.asarray(
        place_mm + size_mm * (np.sin(angle) * along + (1 - np.cos(angle)) * across)
    )


def depth_mm(lead: Lead, size_mm: float) -> float:
    """How deep in the scrap a lead begins, from the path, mm."""
    return size_mm if lead.kind == "arc" else size_mm * math.sin(ACROSS)


class Scrap:
    """The lines about a lead: tells whether it stays clear of them."""

    def __init__(
        self, curves: Sequence[DriveCurve], radius_mm: float = 0.0, near: Nearest | None = None
    ) -> None:
        """With a cutter of a radius, `near` finds how far places are from all the lines."""
        from scipy.spatial import cKDTree

        self._radius_mm, self._near = radius_mm, near
        if near is not None:
            return
        lines = [sides.whole(curve) for curve in curves]
        places = [with_places(line, EVERY_MM) for line in lines]
        self._tree = cKDTree(np.vstack(places))
        self._owner = np.repeat(np.arange(len(places)), [len(some) for some in places])

    def holds(
        self, lead_mm: Array, path_mm: Array, own: int, deep_mm: float, inside: bool
    ) -> bool:
        """Whether a lead, from its path outwards, is clear of all lines, on the inside of its path or not.

        `own` is the number of its own line.
        """
        if self._near is not None:
            away_mm = self._near.distances_mm(lead_mm)
            free = bool(away_mm.min() >= self._radius_mm - CLEAR_MM)
            return free and bool(away_mm[-1] >= self._radius_mm + AWAY * deep_mm)
        if self._tree.query(lead_mm[-1])[0] < AWAY * deep_mm:
            return False
        end = float(lead_mm[-1, 0]), float(lead_mm[-1, 1])
        if (cv2.pointPolygonTest(path_mm.astype(np.float32), end, False) > 0) != inside:
            return False
        near = self._tree.query_ball_point(lead_mm, KEPT_MM)
        if any((self._owner[found] != own).any() for found in near if found):
            return False
        return not len(crossings(_off_its_line(lead_mm, deep_mm), path_mm))


def _off_its_line(lead_mm: Array, deep_mm: float) -> Array:
    """A lead from where it has left the line that it touches."""
    come = np.hypot(*(lead_mm - lead_mm[0]).T)
    # depth of an arc after a chord c is c² / 2r; a straight lead is deeper
    least_mm = math.sqrt(2 * TOUCHES_MM * deep_mm)
    return lead_mm[int(np.searchsorted(come, min(least_mm, 0.5 * come[-1]))) :]
