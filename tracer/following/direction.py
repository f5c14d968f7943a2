"""Direction: which way round the operator has the head take a line.

Signals: a run, or a stance, in; whether it goes that way round, or the stance turned that way, out.

    cw, ccw        clockwise or counter-clockwise round a closed line
    left, right    as the head turns when it comes to the line from the place where it was put down
    an arrow       the place on a line where it begins, and a place to which the head goes from there

Source: patent ES 361967, section on use: the operator brings the head over the drawing and lets it run.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from morfax.motion.faults import LineFault
from morfax.motion.polyline import area_mm2
from morfax.tracer.following.followed import Followed
from morfax.tracer.head.stance import Stance
from morfax.tracer.sensing.leg import turn
from morfax.tracer.sensing.side import Side

Direction = Literal["cw", "ccw", "left", "right"]

Place = tuple[float, float]  # mm on the sheet


class Arrow(NamedTuple):
    """Where a line begins, and a place to which the head goes from there, mm on the sheet."""

    place_mm: Place
    towards_mm: Place


ON_LINE_WIDTHS = 0.5  # a head put down nearer to the middle of a line comes from neither side


def goes(run: Followed, direction: Direction) -> bool:
    """Whether a run goes round in a direction, "cw" or "ccw"."""
    is_loop = run.ending == "closed" or (run.ending == "joined" and run.loop_from is not None)
    return is_loop and (area_mm2(run.loop_mm) > 0) == (direction == "ccw")


def turned_about(stance: Stance) -> Stance:
    """The same place, with the head the other way."""
    return replace(stance, heading_rad=math.remainder(stance.heading_rad + math.pi, math.tau))


def turned_to(stance: Stance, start_mm: tuple[float, float] | None, side: Side) -> Stance:
    """The stance as the head comes to the line from where it was put down, and turns to a side.

    Raises LineFault if the head was put down on the line.
    """
    way = stance.place_mm - np.asarray(stance.place_mm if start_mm is None else start_mm)
    if np.hypot(*way) < ON_LINE_WIDTHS * stance.view.width_mm:
        raise LineFault(
            f"--direction {side} is seen from the way that comes to the line, and the head was put down on"
            " the line; give --start X,Y beside it, or --direction cw or ccw"
        )
    ahead = turn(math.atan2(way[1], way[0]), stance.heading_rad)
    return stance if (ahead > 0) == (side == "left") else turned_about(stance)
