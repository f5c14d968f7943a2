"""A nib or two lines: whether ink that swells all over a sheet is one stroke of a nib, or two lines.

Signals: the averaged widths and the headings along each stretch and the thinnest width (mm) in; what the ink
is out.

    by heading     a rigid nib is as broad along a heading wherever it goes: c0 + c1·|sin| + c2·sin² of the
                   angle from its own, whichever nib (a round pen has c0 alone)
    crosses        two lines that cross narrow to one line at a slope, and go on at it: ╲╱; a hand presses
                   smoothly: ╲_╱
    steps          where one of two lines ends the ink narrows to one line within a width
    blunt          a nib may be lifted where it is broad; two lines would have to end side by side

Where only one place looks like two lines that is not known.

Source: our own; the width of a convex nib along a heading is that of its shadow. Questions: a line drawn
twice, moved aside by less than a pen, is the stroke of a nib, to the last grain of ink.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum, auto

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.ink.straight_on import AS_BROAD
from morfax.tracer.ink.swelling import Swelling
from morfax.tracer.limits import CLEAR_WIDTHS, WIDER

HEADINGS, NIBS = 48, 24  # sectors of half a turn, and at how many angles in it nibs are tried
# of the widths' spread: what no nib explains. Measured on 122 strokes and 27 pairs of lines: rigid nibs 0.03
# to 0.21 (scrawls of them to 0.45), all others 0.35 to 1 (three strokes of a hand that presses 0.12 to 0.24)
MISFIT = 0.3
LOW = 1.12  # thinnest widths: ink that is broader is not one line's, averaged over a crossing
RISES = 0.2  # of the thinnest width: less tells no shape
FALLS = 0.05  # of the thinnest width: behind a maximum
# how far up a slope, and how far along it for that: a straight one half as far for half, a parabola 0.71,
# a sine of any height 0.66 and 0.60
UP = 0.2, 0.4, 0.8
STRAIGHT, LEVELS_OFF = 0.62, (0.3, 0.56)
# widths to either side of a step, from `CLEAR_WIDTHS` on: it is averaged over two
FURTHER = 3.5
STEP = 0.2  # of the thinnest width: ink that is broader by so much is two lines'
LEVEL = 0.3  # of the step, by which the ink beyond it may differ
END = 1, 3  # thinnest widths: where the ink of an end is felt
LEAST = 6  # thinnest widths: a shorter stretch tells nothing of its ends
ENOUGH = 2  # places that look like two lines


class SwellingKind(Enum):
    """What swelling ink is."""

    NIB = auto()
    TWO_LINES = auto()
    EITHER = auto()


def what_swells(some: Sequence[Swelling], thin_mm: float) -> SwellingKind:
    """What the ink of a sheet is that no rigid nib has drawn, and whose thinnest width is given."""
    if _ends_are_blunt(some, thin_mm):
        return SwellingKind.NIB
    places = sum(len(like_two_lines(each, thin_mm)) for each in some)
    if places >= ENOUGH:
        return SwellingKind.TWO_LINES
    return SwellingKind.EITHER if places else SwellingKind.NIB


def is_by_heading(some: Sequence[Swelling]) -> bool:
    """Whether ink is as broad along the same heading everywhere, as that of some rigid nib is."""
    widths = np.concatenate([each.averaged for each in some])
    headings = np.concatenate([each.run.headings_rad for each in some])
    known = np.isfinite(widths)
    widths, share = widths[known], np.mod(headings[known] / np.pi, 1.0)
    # 1. the mean width along each heading, and how much single widths differ from it
    sector = np.minimum((share * HEADINGS).astype(int), HEADINGS - 1)
    count = np.bincount(sector, minlength=HEADINGS)
    means = np.bincount(sector, widths, HEADINGS) / np.maximum(count, 1)
    within = float(np.sum((widths - means[sector]) ** 2))
    # 2. how much these means differ from the widths of a nib
    weights, middles = np.sqrt(count), (np.arange(HEADINGS) + 0.5) * np.pi / HEADINGS
    between = min(
        _misfit(np.abs(np.sin(middles - nib)), means, weights)
        for nib in np.arange(NIBS) * np.pi / NIBS
    )
    return within + between < MISFIT**2 * len(widths) * float(np.var(widths))


def _misfit(sines: Array, means: Array, weights: Array) -> float:
    """The sum of the squares of what is left of some widths by the best nib of an angle."""
    shapes = np.column_stack([np.ones_like(sines), sines, sines**2]) * weights[:, None]
    fit = np.linalg.lstsq(shapes, means * weights)[0]
    return float(np.sum((shapes @ fit - means * weights) ** 2))


def may_be_two_lines(each: Swelling, thin_mm: float, onward: tuple[int, int]) -> bool:
    """Whether ink that swells may be two lines of the thinnest width; so many go straight on from its ends.

    Two lines part, cross, or end somewhere, side by side too. Ink that does not and is thin at its ends, or
    within it as a nib is that swells twice, is one stroke's.
    """
    if max(onward) > 1 or like_two_lines(each, thin_mm):
        return True
    first, last = onward
    each = each._replace(ends=(first == 0, last == 0))
    low = np.flatnonzero(each.known < LOW * thin_mm)
    is_thin_within = bool(len(low)) and low[0] > 0 and low[-1] < len(each.known) - 1
    return not is_thin_within and any(_broad_ends([each], thin_mm))


def like_two_lines(each: Swelling, thin_mm: float) -> list[int]:
    """The stations of a stretch where two lines seem to cross, or one of them to end."""
    crossed = _crossings(each.averaged, thin_mm)
    near = FURTHER * thin_mm / each.run.view.step_mm
    ended = _steps(each.averaged, thin_mm, each.run.view.step_mm)
    return crossed + [at for at in ended if all(abs(at - other) > near for other in crossed)]


def _crossings(averaged: Array, thin_mm: float) -> list[int]:
    """The stations at which the ink of two lines narrows to one, as where they cross."""
    known = np.flatnonzero(np.isfinite(averaged))
    widths, found = averaged[known], list[int]()
    low = np.flatnonzero(widths < LOW * thin_mm)
    for part in np.split(low, np.flatnonzero(np.diff(low) > 1) + 1):
        if not len(part) or part[0] == 0 or part[-1] == len(widths) - 1:
            continue
        at = int(part[np.argmin(widths[part])])
        slopes = [
            _slope(side - widths[at], FALLS * thin_mm) for side in (widths[at::-1], widths[at:])
        ]
        if _is_straight(slopes, RISES * thin_mm):
            found.append(int(known[at]))
    return found


def _slope(rises: Array, falls_mm: float) -> Array:
    """The part of some rises up to the first maximum, behind which they fall."""
    highest = np.maximum.accumulate(rises)
    down = np.flatnonzero(rises < highest - falls_mm)
    until = int(down[0]) if len(down) else len(rises)
    return rises[: int(np.argmax(rises[:until])) + 1]


def _is_straight(slopes: Sequence[Array], least_mm: float) -> bool:
    """Whether two slopes from one place rise at once, and as far as they do: that is a crossing."""
    high_mm = min(float(rises[-1]) for rises in slopes)
    if high_mm < least_mm:
        return False
    near, middle, far = (
        sum(int(np.argmax(rises >= share * high_mm)) for rises in slopes) for share in UP
    )
    low, high = LEVELS_OFF
    return near < STRAIGHT * middle and low * far < middle < high * far


def _steps(averaged: Array, thin_mm: float, step_mm: float) -> list[int]:
    """The stations at which the ink narrows from that of two lines to that of one within a width."""
    near, far = (round(widths * thin_mm / step_mm) for widths in (CLEAR_WIDTHS, FURTHER))
    if len(averaged) < 2 * far + 1:
        return []
    rises, middle = averaged / thin_mm - 1, slice(far, len(averaged) - far)
    at = np.arange(len(averaged))[middle]
    is_step = np.zeros(len(at), bool)
    for way in (1, -1):
        beside, beyond = rises[at + way * near], rises[at + way * far]
        is_one = np.maximum(abs(rises[at - way * near]), abs(rises[at - way * far])) < AS_BROAD
        is_step |= is_one & (beside > STEP) & (np.abs(beyond - beside) < LEVEL * beside)
    return at[np.flatnonzero(np.diff(np.r_[False, is_step].astype(int)) > 0)].tolist()


def _ends_are_blunt(some: Sequence[Swelling], thin_mm: float) -> bool:
    """Whether the ink ends where it is broad, wherever it ends."""
    broad = _broad_ends(some, thin_mm)
    return bool(broad) and all(broad)


def _broad_ends(some: Sequence[Swelling], thin_mm: float) -> list[bool]:
    """Of each end of the ink whether it is broad there."""
    broad = list[bool]()
    for each in some:
        first, last = (round(widths * thin_mm / each.run.view.step_mm) for widths in END)
        if each.run.length_mm < LEAST * thin_mm:
            continue
        for ends, widths in zip(
            each.ends, (each.run.widths_mm, each.run.widths_mm[::-1]), strict=True
        ):
            near = widths[first:last]
            if ends and np.isfinite(near).any():
                broad.append(float(np.nanmedian(near)) > WIDER * thin_mm)
    return broad
