"""Runs: an offset path as the tool runs it, with its lead line and its guide lines.

Signals: paths (n, 2) mm and a feed in mm/s in; positions (n, 2) mm at the motion rate out, and for positions
of the drawn line the positions that stand for them.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.feed import run_along
from morfax.motion.plane import SAME_MM
from morfax.motion.polyline import begun_at, length_mm, lengths_mm
from morfax.motion.usual import ACCELERATION_MM_S2
from morfax.tracer.cutter.contour import PathPlace
from morfax.tracer.cutter.start_places import Begin
from morfax.tracer.following.line import Leads
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.program.passes import braking


@dataclass(frozen=True, slots=True)
class FeedRate:
    """How fast the paths are run, and the motion rate."""

    mm_s: float
    rate_hz: float

    def run(self, way_mm: Array) -> Array:
        """Positions along a way (n, 2) mm from rest to rest."""
        if length_mm(way_mm) < SAME_MM:
            return way_mm[-1:]
        return run_along(way_mm, self.mm_s, ACCELERATION_MM_S2, self.rate_hz)

    def resting(
        self, rows_mm: Array, at: Sequence[float]
    ) -> tuple[Array, Callable[[float], float]]:
        """Positions (n, 2) mm that come to rest at some of them, fractions included, and end at the last of
        those; and which position each of them has become.
        """
        pieces = braking.pieces(rows_mm, at, ACCELERATION_MM_S2, self.rate_hz)[: len(at)]
        rested = np.vstack([pieces[0], *(piece[1:] for piece in pieces[1:])])
        rests = [len(pieces[0]) - 1, *(len(piece) - 1 for piece in pieces[1:])]
        index = np.arange(len(rows_mm))
        was = lengths_mm(rows_mm)
        now = lengths_mm(rested)
        was_at = np.r_[0.0, np.interp(at, index, was)]
        now_at = np.r_[0.0, now[np.cumsum(rests)]]

        def moved(old: float) -> float:
            mm = np.interp(np.interp(old, index, was), was_at, now_at)
            return position_at(rested, float(mm))

        return rested, moved


@dataclass(frozen=True, slots=True)
class LeadRun:
    """The lead line to a path: positions (n, 2) mm, the last at rest on the path, and where that is; those
    for the drawn marks, and guide lines.
    """

    xy_mm: Array
    place: PathPlace
    at: dict[float, float]
    guides: list[GuideLine]


@dataclass(frozen=True, slots=True)
class Detour:
    """A guide line off a path: the path's position where it leaves, positions (n, 2) mm, the drawn tip, and
    which stand for the drawn ones.
    """

    leave: int
    xy_mm: Array
    tip: float
    at: dict[float, float]


@dataclass(slots=True)
class PathRun:
    """A path as it is run from one of its places on: positions (n, 2) mm, and for positions of the drawn line
    those that stand for them. From `first` to `last` it is on the path, before and after that on its leads.
    """

    xy_mm: Array
    path_mm: Array
    begin: Begin
    first: int
    last: int
    at: dict[float, float] = field(default_factory=dict)
    guides: list[GuideLine] = field(default_factory=list)

    @classmethod
    def along(cls, path_mm: Array, begin: Begin, feed: FeedRate) -> PathRun:
        """Run a path with its leads; a closed one from and to a place between its points."""
        # 1. the path from its beginning on, between its leads
        ways = [begun_at(path_mm, begin.at) if begin.at > 0 else path_mm]
        if begin.lead_in is not None:
            ways.insert(0, begin.lead_in[:-1])
        if begin.lead_out is not None:
            ways.append(begin.lead_out[1:])
        way = np.vstack(ways)
        # 2. run as one, and where it comes onto the path and leaves it
        xy_mm = feed.run(way)
        share = length_mm(xy_mm) / max(length_mm(way), SAME_MM)
        first, last = 0, len(xy_mm) - 1
        if begin.lead_in is not None:
            first = round(position_at(xy_mm, share * length_mm(begin.lead_in)))
        if begin.lead_out is not None:
            until_mm = length_mm(way) - length_mm(begin.lead_out)
            last = round(position_at(xy_mm, share * until_mm))
        return cls(xy_mm, path_mm, begin, first, last)

    @property
    def leads(self) -> Leads | None:
        """The leads of the line that is run so; None without."""
        if self.begin.lead_in is None and self.begin.lead_out is None:
            return None
        return Leads(self.first, self.last, self.begin.in_mm, self.begin.out_mm)

    def position(self, place: PathPlace) -> float:
        """Which position is at a place of the path, fractions included, before any guide line is put in."""
        along = lengths_mm(self.path_mm)
        at_mm, begin_mm = np.interp(
            [place.at, self.begin.at], np.arange(len(along)), along
        ).tolist()
        mm = at_mm - begin_mm if at_mm >= begin_mm else at_mm - begin_mm + along[-1]
        on_path = self.xy_mm[self.first : self.last + 1]
        return self.first + position_at(on_path, mm / along[-1] * length_mm(on_path))

    def put_in(self, detours: list[Detour]) -> None:
        """Leave the path for guide lines, and come back to it."""
        for detour in sorted(detours, key=lambda detour: -detour.leave):
            leave, shift = detour.leave, len(detour.xy_mm) + 1
            self.at = {drawn: at + shift * (at > leave) for drawn, at in self.at.items()}
            self.guides = [shifted(guide, shift) for guide in self.guides]
            before = self.xy_mm[: leave + 1]
            after = self.xy_mm[leave:]
            self.xy_mm = np.vstack([before, detour.xy_mm, after])
            self.last += shift
            self.at |= {drawn: at + leave + 1 for drawn, at in detour.at.items()}
            tip = round(self.at[detour.tip])
            self.guides.insert(0, GuideLine(leave, tip, leave + shift))

    def put_after(self, lead: LeadRun) -> None:
        """Come to the path by a lead line."""
        shift = len(lead.xy_mm)
        self.at = {**lead.at, **{drawn: at + shift for drawn, at in self.at.items()}}
        self.guides = [shifted(guide, shift) for guide in self.guides]
        self.first, self.last = self.first + shift, self.last + shift
        self.xy_mm = np.vstack([lead.xy_mm, self.xy_mm])


def shifted(guide: GuideLine, positions: int) -> GuideLine:
    """A guide line so many positions later."""
    return GuideLine(guide.leave + positions, guide.tip + positions, guide.back + positions)


def position_at(xy_mm: Array, mm: float) -> float:
    """Which position of a run has come this far, fractions included."""
    lengths = lengths_mm(xy_mm)
    moving = np.flatnonzero(np.r_[True, np.diff(lengths) > 0])
    return float(np.interp(mm, lengths[moving], moving))
