"""What lines do not explain: ink of theirs along which no line runs, and ways without ink.

Signals: the sheet and the lines that were followed in; out the places at which the head's own pen would not
have drawn what is there.

    ───╮  ╭───     a tip that the head passed by: its ink lies beside every way (see `ink_beside`)
       │──│
       ╰──╯        a way over bare paper, longer than a gap that the head may cross

A line that comes round may still be another than the one that was drawn, where tips and bays are narrower
than two lines.

On a coarse scan, whose pixels were made finer, lines look a pixel wider than they are, and a way that cuts
off a spike or a bay runs over ink that is paler than a line, not over paper. Where lines are about a pixel
wide, the ink that a pen would leave on the way is held against the sheet's (see `redrawn`).

Source: our own; the operator of patent ES 361967 looks at the drawing and at the part. Questions: whether ink
beside a line belongs to it, or is another line that touches it, the pen cannot know.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import lengths_mm, nearest_mm, with_places
from morfax.tracer.drawing import coarse
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.sharpening import turned_at
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.effort import EVERY_MM
from morfax.tracer.following.edge_check import OFF_MM, most_off_mm
from morfax.tracer.following.line import Line
from morfax.tracer.limits import ABOUT_WIDTHS, CLEAR_WIDTHS, PAPER, TIP_RAD
from morfax.tracer.program.against_ink.crossed_ink import crossed_in_ink
from morfax.tracer.program.against_ink.ink_beside import PALE, darkness_at, pieces_beside
from morfax.tracer.program.against_ink.own_ink import DOUBT, OwnInk
from morfax.tracer.program.against_ink.redrawn import most_astray
from morfax.tracer.program.setup import Setup

CUT_MM = 0.1  # ten times a corner's error
BESIDE = 2.0  # times as far apart as both are off: it is the same tip
# darkness by which a way that is redrawn differs from the scan, on lines that look as wide as 1.5 pixels or
# less: of 166 right paths on lines of 1 pixel 7 came above it, 0.33 to 0.46 mm off, and all of 14 wrong ones
ASTRAY = 0.2

Kind = Literal["ink", "tip", "aside", "bare", "beside", "crossed", "broad", "pale", "off"]


class Unexplained(NamedTuple):
    """A place that the ways do not explain: where, how much (mm), and what is there.

    ink       ink beside all ways: how far it reaches
    tip       a tip of a filled shape, or its edge: how much of it the way cuts off
    bare      a way over bare paper: for how long; aside: one beside the edge of a filled shape
    beside    a way beside its own pen's ink: for how long
    crossed   a closed way that crosses itself within its ink (see `crossed_ink`): how far it goes round there
    broad     a way within ink that is as broad as two lines or more: for how long
    off       strokes of all the ink off it, where lines meet (see `strokes_off_ink`): for how long
    pale      on a coarse scan a way over ink that is pale: for how long; and `wants_dpi`, the resolution that
        would show what is there
    """

    place_mm: tuple[float, float]
    length_mm: float
    kind: Kind
    wants_dpi: int | None = None
    is_sure: bool = True


def unexplained(setup: Setup, own: OwnInk) -> tuple[Unexplained, ...]:
    """What some lines leave unexplained, the longest first: of closed ones all, of lines that ran into
    themselves only ink, for there the head may have turned off its line, and of an open one that is alone or
    where ink goes on beyond an end, of others only where they may run beside their ink.

    Of a drawn program nothing: its guide lines, ticks and dots are beside the way, and so meant.
    """
    lines = own.lines
    if not lines or setup.operator.reads_marks(lines):
        return ()
    found = _of_closed(setup, lines)
    # ink that was missed by little may lie in a bay that was cut short
    reach_mm = (0.5 + CLEAR_WIDTHS) * max(line.width_mm for line in lines)
    other = [place for place in found if place.kind != "ink" or place.length_mm > reach_mm]
    bays = list(_beside_ink(own, other))
    sure = [place for place in bays if place.is_sure]
    found = [place for place in found if not is_about(place, sure, lines)] + bays
    for place_mm, long_mm in crossed_in_ink(setup.sheet.drawing, lines):
        place = Unexplained(place_mm, long_mm, "crossed")
        found += [] if is_about(place, found, lines) else [place]
    return tuple(sorted(found, key=lambda place: -place.length_mm))


def _of_closed(setup: Setup, lines: Sequence[Line]) -> list[Unexplained]:
    """What those of some lines that must account for all their ink leave, but for stretches beside it."""
    sheet, gap_mm = setup.sheet, setup.settings.gap_mm
    closed = [line for line in lines if line.ending == "closed"]
    found = [*ink_beside(sheet, lines), *bare_ways(sheet, closed, gap_mm)]
    found += _tips_cut(sheet.drawing.edges_mm, closed)
    found += _once(_off_edges(sheet.drawing, closed))
    return found or list(_astray(sheet, closed))


def beside_ink(setup: Setup, own: OwnInk) -> tuple[Unexplained, ...]:
    """Where some lines may run beside their ink; the longest first."""
    return tuple(sorted(_beside_ink(own, ()), key=lambda place: -place.length_mm))


def _beside_ink(own: OwnInk, found: Sequence[Unexplained]) -> Iterator[Unexplained]:
    """Stretches of lines that may be beside their ink, but for those about what was found otherwise."""
    for place_mm, long_mm, is_sure in own.beside(DOUBT):
        place = Unexplained(place_mm, long_mm, "beside", is_sure=is_sure)
        if not is_about(place, found, own.lines):
            yield place


def is_about(place: Unexplained, others: Sequence[Unexplained], lines: Sequence[Line]) -> bool:
    """Whether a place is about one of some others, by the broadest of some lines."""
    about_mm = ABOUT_WIDTHS * max(line.width_mm for line in lines)
    return any(math.dist(place.place_mm, other.place_mm) < about_mm for other in others)


def ink_beside(sheet: Sheet, lines: Sequence[Line]) -> Iterator[Unexplained]:
    """Ink beside all ways of those of some lines that must account for all of theirs, and ink that is far
    broader than these.
    """
    for piece in pieces_beside(sheet, lines):
        kind: Kind = "broad" if piece.is_broad else "ink"
        yield Unexplained(piece.place_mm, piece.length_mm, kind)


def bare_ways(sheet: Sheet, closed: Sequence[Line], gap_mm: float) -> Iterator[Unexplained]:
    """Stretches of closed lines over bare paper, longer than a gap that the head may cross."""
    for line in closed:
        places = line.loop_mm
        come_mm, dark = lengths_mm(places), darkness_at(sheet, places)
        bare = list(_stretches(dark < PAPER, come_mm, gap_mm + CLEAR_WIDTHS * line.width_mm))
        for middle, long_mm in bare:
            x, y = places[middle]
            kind: Kind = "aside" if sheet.drawing.edges_mm else "bare"
            yield Unexplained((float(x), float(y)), long_mm, kind)
        if bare or not _is_coarse(sheet):
            continue
        for middle, long_mm in _stretches(dark < PALE, come_mm, 0.0):
            x, y = places[middle]
            yield Unexplained((float(x), float(y)), long_mm, "pale", _wanted_dpi(sheet))


def _tips_cut(edges_mm: Sequence[Array], closed: Sequence[Line]) -> Iterator[Unexplained]:
    """Tips of filled shapes that the picture shows, and the way does not come to."""
    tips = [edge[:-1][turned_at(edge[:-1], 1) > TIP_RAD] for edge in edges_mm]
    places = np.vstack([np.empty((0, 2)), *tips])
    if not len(places) or not closed:
        return
    # an edge that was not followed is further away
    away_mm = nearest_mm(places, np.vstack([line.places_mm for line in closed]))
    for k in np.flatnonzero((away_mm > CUT_MM) & (away_mm < OFF_MM)):
        x, y = places[k]
        yield Unexplained((float(x), float(y)), float(away_mm[k]), "tip")


def _off_edges(drawing: Drawing, closed: Sequence[Line]) -> Iterator[Unexplained]:
    """Where the ways and the edges of filled shapes are further apart than a fine scan allows."""
    most_mm = most_off_mm(drawing.pitch_mm * drawing.enlarged)
    if not drawing.edges_mm or not closed or most_mm <= OFF_MM:
        return
    ways = [line.places_mm for line in closed]
    edges = [with_places(edge, EVERY_MM) for edge in drawing.edges_mm]
    for lines, others in ((edges, ways), (ways, edges)):
        all_mm = nearest_mm(np.vstack(lines), np.vstack(others))
        ends = np.cumsum([len(line) for line in lines])
        for line, away_mm in zip(lines, np.split(all_mm, ends[:-1]), strict=True):
            if np.median(away_mm) > OFF_MM:
                continue  # an edge that was not followed
            off = np.diff(np.r_[False, away_mm > OFF_MM, False].astype(np.int8))
            for begin, end in np.flatnonzero(off).reshape(-1, 2):
                worst = int(begin + np.argmax(away_mm[begin:end]))
                x, y = line[worst]
                yield Unexplained((float(x), float(y)), float(away_mm[worst]), "tip")


def _once(places: Iterable[Unexplained]) -> list[Unexplained]:
    """The places without those beside a worse one: there the edge and the way are both off."""
    kept = list[Unexplained]()
    for place in sorted(places, key=lambda place: -place.length_mm):
        beside_mm = (math.dist(place.place_mm, other.place_mm) for other in kept)
        if min(beside_mm, default=math.inf) > BESIDE * place.length_mm:
            kept.append(place)
    return kept


def _stretches(
    there: NDArray[np.bool_], come_mm: Array, least_mm: float
) -> Iterator[tuple[int, float]]:
    """The middle and the length (mm) of each stretch of a way that is longer than the least."""
    edges = np.flatnonzero(np.diff(np.r_[False, there, False])).reshape(-1, 2)
    for begin, end in edges:
        long_mm = float(come_mm[end - 1] - come_mm[begin])
        if long_mm > least_mm:
            yield int(begin + end) // 2, long_mm


def _astray(sheet: Sheet, closed: Sequence[Line]) -> Iterator[Unexplained]:
    """Where the ink of closed lines of about a pixel is not what a pen would leave on their ways."""
    is_finest = _is_coarse(sheet) and sheet.drawing.seen_px < coarse.SEEN_PX
    for line in closed if is_finest else ():
        most = most_astray(sheet.drawing, line.loop_mm)
        if most.darkness > ASTRAY:
            yield Unexplained(most.place_mm, _pixel_mm(sheet), "pale", _wanted_dpi(sheet))


def _wanted_dpi(sheet: Sheet) -> int:
    """The resolution that would show what is there."""
    return coarse.wanted_dpi(_pixel_mm(sheet))


def _is_coarse(sheet: Sheet) -> bool:
    """Whether the lines of the picture were too few pixels wide."""
    return sheet.drawing.finer > 1


def _pixel_mm(sheet: Sheet) -> float:
    """The pitch of the picture's own pixels."""
    return sheet.drawing.pitch_mm * sheet.drawing.finer
