"""Start places: where on a closed path the cut begins, with leads that have room there.

Signals: the paths beside a contour and what is asked for in; the place of a path and its leads, mm, out.

    straight    the middle of the longest straight stretch, then of the shorter ones
    corner      the sharpest corner that the tool goes round, then the others, then the straight stretches
    nearest     the place nearest to where the tool comes from, then places all round

The first place with room for the leads as they are asked for is taken; else the one with room for the
longest. A path that a lead line on the drawing leads to begins there, and has no lead-in.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from morfax.motion import segments
from morfax.motion.arrays import Array
from morfax.motion.plane import cross, left_of, unit
from morfax.motion.polyline import (
    APART_MM,
    at_places,
    begun_at,
    evenly,
    lengths_mm,
    plain,
    with_places,
)
from morfax.tracer.cutter.contour import Beside, heading, nearest_place
from morfax.tracer.cutter.contouring import AS_FOLLOWED, Contouring, Lead
from morfax.tracer.cutter.leads import LEAST_MM, SIZES, Scrap, depth_mm, shaped
from morfax.tracer.cutter.sides import is_counterclockwise
from morfax.tracer.effort import EVERY_MM

# All limits below were chosen by trial on the test drawings.
STRAIGHT_MM = 0.03  # a stretch is straight within this
TRIED = 24  # places of a path that are looked at
BESIDE_MM = 0.2  # of a corner: shows the heading before and after it
# a corner turns by more than half a radian within a millimetre
CORNERS = segments.Limits(1.0, 1.0, window_mm=1.0, corner_rad=0.5)


@dataclass(frozen=True, slots=True)
class Begin:
    """Where a path begins, and its leads in the direction of travel, (n, 2) mm, with their sizes, mm."""

    at: float = 0.0
    lead_in: Array | None = None
    lead_out: Array | None = None
    in_mm: float = 0.0
    out_mm: float = 0.0


@dataclass(slots=True)
class StartPlaces:
    """Chooses where paths begin, one after the other; knows where the tool comes from."""

    contouring: Contouring = AS_FOLLOWED
    scrap: Scrap | None = None
    tool_mm: Array | None = None

    def begin(self, beside: Beside, number: int, joins_at: float | None = None) -> Begin:
        """Where a path begins: at the place where a lead line joins it, or where there is room for leads."""
        path = beside.paths[number]
        begin = Begin(joins_at or 0.0)
        if path.closed and beside.cut.closed and self.contouring.moves_start:
            begin = self._chosen(_Path(beside, number), joins_at)
        self.tool_mm = at_places(path.points_mm, np.array([begin.at]))[0]
        return begin

    def _chosen(self, path: _Path, joins_at: float | None) -> Begin:
        """The first place with room for whole leads, else the one with room for the longest."""
        places = path.places(self.contouring.start_at, self.tool_mm)
        if joins_at is not None:
            places = iter([joins_at])
        elif path.told_mm is not None:
            places = path.from_told()
        lead_in = self.contouring.lead_in if joins_at is None else None
        asked = [lead for lead in (lead_in, self.contouring.lead_out) if lead is not None]
        best: tuple[float, Begin] | None = None
        for at in islice(places, TRIED):
            begin = self._led(path, at, lead_in)
            whole = sum(lead.size_mm for lead in asked)
            share = (begin.in_mm + begin.out_mm) / whole if asked else 1.0
            if best is None or share > best[0]:
                best = share, begin
            if share >= 1.0:
                break
        return best[1] if best is not None else Begin(joins_at or 0.0)

    def _led(self, path: _Path, at: float, lead_in: Lead | None) -> Begin:
        """A place of a path with the longest leads that have room there."""
        place, arrives, leaves = path.about(at)
        before, in_mm = self._fitted(path, place, leaves, lead_in, leaving=False)
        after, out_mm = self._fitted(
            path, place, arrives, self.contouring.lead_out, leaving=True
        )
        return Begin(at, None if before is None else before[::-1], after, in_mm, out_mm)

    def _fitted(
        self, path: _Path, place: Array, way: Array, lead: Lead | None, *, leaving: bool
    ) -> tuple[Array | None, float]:
        """The longest lead that has room at a place, from the path outwards, and its size; None without."""
        if lead is None or self.scrap is None:
            return None, 0.0
        along = way if leaving else -way
        across = left_of(way) * (1 if path.scrap_left else -1)
        for share in SIZES:
            size_mm = share * lead.size_mm
            if size_mm < LEAST_MM:
                break
            made = shaped(place, along, across, lead, size_mm)
            deep_mm = depth_mm(lead, size_mm)
            if self.scrap.holds(made, path.points_mm, path.own, deep_mm, path.scrap_inside):
                return made, size_mm
        return None, 0.0


class _Path:
    """A closed path on which places are looked for."""

    def __init__(self, beside: Beside, number: int) -> None:
        self.points_mm = beside.paths[number].points_mm
        self.own = beside.paths[number].guide
        self.scrap_left = beside.left != beside.turned
        self.scrap_inside = self.scrap_left == is_counterclockwise(self.points_mm)
        self._beside = beside
        line = beside.cut.line
        self.told_mm = (
            np.array(line.start_mm) if line.as_told else None
        )  # by the operator's arrow
        self._lengths = lengths_mm(self.points_mm)
        self._every = evenly(self.points_mm, APART_MM)

    def about(self, at: float) -> tuple[Array, Array, Array]:
        """A place of the path, (2,) mm, and the headings before and after it, (2,)."""
        place = at_places(self.points_mm, np.array([at]))[0]
        mm = float(np.interp(at, np.arange(len(self._lengths)), self._lengths))
        way = heading(self._every, round(mm / APART_MM), True)
        if way is not None:
            return place, way, way
        before = self._at_mm(mm - BESIDE_MM)
        after = self._at_mm(mm + BESIDE_MM)
        return place, unit(place - before), unit(after - place)

    def places(self, start_at: str | None, tool_mm: Array | None) -> Iterator[float]:
        """Places to begin at, the best first."""
        if start_at == "nearest":
            yield from self._nearest(self.points_mm[0] if tool_mm is None else tool_mm)
            return
        straights = self._straights()
        if start_at == "corner":
            yield from self._corners(straights[0])
        yield from straights[: TRIED // 2]
        yield from self._all_round(straights[0])

    def from_told(self) -> Iterator[float]:
        """The place nearest to where the operator's arrow begins."""
        assert self.told_mm is not None
        yield nearest_place(self.points_mm, self.told_mm, 0)[1].at

    def _straights(self) -> list[float]:
        """Middles of the straight stretches, the longest first."""
        # 1. begun at a place far out, where no straight stretch is parted
        far = int(np.argmax(np.hypot(*(self.points_mm - self.points_mm.mean(axis=0)).T)))
        nodes = plain(begun_at(self.points_mm, far), STRAIGHT_MM)
        # 2. their middles
        long_mm = np.hypot(*np.diff(nodes, axis=0).T)
        begins_mm = lengths_mm(nodes)[:-1]
        longest = np.argsort(-long_mm, kind="stable")
        middles = begins_mm[longest] + 0.5 * long_mm[longest]
        share = self._lengths[-1] / lengths_mm(nodes)[-1]
        return [self._place(self._lengths[far] + share * mm) for mm in middles]

    def _corners(self, smooth: float) -> Iterator[float]:
        """Places at the corners of the contour: first those that the tool goes round, the sharpest first."""
        cut = self._beside.cut
        line = with_places(plain(cut.places_mm, 0.1 * STRAIGHT_MM), EVERY_MM)
        middle = at_places(self.points_mm, np.array([smooth]))[0]
        k = int(np.argmin(np.hypot(*(line - middle).T)))
        line = begun_at(line, k)
        reach = round(1.0 / EVERY_MM)
        found = list[tuple[bool, float, float]]()
        for corner in segments.corners(line, CORNERS):
            arrives = unit(line[corner] - line[max(0, corner - reach)])
            leaves = unit(line[min(corner + reach, len(line) - 1)] - line[corner])
            turned = float(np.arctan2(cross(arrives, leaves), arrives @ leaves))
            across = unit(left_of(arrives + leaves))
            out = across if self._beside.left else -across
            foot = line[corner] + self._beside.radius_mm * out
            goes_round = (turned > 0) != self._beside.left
            place = nearest_place(self.points_mm, foot, 0)[1].at
            found.append((not goes_round, -abs(turned), place))
        yield from (place for _, _, place in sorted(found))

    def _nearest(self, tool_mm: Array) -> Iterator[float]:
        """The place nearest to where the tool comes from, then places all round, the nearer first."""
        yield nearest_place(self.points_mm, tool_mm, 0)[1].at
        round_about = np.array(list(self._all_round(0.0)))
        away = np.hypot(*(at_places(self.points_mm, round_about) - tool_mm).T)
        yield from round_about[np.argsort(away)].tolist()

    def _all_round(self, first: float) -> Iterator[float]:
        """Places all round, evenly, from one on."""
        first_mm = float(np.interp(first, np.arange(len(self._lengths)), self._lengths))
        for k in range(TRIED // 2):
            yield self._place(first_mm + k / (TRIED // 2) * self._lengths[-1])

    def _place(self, mm: float) -> float:
        """The place so far along the path."""
        moving = np.flatnonzero(np.r_[True, np.diff(self._lengths) > 0])
        return float(np.interp(mm % self._lengths[-1], self._lengths[moving], moving))

    def _at_mm(self, mm: float) -> Array:
        """Where the path is so far along, (2,) mm."""
        return at_places(self.points_mm, np.array([self._place(mm)]))[0]
