"""Run ends: what the head does where a line ends, comes home or is lost, and what it tells of its run.

Signals: the leg to an end of the line, mm along it, in; what the head did (see `followed`) out, or None where
it goes on: back from a guide line's end, or from a tip in which two lines end.

Source: patent ES 361967, section on use.
"""

from __future__ import annotations

import math

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.tracer.following import lost
from morfax.tracer.following.faint_corner import TipPose, faint_corner
from morfax.tracer.following.felt_line import Anchor
from morfax.tracer.following.followed import Followed, without_repeat
from morfax.tracer.following.way_home import WayHome
from morfax.tracer.following.ways_out import WaysOut
from morfax.tracer.head import course
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.leaders import STATIONS
from morfax.tracer.head.settings import Settings
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.probe import end_of
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.memory import Tangles


class RunEnds:
    """A head as far as it ends its runs."""

    view: View
    settings: Settings
    carriage: Carriage
    _ways_out: WaysOut
    _tangles: Tangles
    _home: WayHome
    _anchor: Anchor
    _went_slowly: bool
    _at_tip: bool
    _tip: tuple[Leg, float] | None  # at which the run ended: the leg, and mm along it

    @property
    def is_at_tip(self) -> bool:
        """Whether the run has ended at a tip, from which the head may go back."""
        return self._tip is not None

    def _at_end(self, incoming: Leg, choices: int) -> Followed | None:
        """Run to the end of the line, or to where it meets what was followed before."""
        end = end_of(self.view, incoming)
        if end is None and choices:
            end = 0.0  # all that leads on has been followed
        if end is None:
            return self._lost("no clean line leads on through the ink ahead")
        if self._home.is_across(incoming, end, self.settings.recatch_mm):
            # across the paper, to the end at which the head began
            way = [course.to_end(self.carriage.stands(), incoming, end)]
            self.carriage.run(way, self.settings.speed_mm_s, STATIONS)
            return self._go_home()
        onto_home = self._round_faint_corner(incoming, end)
        if onto_home is not None:
            self.carriage.run(onto_home, leader=STATIONS)
            return self._done("closed")
        return self._end(incoming, end, joined=choices > 0)

    def _round_faint_corner(self, incoming: Leg, end_mm: float) -> list[Array] | None:
        """The course by an end of the line and pale ink onto home; None if the line ends here."""
        if not self._home.stance.at_end or self.carriage.travel_mm < self._home.away_mm:
            return None
        tip = TipPose(incoming.at(end_mm), incoming.heading_at(end_mm))
        from_tip = faint_corner(self.view, tip, self._home.tip)
        if from_tip is None:
            return None
        return [course.to_end(self.carriage.stands(), incoming, end_mm), *from_tip]

    def _end(self, incoming: Leg, end_mm: float, *, joined: bool = False) -> Followed | None:
        """Run to an end of the line; and back, if it is a guide line's end, or a tip where two lines end."""
        self.carriage.run(
            [course.to_end(self.carriage.stands(), incoming, end_mm)], leader=STATIONS
        )
        self._at_tip = self._tangles.goes_back(
            self.carriage.stands()[0], self.carriage.trail, self.view.width_mm
        )
        self._tip = (incoming, end_mm) if self._at_tip else None
        to_tip = self._at_tip and self._ways_out.turns.back_from_tips
        if joined and not to_tip:
            return self._done("joined")
        on_guide = self._ways_out.junctions.turn_round(self.carriage.count)
        if not on_guide and not to_tip:
            return self._done("ended")
        self._back_from(incoming, end_mm)
        return None

    def _on_from_tip(self) -> None:
        """Go back from the tip at which an earlier run ended, if this head was taken up there."""
        if self._tip is not None:
            self._ways_out.junctions.turn_round(self.carriage.count)
            self._back_from(*self._tip)

    def _back_from(self, incoming: Leg, end_mm: float) -> None:
        """Go back from an end of the line, along the leg to it."""
        self._tip = None
        self.carriage.swivel(incoming.heading_at(end_mm) + math.pi)
        way_back = [course.along_leg(incoming, end_mm, 0.0)]
        self.carriage.run(way_back, self.settings.speed_mm_s, STATIONS)
        self._aim(incoming.turned_round())

    def _go_home(self) -> Followed:
        """Run onto the place where the head began."""
        self.carriage.run([self._home.way_from(self.carriage)])
        return self._done("closed")

    def _aim(self, leg: Leg, clean_from: Anchor | None = None) -> None:
        """Follow from the clean end of a leg; the line is clean from there, or from further back."""
        self.carriage.aim(self.view, leg)
        self._anchor = clean_from or (leg.end_mm, leg.heading_rad, self.carriage.travel_mm)

    def _done(self, ending: str, fault: LineFault | None = None) -> Followed:
        """What the head did in all."""
        positions, junctions = self.carriage.positions_mm, self._ways_out.junctions
        done = Followed(
            positions,
            ending,
            self.carriage.heading_rad,
            self.carriage.travel_mm,
            self.view,
            tuple(junctions.places_mm),
            fault,
            guides=junctions.guides(positions),
            at_tip=self._at_tip,
            went_slowly=self._went_slowly,
            led=self.carriage.led,
            served=frozenset(self._ways_out.served),
            doubts=self._tangles.doubts(self.carriage.trail, self.view.width_mm),
        )
        return done if ending != "joined" else without_repeat(done)

    def _lost(self, why: str, instead: str = lost.BRIDGE) -> Followed:
        """The end of a line that was lost: the fault says where, and what to do instead."""
        self.carriage.says(f"lost: {why}")
        stands, travel_mm = self.carriage.stands(), self.carriage.travel_mm
        because = f"{why}; look at the drawing there, {instead}"
        return self._done(
            "lost", lost.line_lost(stands, travel_mm, self.view.enlarged, because)
        )
