"""Moves: what a program of lines and arcs says, read and not yet run.

Signals: ends of moves in mm, feeds in mm/s, times in s.

Source: RS-274-D names the kinds. Questions: rapids have no feed of their own; each control has its fastest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from morfax.motion.axis import TRAVEL_MM
from morfax.motion.faults import ProgramFault
from morfax.motion.motion import AXES
from morfax.player.gcode.arc_words import Place

RAPID, LINE, CLOCKWISE, COUNTER_CLOCKWISE, DWELL = "G0", "G1", "G2", "G3", "G4"


class Move(NamedTuple):
    """A move: end; for an arc centre and angle turned, rad; feed in mm/s; for a dwell its time, s."""

    line: int
    kind: str
    end_mm: Place
    feed_mm_s: float = 0.0
    centre_mm: tuple[float, float] = (0.0, 0.0)
    turned_rad: float = 0.0
    dwell_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Program:
    """A program as read: start of the machine, moves, the machine that it is for, '' if not known, notes on
    it for the operator, and lines with words for the tool, each with the move that comes next.
    """

    start_mm: Place
    moves: list[Move]
    machine: str = ""
    notes: tuple[str, ...] = ()
    said: Sequence[tuple[int, str]] = ()

    @property
    def end_mm(self) -> Place:
        """Where it ends."""
        return self.moves[-1].end_mm if self.moves else self.start_mm


def reached(move: Move) -> Iterator[tuple[float, ...]]:
    """The places that the registers must hold: the end; of an arc the centre and the furthest points too."""
    yield move.end_mm
    if not move.turned_rad:
        return
    x, y = move.centre_mm
    yield x, y
    radius = math.dist(move.centre_mm, move.end_mm[:2])
    last = math.atan2(move.end_mm[1] - y, move.end_mm[0] - x)
    for quarter in range(4):
        before = (
            math.copysign(1, move.turned_rad) * (last - quarter * math.pi / 2) % (2 * math.pi)
        )
        if before <= abs(move.turned_rad):
            yield (
                x + radius * (quarter == 0) - radius * (quarter == 2),
                y + radius * (quarter == 1) - radius * (quarter == 3),
            )


def demand_travel(
    program: str,
    move: Move,
    travel_mm: float = TRAVEL_MM,
    holds: str = "the machine has",
    remedy: str = "move the zero, or make it smaller",
) -> None:
    """Raise ProgramFault for a move that leaves the travel either way from zero; `holds`: what ends there."""
    for place in reached(move):
        for axis, place_mm in zip(AXES, place, strict=False):
            if not abs(place_mm) <= travel_mm:
                raise ProgramFault(
                    f"{program}, line {move.line}: {axis.upper()} goes to {place_mm:.3f} mm; {holds} "
                    f"±{travel_mm:.3f} mm: {remedy}",
                    line=move.line,
                )


def length_mm(place: tuple[float, float, float], move: Move) -> float:
    """Length of a move from a place, mm."""
    if move.turned_rad:
        return abs(move.turned_rad) * math.dist(move.centre_mm, move.end_mm[:2])
    return math.dist(place, move.end_mm)
