"""Crossings: the legs of lines that meet, which of them are one line, and the ways that go through.

Signals: legs as they come in, how the head sees each of their lines, and what was felt of the ink between
them in; pairs of legs that are one line out, and places (n, 2) mm of the ways from one leg to its partner.

The net of a sheet is made a few times, until no ink is left over; a crossing whose legs are still the same is
solved once, and known again by its `key`.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.curves import hermite
from morfax.motion.median import median
from morfax.motion.neighbours import Neighbours
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.trail import Trail
from morfax.tracer.ink.net import COVERED, Inner
from morfax.tracer.ink.partners import Pair, partners, way_through
from morfax.tracer.ink.shared_ink import SharedInk
from morfax.tracer.junctions.planner import Planner
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.view import View

COVERED_SHARE = (
    0.7  # of a stretch within a crossing, along which ways go; by trial on drawings of nets
)


@dataclass
class Crossing:
    """Legs that meet, each with the view of its line, and the stretches of ink between them."""

    legs: list[Leg]
    views: list[View]
    settings: Settings
    inked: list[Inner] = field(default_factory=list)
    _covers: dict[int, bool] = field(default_factory=dict)

    @property
    def key(self) -> Hashable:
        """What decides how lines go on here."""
        legs = [
            (
                *leg.end_mm.tolist(),
                leg.heading_rad,
                leg.bend_per_mm,
                leg.width_mm,
                view.width_mm,
            )
            for leg, view in zip(self.legs, self.views, strict=True)
        ]
        return tuple(legs), tuple(inner.stretch for inner in self.inked)

    @cached_property
    def pairs(self) -> list[Pair]:
        """The legs, by their numbers here, that are one line."""
        if len(self.legs) == 2:
            return [(0, 1)]
        return partners(self.legs, median([leg.width_mm for leg in self.legs]))

    @cached_property
    def ink(self) -> SharedInk | None:
        """Its own ink and the ways through it; None if nothing was felt within it."""
        if not self.inked:
            return None
        ways = [
            hermite(one.end_mm, one.heading_rad, onto.end_mm, onto.heading_rad)
            for one, onto in (
                (self.legs[a], self.legs[b].turned_round()) for a, b in self.pairs
            )
        ]
        return SharedInk([inner.run for inner in self.inked], ways)

    @cached_property
    def passing(self) -> Neighbours:
        """Places of the lines that pass, from clean end to clean end."""
        return Neighbours(self.passing_mm)

    @cached_property
    def passing_mm(self) -> Array:
        """These places, (n, 2) mm."""
        return np.vstack([self._way(pair) for pair in self.pairs])

    def covers(self, inner: Inner) -> bool:
        """Whether ways through it go along a stretch within it."""
        if inner.stretch not in self._covers:
            away_mm, _ = self.passing.nearest(inner.run.places_mm)
            share = float(np.mean(away_mm < COVERED * self.legs[0].width_mm))
            self._covers[inner.stretch] = share > COVERED_SHARE
        return self._covers[inner.stretch]

    def _way(self, pair: Pair) -> Array:
        """The way of a pair through it, (n, 2) mm."""
        one, other = self.legs[pair[0]], self.legs[pair[1]].turned_round()
        view = self.views[pair[0]]
        stands = one.end_mm, one.heading_rad
        planner = Planner(view, stands, Trail(one.end_mm, view.step_mm), self.settings)
        return np.vstack(way_through(planner, (one, other), None, self.ink))
