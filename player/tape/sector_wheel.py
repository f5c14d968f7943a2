"""The pick-up on a lead screw of the machine: sector wheel, lamp and photocell.

Signals in: turns of the wheel, and the screw's place in mm. Signal out, at each step of the drives: the
sector whose edge the cell saw last, and the share of a sector that has passed since.

    reference track ─► motor 116 ─► wheel 115, N sectors      turned = reference / N       (turns)
    screw 111 ─► arm 118 with lamp 119 and cell 141           arm    = place / pitch       (turns)

    cell   dark ┌──┐ dark ┌──┐           edge of sector k:   turned + arm + wobble = (k + late(k)) / N
           ─────┘  └──────┘  └──         wobble            = e / (2 pi r) · sin(2 pi arm)
                ▲         ▲

So the edges come at the reference frequency while the screw stands, and more or fewer of them while it turns;
one more is q = pitch / N of travel. What may be wrong with a wheel: edges that stand off their places (they
come by again and again while the wheel turns, also where the screw stands), an arm that does not turn about
the wheel's own axis (e off it, at radius r: once in a turn of the screw), and a lamp that is weak: below the
threshold of its trigger the cell gives no edges at all.

Source: patent ES 361967, figures 2 and 5 (wheel 115, motor 116, arm 118, lamp 119, cell 141, trigger 157),
claims 6, 16 and 17. Questions: the patent gives no figures. Chosen: a wheel of 30 mm radius, and as many
sectors as make a screw of about 5 mm pitch of the travel in a cycle that the tape states; a threshold of a
tenth of the light. The motor is taken to turn in phase with the reference track; flutter, which the tracks
share, moves wheel and carriers alike and is left out of both.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.axis import LeadScrew
from morfax.motion.compiled import njit

FEWEST_SECTORS = 10  # a step passes some of them, and they are counted modulo a turn
LARGEST_SHARE = 0.1  # of the radius, and of a sector's width: a wheel further off is broken
THRESHOLD = 0.1  # of trigger 157, share of the full light
SEED = 1969  # of the places of the edges; axis by axis further
TWO_PI = 2 * math.pi


class Wheels(NamedTuple):
    """The wheels as the kernel takes them; edges (axes, sectors + 3) in sectors, from edge -1 on."""

    edges: Array
    sectors: int
    turns_per_mm: float
    wobble_turns: float
    is_lit: bool
    is_even: bool  # every edge stands in its place: nobody has to look where


@dataclass(frozen=True, slots=True)
class SectorWheel:
    """What is wrong with the wheels, the same for all axes; lengths at the rim."""

    eccentricity_mm: float = 0.0  # of the arm's axis against the wheel's
    division_mm: float = 0.0  # how far an edge stands off its place at most
    light: float = 1.0  # of the lamp
    radius_mm: float = 30.0

    def __post_init__(self) -> None:
        most_mm = LARGEST_SHARE * self.radius_mm
        if not 0 <= self.eccentricity_mm <= most_mm:
            raise ValueError(
                f"a sector wheel that is {self.eccentricity_mm:g} mm off its axis is broken; "
                f"give 0 to {most_mm:g} mm"
            )
        if not 0 <= self.light <= 1:
            raise ValueError(f"the lamp has {self.light:.0%} of its light; give 0% to 100%")

    @property
    def is_lit(self) -> bool:
        """Whether the lamp is bright enough for trigger 157."""
        return self.light >= THRESHOLD

    def wheels(self, axes: int, mm_per_cycle: float) -> Wheels:
        """The wheels of some axes for a travel in a cycle; raises ValueError for edges too far off."""
        screw = screw_for(mm_per_cycle)
        width_mm = TWO_PI * self.radius_mm / screw.sectors
        if not 0 <= self.division_mm <= LARGEST_SHARE * width_mm:
            raise ValueError(
                f"sectors whose edges stand {self.division_mm:g} mm off their places make no wheel; "
                f"give 0 to {LARGEST_SHARE * width_mm:.3g} mm"
            )
        late = np.zeros((axes, screw.sectors))
        if self.division_mm:  # a true wheel needs no random numbers
            for axis in range(axes):
                late[axis] = np.random.default_rng(SEED + axis).uniform(-1, 1, screw.sectors)
        late -= late.mean(axis=1, keepdims=True)  # zero is set on the wheel as it is
        late *= self.division_mm / width_mm
        edges = np.arange(-1.0, screw.sectors + 2) + np.pad(late, ((0, 0), (1, 2)), mode="wrap")
        wobble_turns = self.eccentricity_mm / (TWO_PI * self.radius_mm)
        is_even = not late.any()
        return Wheels(
            edges, screw.sectors, 1 / screw.pitch_mm, wobble_turns, self.is_lit, is_even
        )


def screw_for(mm_per_cycle: float) -> LeadScrew:
    """The screw nearest to a pitch of 5 mm whose wheel has whole sectors for this travel in a cycle."""
    sectors = max(FEWEST_SECTORS, round(LeadScrew().pitch_mm / mm_per_cycle))
    return LeadScrew(sectors * mm_per_cycle, sectors)


@njit(cache=True, inline="always")
def last_edge(position_mm, turned, axis, wheels):  # type: ignore[no-untyped-def]
    """The sector whose edge cell 141 saw last, and the share of it that has passed since."""
    arm = position_mm * wheels.turns_per_mm
    at = turned + arm
    if wheels.wobble_turns != 0.0:
        at += wheels.wobble_turns * math.sin(TWO_PI * arm)
    passed = (at - np.floor(at)) * wheels.sectors
    sector = np.floor(passed)
    if wheels.is_even:
        share = passed - sector
    else:
        place = int(sector) + 1
        edge, following = wheels.edges[axis, place], wheels.edges[axis, place + 1]
        if passed < edge:  # this edge comes late: the one before it is the last
            sector -= 1
            edge, following = wheels.edges[axis, place - 1], edge
        elif passed >= following:  # the next one came early
            sector += 1
            edge, following = following, wheels.edges[axis, place + 2]
        share = (passed - edge) / (following - edge)
    return sector, share


@njit(cache=True, inline="always")
def edges_since(sector, before, sectors):  # type: ignore[no-untyped-def]
    """How many edges trigger 157 has given since a sector: they come one after the other."""
    passed = sector - before
    return passed if passed >= 0 else passed + sectors
