"""Holding tabs: where the tool rises on its way round a closed line, so that what it cuts out stays held.

Signals: a closed line, the tabs that are asked for, the cutter and the halts on the line in; the positions at
which Z rises and goes down again out.

    Z  ───┐   ┌──────   top: tab height above the full depth          ├─ width ─┤
          │   │                                                     ──┐         ┌──   middle of the cutter
     ─────┘   └──────   full depth: tabs of rectangular section       ├─ width + diameter ─┤

The closed line, from where it begins to where it ends, is shared out evenly, and a tab set in the middle of
each share. It is moved along, by up to a quarter of the share to either side, to where it is clear of
corners, halts, guide lines and bends of less than 3 mm radius, and of places where the cutter's other passage
has left nothing to hold; of the places that are left the straighter ones are taken before the nearer ones.

Source: our own; that tabs are longer by the cutter's diameter at its middle's path is as in CAM. Questions:
the part hangs on the outermost line, so tabs that have no room there are a fault; a hole too small for its
tabs gets as many as it has room for, down to none, and a remark says so, unless the cutter mills it all away.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import MotionFault
from morfax.motion.plane import CORNER_RAD, left_of_headings
from morfax.motion.polyline import area_mm2, at_lengths
from morfax.tracer.effort import LOOKED_MM
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Action, Tabs
from morfax.tracer.program.passes.way import Way

# All limits below were chosen by trial on the samples, but for those with another reason.
MOST_SHARE = 0.5  # of a line: more would be less cut than held
MOVED_SHARE = 0.25  # of its share of the line: neighbours stay half a share apart
CLEAR_MM = 1.0  # from a tab to a corner, a halt, the beginning of the line
FELT_MM = 0.5  # to either side of a place: shows the heading there
# turned over a tab: the first of these that it stays in counts
STRAIGHT_RAD = np.radians([20, 45, 90])
BESIDE_MM = 0.2  # beside the cut: there must be something that the tab can hold
CUT_AWAY_MM = 0.05  # nearer to the path than the cutter's radius by more: cut away


@dataclass(frozen=True, slots=True)
class Tab:
    """One tab: the positions of the line at which Z rises and goes down again, and its middle, mm."""

    first: float
    last: float
    place_mm: tuple[float, float]


def tabs_of(
    lines: Sequence[Line], operator: Operator, actions: Sequence[Sequence[Action]]
) -> list[tuple[Tab, ...]]:
    """The tabs of each line, by what the operator does on it; none of an open line or a hole.

    Raises MotionFault if they have no room on a line that lies in no other, or are as high as it is deep.
    """
    tabs, work = operator.work.tabs, operator.work
    if tabs is None:
        return [() for _ in lines]
    made = list[tuple[Tab, ...]]()
    for line, along in zip(lines, actions, strict=True):
        if not line.comes_round or len(line.xy_mm) < 2:
            made.append(())
            continue
        _refuse_high(tabs, operator.depths_mm(along)[-1], line)
        halts = [*(action.halt.at for action in along), *(guide.leave for guide in line.guides)]
        place = _as_many_as_fit if is_inner(line, lines) else tabs_on
        made.append(place(line, tabs, work.cutter_mm, halts))
    return made


def _refuse_high(tabs: Tabs, depth_mm: float, line: Line) -> None:
    """Raise MotionFault for tabs that are not lower than the cut is deep."""
    if tabs.height_mm >= depth_mm:
        raise MotionFault(
            f"tabs of {tabs.height_mm:g} mm are not lower than line {line.number} is cut deep,"
            f" {depth_mm:g} mm; give a lower --tab-height, or a greater --depth"
        )


def is_inner(line: Line, lines: Sequence[Line]) -> bool:
    """Whether a line lies inside another one that comes round."""
    from morfax.motion import nesting

    around = [other for other in lines if other is not line and other.comes_round]
    return any(nesting.lies_inside(line.loop_mm, other.loop_mm) for other in around)


def is_milled_away(line: Line, cutter_mm: float) -> bool:
    """Whether a cutter on this closed line leaves nothing within it that could come loose."""
    from morfax.motion.offset import DriveCurve, offset

    inwards = DriveCurve(line.loop_mm, closed=True, left=area_mm2(line.loop_mm) > 0)
    return cutter_mm > 0 and not offset([inwards], 0.5 * cutter_mm)


def tabs_on(
    line: Line, tabs: Tabs, cutter_mm: float, halts: Sequence[float]
) -> tuple[Tab, ...]:
    """The tabs of one closed line; raises MotionFault if they have no room on it."""
    loop = Way.loop(line)
    long_mm = tabs.width_mm + cutter_mm
    most = int(MOST_SHARE * loop.length_mm / long_mm)
    if tabs.count > most:
        raise _too_many(line, loop, tabs, cutter_mm, most)
    kept_off = [loop.mm_at(halt) for halt in halts]
    middles_mm, turned = _places(loop, long_mm, cutter_mm, kept_off)
    found = list[Tab]()
    share_mm = loop.length_mm / tabs.count
    for k in range(tabs.count):
        wanted_mm = (k + 0.5) * share_mm
        near = np.abs(middles_mm - wanted_mm) <= MOVED_SHARE * share_mm
        if not near.any():
            raise _no_place(line, loop, wanted_mm, k + 1)
        least = np.searchsorted(STRAIGHT_RAD, turned[near].min())
        straight = middles_mm[near & (turned <= STRAIGHT_RAD[least])]
        middle_mm = float(straight[np.argmin(np.abs(straight - wanted_mm))])
        if abs(middle_mm - wanted_mm) < LOOKED_MM:
            middle_mm = wanted_mm
        found.append(_tab(loop, middle_mm, long_mm))
    return tuple(found)


def _as_many_as_fit(
    line: Line, tabs: Tabs, cutter_mm: float, halts: Sequence[float]
) -> tuple[Tab, ...]:
    """The tabs of a line inside another one: as many as are asked for, or as it has room for."""
    for count in range(tabs.count, 0, -1):
        try:
            fewer = Tabs(count, tabs.width_mm, tabs.height_mm)
            return tabs_on(line, fewer, cutter_mm, halts)
        except MotionFault:
            continue
    return ()


def _tab(loop: Way, middle_mm: float, long_mm: float) -> Tab:
    """A tab at a place along the loop."""
    first, last = (loop.position(middle_mm + side * 0.5 * long_mm) for side in (-1, 1))
    return Tab(first, last, loop.place(middle_mm))


def _places(
    loop: Way, long_mm: float, cutter_mm: float, kept_off_mm: Sequence[float]
) -> tuple[Array, Array]:
    """Where the middle of a tab may be, mm along the loop, and how far the way turns over each, rad."""
    from scipy.ndimage import maximum_filter1d, minimum_filter1d

    # 1. the heading at places along the loop
    at_mm = np.arange(0.0, loop.length_mm, LOOKED_MM)
    ahead, behind = (at_lengths(loop.places_mm, at_mm + felt) for felt in (FELT_MM, -FELT_MM))
    heading = np.unwrap(np.arctan2(*(ahead - behind).T[::-1]))
    # 2. how far it turns over a tab, and over the sharpest mm of it and beside it
    wide = 2 * round(0.5 * long_mm / LOOKED_MM) + 1
    clear = 2 * round((0.5 * long_mm + CLEAR_MM) / LOOKED_MM) + 1
    turned = maximum_filter1d(heading, wide) - minimum_filter1d(heading, wide)
    felt = 2 * round(FELT_MM / LOOKED_MM) + 1
    bend = maximum_filter1d(heading, felt) - minimum_filter1d(heading, felt)
    sharpest = maximum_filter1d(bend, clear)
    # 3. clear of corners and of bends of less than 3 mm radius, of the ends of the loop and the halts on it
    half_mm = 0.5 * long_mm + CLEAR_MM
    ok = (turned <= STRAIGHT_RAD[-1]) & (sharpest <= CORNER_RAD)
    ok &= (at_mm >= half_mm) & (at_mm <= loop.length_mm - half_mm)
    for halt_mm in kept_off_mm:
        ok &= np.abs(at_mm - halt_mm) >= half_mm
    ok &= _holds(loop, at_mm, heading, cutter_mm)
    return at_mm[ok], turned[ok]


def _holds(loop: Way, at_mm: Array, heading: Array, cutter_mm: float) -> NDArray[np.bool_]:
    """Where the cutter leaves something to hold on either side of it."""
    from scipy.spatial import cKDTree

    if not cutter_mm:
        return np.ones(len(at_mm), bool)
    places = at_lengths(loop.places_mm, at_mm)
    across = left_of_headings(heading)
    away_mm, tree = 0.5 * cutter_mm + BESIDE_MM, cKDTree(places)
    left, right = (tree.query(places + side * away_mm * across)[0] for side in (1, -1))
    return np.asarray(np.minimum(left, right) >= 0.5 * cutter_mm - CUT_AWAY_MM)


def _too_many(line: Line, loop: Way, tabs: Tabs, cutter_mm: float, most: int) -> MotionFault:
    """The fault of more or longer tabs than a line has room for."""
    cutter = f" with a cutter of {cutter_mm:g} mm" if cutter_mm else ""
    fewer = f"give --tabs {most}, or narrower ones" if most else "give narrower ones"
    them = "a tab" if tabs.count == 1 else f"{tabs.count} tabs"
    return MotionFault(
        f"{them} of {tabs.width_mm:g} mm{cutter} would hold more than half of line {line.number}, which is"
        f" {loop.length_mm:.1f} mm round; {fewer} with --tab-width"
    )


def _no_place(line: Line, loop: Way, wanted_mm: float, number: int) -> MotionFault:
    """The fault of a tab that has no place between corners, bends and stops."""
    x, y = loop.place(wanted_mm)
    return MotionFault(
        f"tab {number} of line {line.number} has no place about {x:.1f},{y:.1f} mm clear of corners, bends"
        " and stops; give another number of --tabs, or narrower ones with --tab-width"
    )
