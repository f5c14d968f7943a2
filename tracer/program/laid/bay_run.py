"""The run along narrow bays: a closed line with the head run from memory along rules in place of stretches.

The head comes to a bay and goes on from it as fast as it came and went before; where a bay lies on the place
at which the line begins, the line is begun after it.

Signals: a line and bays along it in; the line with its positions and who led the head out.

Source: our own, as through tangles.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import length_mm, lengths_mm
from morfax.motion.usual import THINNED
from morfax.tracer.effort import EVERY_MM
from morfax.tracer.following.line import Line
from morfax.tracer.head import screws
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.leaders import REDRAWN, Led
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import set_fields
from morfax.tracer.limits import ABOUT_WIDTHS
from morfax.tracer.program.against_ink.window import view_about
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.setup import Setup
from morfax.tracer.tangles.folding_rule import Rule


class Bay(NamedTuple):
    """A rule that replaces a stretch of a way, between two places along it, mm; and what it gains."""

    first_mm: float
    last_mm: float
    rule: Rule | LaidWay
    gain: float

    def moved(self, by_mm: float, round_mm: float) -> Bay:
        """The bay moved along a closed way of a length."""
        first_mm = (self.first_mm + by_mm) % round_mm
        return self._replace(first_mm=first_mm, last_mm=first_mm + self.last_mm - self.first_mm)


def laid(setup: Setup, line: Line, bays: Sequence[Bay], round_mm: float) -> Line:
    """A line, so long by its thinned places, with the head run along the rules of some bays, none of which
    reaches an end of an open one.
    """
    # 1. begun where no bay is
    at_end = [b for b in bays if b.first_mm < EVERY_MM or b.last_mm > round_mm - EVERY_MM]
    if at_end:
        end_mm = at_end[0].last_mm
        free_mm = min((bay.first_mm - end_mm) % round_mm for bay in bays)
        begin_mm = (end_mm + min(2 * EVERY_MM, 0.5 * free_mm)) % round_mm
        line = _begun_at(line, begin_mm)
        bays = [bay.moved(-begin_mm, round_mm) for bay in bays]
    # 2. the way from bay to bay, and the runs along their rules
    at, come_mm = 0, lengths_mm(line.places_mm)
    ways, leaders = list[Array](), list[NDArray[np.int8]]()
    for bay in sorted(bays, key=lambda bay: bay.first_mm):
        splice = _run(setup, line, bay, come_mm)
        ways += [line.xy_mm[at : splice.first + 1], splice.way_mm]
        leaders.append(line.led.of(splice.first + 1 - at, at))
        leaders.append(np.full(len(splice.way_mm), REDRAWN, np.int8))
        at = splice.last
    xy_mm = np.vstack([*ways, line.xy_mm[at:]])
    led = Led.along(np.concatenate([*leaders, line.led.of(len(line.xy_mm) - at, at)]))
    return replace(line, xy_mm=xy_mm, led=led, length_mm=length_mm(xy_mm))


def _begun_at(line: Line, begin_mm: float) -> Line:
    """A closed line begun at a place along it."""
    count, at = len(line.xy_mm), _position(line, lengths_mm(line.places_mm), begin_mm)
    led = Led.along(np.roll(line.led.of(count), -at))
    return replace(line, xy_mm=np.roll(line.xy_mm, -at, axis=0), led=led)


def _position(line: Line, come_mm: Array, at_mm: float) -> int:
    """The position of a line at a length along its thinned places, (n,) mm from its start; not its first."""
    at = round(THINNED * float(np.interp(at_mm, come_mm, np.arange(len(come_mm)))))
    return min(max(at, 1), len(line.xy_mm) - 1)


class Splice(NamedTuple):
    """The head's run along a rule, (n, 2) mm at the motion rate, after one of a line's positions and before
    another.
    """

    first: int
    last: int
    way_mm: Array


def _run(setup: Setup, line: Line, bay: Bay, come_mm: Array) -> Splice:
    """The head's run along a bay's rule from memory, as fast as it comes and goes on; how far it has come at
    the line's thinned places (n,), mm.
    """
    xy_mm = line.xy_mm
    first, last = (_position(line, come_mm, mm) for mm in (bay.first_mm, bay.last_mm))
    aperture_mm, width_mm = setup.settings.aperture_mm, 2 * bay.rule.half_mm
    about, reach_mm = xy_mm[first : first + 1], ABOUT_WIDTHS * width_mm
    view = view_about(setup.sheet, aperture_mm, width_mm, about, reach_mm)
    ahead = bay.rule.ahead
    stance = Stance(xy_mm[first], math.atan2(ahead[1], ahead[0]), view)
    carriage = Carriage(stance, setup.settings, MOTION_RATE_HZ)
    # 1. the drives lag: the axis is where its demand comes to the bay
    lag = round(screws.owed_s(carriage.tuning.drive_gain, 1.0))
    first = max(first - lag, 1)
    velocity = (xy_mm[first] - xy_mm[first - 1]) * MOTION_RATE_HZ
    set_fields(carriage.state, x_mm=xy_mm[first, 0], y_mm=xy_mm[first, 1])
    set_fields(carriage.state, vx_mm_s=velocity[0], vy_mm_s=velocity[1])
    set_fields(carriage.state, speed_mm_s=float(np.hypot(*velocity)))
    # 2. along the rule, and on where the way is nearest
    end_mm_s = float(np.hypot(*(xy_mm[last] - xy_mm[last - 1]))) * MOTION_RATE_HZ
    carriage.run(bay.rule.stretches(), end_mm_s, REDRAWN)
    way_mm = carriage.positions_mm[1:]
    about_mm = (bay.last_mm + aside * EVERY_MM for aside in (-1, 1))
    after, beyond = (_position(line, come_mm, mm) for mm in about_mm)
    after = max(after, first + 1)
    nearest = np.hypot(*(xy_mm[after : beyond + 1] - way_mm[-1]).T)
    return Splice(first, after + int(np.argmin(nearest)) + 1, way_mm)


def apart(bays: list[Bay], length_mm: float) -> list[Bay]:
    """Those of some bays that gain most, none of which lies on another."""
    kept = list[Bay]()
    for bay in sorted(bays, key=lambda bay: -bay.gain):
        if all(_are_apart(bay, other, length_mm) for other in kept):
            kept.append(bay)
    return kept


def _are_apart(bay: Bay, other: Bay, length_mm: float) -> bool:
    """Whether two bays of a closed way of a length do not lie on one another."""
    rounds = (-length_mm, 0.0, length_mm)
    return all(
        bay.last_mm + more < other.first_mm or other.last_mm < bay.first_mm + more
        for more in rounds
    )
