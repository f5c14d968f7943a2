"""The outline of a net: which line is taken of a sheet on which lines cross or touch, if nobody says which.

Signals: a set-up in; out the longest closed outline on the sheet, as the head ran along it.

A patch of ink that goes round two areas or more is a net. Its length is that of its longest closed outline
(see `ink.outlines`), and if no other line of the sheet is longer, the head runs along that. From a place on a
net the head might go straight on into another line; the net's junctions are solved first, so the choice
depends neither on the place nor on how the sheet lay in the scanner.

A signature makes a net too, and the areas it goes round are no contours: where the lines, straight on over
all junctions, are one stroke from a free end, and no closed outline is most of it, the head runs that stroke.

A line that touches itself makes a net too. If its outline leaves ink out, the head looks for a longer closed
way through the tangles itself; and where the head is lost on ink that goes round one area, the junctions show
the way round.

Source: our own; the operator of patent ES 361967 says which line. Questions: a drawn program (a reference
point, a card, a turn or stop that was told) has one line, which its lead line leads to: it is no net.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.motion.long_array import one_in
from morfax.motion.polyline import area_mm2, length_mm
from morfax.motion.usual import THINNED
from morfax.tracer.drawing.numbering import ALIKE
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following import lost
from morfax.tracer.following.line import Line
from morfax.tracer.following.start import put_down
from morfax.tracer.junctions.rings import FARTHEST_WIDTHS
from morfax.tracer.program.nets.centre_crosses import is_centre_cross
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.behind_spot import ABOUT_MM

if TYPE_CHECKING:
    from morfax.tracer.ink.chains import Chain, Junctions
    from morfax.tracer.ink.outlines import Outline

# of its ink: an outline that is shorter leaves bays or other lines out; by trial
NEARLY_ALL = 0.97
# of a stroke that is all of a net's ink: a longer closed outline is what was drawn, and the rest its overlap;
# by trial
MOST_OF_IT = 0.6
CLOSES = 0.9  # of what the head has run before it was lost: a shorter way round leaves too much out; by trial
# of the junctions of a line that only touches itself, at the most: have an odd number of legs, or are ends of
# it; by trial
FEW = 1 / 3
WORKS_MM = 10.0  # a head whose cell is out of order is lost before it has run so far
# from a patch to the edge of what is looked at for its junctions: as far as cells look, and as much again
ABOUT_WIDTHS = 2 * FARTHEST_WIDTHS
MOST_PATCHES = 100_000  # of a sheet with more nobody expects one line


class OfNet(NamedTuple):
    """The set-up in which each net is as long as its longest outline; the line, if that is the longest.

    `leaves_out`: whether it passes bays by where one line touches itself, through which the head may find.
    """

    setup: Setup
    line: Line | None = None
    leaves_out: bool = False


def of_net(setup: Setup) -> OfNet:
    """The longest closed outline of the sheet's nets, if no other line is longer."""
    sheet = setup.sheet
    if not may_solve(setup):
        return OfNet(setup)
    is_net = are_nets(sheet)
    if not is_net.any():
        return OfNet(setup)
    lengths_mm = sheet.told.lengths_mm
    longest_mm = float(np.max(lengths_mm[~is_net], initial=0.0))
    nets = np.flatnonzero(is_net & (lengths_mm > (1 - ALIKE) * longest_mm))
    if not len(nets) or _has_reference(setup):
        return OfNet(setup)
    # 1. the longest outline of each
    found: dict[int, tuple[Outline, Junctions]] = {}
    for patch in nets.tolist():
        taken = _closed(setup, patch, or_stroke=setup.operator.direction is None)
        if taken is not None:
            found[patch] = taken
    # 2. the nets count by these
    counted = _counting(
        sheet, {patch: outline.length_mm for patch, (outline, _) in found.items()}
    )
    longest = int(counted.longest_first(np.arange(sheet.patches.count))[0])
    if longest not in found:
        return OfNet(replace(setup, sheet=counted))
    outline, junctions = found[longest]
    line = replace(
        line_along(setup, outline.chain, junctions), ink_mm=float(sheet.lengths_mm[longest])
    )
    is_nearly_all = outline.length_mm > NEARLY_ALL * float(lengths_mm[longest])
    may_be_longer = outline.chain.closed and not is_nearly_all
    return OfNet(setup, line, may_be_longer and touches_itself(junctions))


def _counting(sheet: Sheet, by_patch_mm: Mapping[int, float]) -> Sheet:
    """The sheet on which some patches are so long."""
    lengths_mm, told_mm = sheet.lengths_mm.copy(), sheet.told.lengths_mm.copy()
    for patch, long_mm in by_patch_mm.items():
        lengths_mm[patch] = told_mm[patch] = long_mm
    return sheet.counting(lengths_mm, told_mm)


def outline_of(setup: Setup, patch: int) -> Line | None:
    """The longest closed outline of a patch that goes round two areas or more, as the head ran along it."""
    sheet = setup.sheet
    if not may_solve(setup):
        return None
    closed = _closed(setup, patch) if are_nets(sheet)[patch] else None
    if closed is None:
        return None
    outline, junctions = closed
    line = line_along(setup, outline.chain, junctions)
    return replace(line, ink_mm=float(sheet.lengths_mm[patch]))


def round_ring(setup: Setup, line: Line) -> Line | None:
    """The way round the ink on which a line was lost, if that goes round one area and closes."""
    sheet = setup.sheet
    if line.reference_mm is not None or not may_solve(setup):
        return None
    if line.length_mm < WORKS_MM and line.fault is not None and lost.by_its_cell(line.fault):
        return None
    patch = sheet.patch_at(np.asarray(line.start_mm))
    if sheet.are_solid[patch] or sheet.loops()[patch] != 1:
        return None
    closed = _closed(setup, patch)
    if closed is None or closed[0].length_mm < CLOSES * line.length_mm:
        return None
    outline, junctions = closed
    return replace(line_along(setup, outline.chain, junctions), ink_mm=line.ink_mm)


def _closed(
    setup: Setup, patch: int, or_stroke: bool = False
) -> tuple[Outline, Junctions] | None:
    """The longest closed outline of a patch of ink, or the one stroke that it is; and its junctions."""
    from morfax.tracer.ink.outlines import one_stroke, outlines

    junctions = junctions_of(setup, patch)
    found = outlines(junctions)[:1]
    stroke = one_stroke(junctions) if or_stroke else None
    if stroke is not None and all(it.length_mm < MOST_OF_IT * stroke.length_mm for it in found):
        found = [stroke]
    return (found[0], junctions) if found else None


def junctions_of(setup: Setup, patch: int) -> Junctions:
    """The junctions of a patch of ink, each solved once; those of the newest patch are remembered."""
    from morfax.tracer.ink.solving import solved
    from morfax.tracer.ink.stretches import FeltSheet

    if patch not in setup.newest:
        sheet, settings = setup.sheet, setup.settings
        about_mm = ABOUT_MM + settings.gap_mm + ABOUT_WIDTHS * float(sheet.widths_mm[patch])
        window = replace(sheet, window=None).about(patch, about_mm).window
        top, left, bottom, right = window or (0, 0, *sheet.drawing.darkness.shape)
        ink = sheet.patches.painted(patch, top, bottom, left, right)
        felt = FeltSheet.of(sheet.drawing, settings, ink, window=window)
        setup.newest.clear()
        setup.newest[patch] = solved(felt, _told_of(setup, patch))
    return setup.newest[patch]


def _told_of(setup: Setup, patch: int) -> Callable[[float], None] | None:
    """Who hears how many of a patch's junctions are solved, a share: half of the work on it."""
    ink_mm = float(setup.sheet.lengths_mm[patch])
    told = setup.told(ink_mm)
    return None if told is None else lambda share: told(0.5 * share * ink_mm)


def touches_itself(junctions: Junctions) -> bool:
    """Whether a net may be one line that touches itself: it brings an even number of legs to most of its
    junctions, and ends nowhere but at spikes whose two lines are one.
    """
    legs = np.array([len(there.sides) for there in junctions.by_number.values()])
    at_junctions, ends = legs[legs > 2], int(np.sum(legs == 1))
    if not len(at_junctions):
        return False
    return bool(np.mean(at_junctions % 2) < FEW and ends < FEW * len(at_junctions))


def _is_program(setup: Setup) -> bool:
    """Whether somebody says where the line is, or which way it goes on."""
    operator, drawing = setup.operator, setup.sheet.drawing
    told = drawing.told_turns or drawing.told_stops or operator.card.is_about_stops
    named = operator.reference_mm is not None or operator.marks == "on"
    return bool(told or named or operator.direction in ("left", "right"))


def _has_reference(setup: Setup) -> bool:
    """Whether a line leads away from a reference point that is drawn."""
    sheet = setup.sheet
    try:
        stance, _ = next(put_down(sheet, settings=setup.settings))
    except LineFault:
        return False
    if stance.reference_mm is None:
        return False
    patch = sheet.longest().patch
    return not are_nets(sheet)[patch] or not is_centre_cross(junctions_of(setup, patch), stance)


def are_nets(sheet: Sheet) -> NDArray[np.bool_]:
    """Which patches go round two areas or more, and are no filled shapes full of specks."""
    return np.asarray((sheet.loops() > 1) & ~sheet.are_solid & ~sheet.are_speckled())


def goes_round(sheet: Sheet, patch: int, areas: int) -> bool:
    """Whether a patch goes round so many areas, and is no filled shape."""
    return not sheet.are_solid[patch] and sheet.loops()[patch] == areas


def may_solve(setup: Setup) -> bool:
    """Whether a patch may be followed by its junctions: nobody says which way the head goes on."""
    sheet = setup.sheet
    is_usual = not sheet.drawing.edges_mm and sheet.patches.count <= MOST_PATCHES
    return is_usual and not _is_program(setup)


def chain_mm(chain: Chain, junctions: Junctions) -> float:
    """The length of a chain by its ink, mm."""
    return sum(junctions.net.lines[link.line].length_mm for link in chain.links)


def line_along(setup: Setup, chain: Chain, junctions: Junctions) -> Line:
    """The head's run along a chain of lines, of a closed one the way round that is asked for."""
    from morfax.tracer.ink.outlines import junctions_on
    from morfax.tracer.ink.track import stroke_along

    closed, told = chain.closed, setup.told(chain_mm(chain, junctions))
    stroke = stroke_along(chain, junctions, setup.settings, told)
    way_mm, led = stroke.way_mm, stroke.led
    places = junctions_on(chain, junctions)
    direction = setup.operator.direction
    if closed and direction is not None and (area_mm2(way_mm) > 0) != (direction == "ccw"):
        way_mm, led, places = way_mm[::-1], led.turned_round(len(way_mm)), places[::-1]
    return Line(
        way_mm,
        "closed" if closed else "ended",
        stroke.width_mm,
        length_mm(way_mm),
        led=led,
        is_of_net=True,
        junctions_mm=tuple(_from_start(places, way_mm)),
    )


def _from_start(places: list[tuple[float, float]], way_mm: Array) -> list[tuple[float, float]]:
    """Places on a closed way in the order in which it comes to them."""
    thinned = one_in(way_mm, THINNED)
    come = [int(np.argmin(np.hypot(*(thinned - place).T))) for place in places]
    return [places[k] for k in np.argsort(come, kind="stable")]
