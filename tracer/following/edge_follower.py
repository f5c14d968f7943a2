"""The edge follower: the head follows the edge of a filled shape, until it comes round or is lost.

Signals: a stance on an edge in; out what the head did (see `followed`).

Steering, feed, trail and the way home are the line follower's. An edge has no junctions: where the guard
cells see shape or paper on the wrong side, or the edge bends more than the cell follows, the head feels round
the edge ahead (see `edge_ahead`) and runs through corners from memory, along tight bends by stations.

Source: our own; the patent's follower has lines only. Optical tracers of flame cutters follow edges so.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.following import lost
from morfax.tracer.following.followed import Followed
from morfax.tracer.following.follower import Follower
from morfax.tracer.junctions.edge_ahead import EdgeAhead

# Chosen by trial on filled shapes.
BACK_LEGS = 1.0  # legs behind the axis from which on the edge is felt
# legs beyond the guard cells: further, while the edge is tight there
AHEAD_LEGS = 1.5, 4.0, 10.0
CLEAR_LEADS = 1.3  # of a plain edge, before the cell leads again
FEWEST_STATIONS = 20


class EdgeFollower(Follower):
    """A head on the edge of a filled shape."""

    _was_plain = True  # the edge was felt plain where the cell took over last

    def _through_junction(self) -> Followed | None:
        """Take the head past the tight places ahead; returns what it did, if the edge is lost."""
        self.carriage.says("at a corner")
        tuning, stands = self.carriage.tuning, self.carriage.stands()
        clear_mm = CLEAR_LEADS * tuning.lead_mm
        # 1. the tight places ahead, felt until the edge is plain for the cell
        for legs in AHEAD_LEGS:
            ahead = self._felt(tuning.guard_lead_mm + legs * self.view.leg_mm)
            if ahead is None:
                return self._lost("no edge leads on", lost.CHECK_CELL)
            plan = ahead.plan(stands, clear_mm, tuning.narrowest_per_mm)
            if plan is None:
                return self._on_plain(ahead)
            self._was_plain = len(plan.leg.seen) * self.view.step_mm > clear_mm
            if self._was_plain:
                break
        # 2. through them
        return self._pass(plan) if plan is not None else None

    def _on_plain(self, ahead: EdgeAhead) -> Followed | None:
        """Go on along a plain edge, on which either the guard cells were wrong or the swinging cell is."""
        if self._agreement.goes_on_along(self.carriage, self.view, ahead.felt):
            return None
        if self._agreement.contradict and self._was_plain:
            return self._lost(lost.CONTRADICT, lost.CHECK_CELL)
        plan = ahead.plain(self.carriage.stands(), self.view.leg_mm)
        if plan is None:
            return self._lost("no edge leads on", lost.CHECK_CELL)
        self._was_plain = True
        return self._pass(plan)

    def _felt(self, ahead_mm: float) -> EdgeAhead | None:
        """The edge from behind the axis to so far ahead of it; None if it ends before."""
        back_mm = min(BACK_LEGS * self.view.leg_mm, self.carriage.travel_mm)
        place, heading = (
            self.carriage.trail.back(back_mm) if back_mm else self.carriage.stands()
        )
        felt: Array = self.view.feel_edge(place, heading, back_mm + ahead_mm)
        if len(felt) < FEWEST_STATIONS:
            return None
        # the edge may come near the axis again further on
        near = felt[: int(2 * back_mm / self.view.step_mm) + FEWEST_STATIONS, :2]
        here = int(np.argmin(np.hypot(*(near - self.carriage.stands()[0]).T)))
        return EdgeAhead(self.view, felt, here)
