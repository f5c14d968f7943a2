"""The survey: what is on a drawing before anything is traced, and which number is which line.

Signals: a set-up in; out a Survey: for each patch of ink that is a line, and for each dot that stands alone,
its number, what it looks like, length and width (mm), the number of the line inside which it lies, and
whether the head can be put down on it.

    goes round 1 area, no end       closed
    goes round none, 2 ends         open
    else                            several: lines cross or touch. The first of them has the patch's number;
                                    the others have numbers when all are followed (see `survey_followed`)

No line is followed: the patches show what they enclose, and the head only looks at ends, and at the places
where it may be put down.

Source: our own; the operator of patent ES 361967 looks at the drawing. Questions: what a patch is made of is
certain only when it has been followed. A patch that looks like one line may be several, and a line with gaps
is several patches.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from morfax.motion.faults import LineFault
from morfax.motion.polyline import APART_MM
from morfax.tracer.drawing.enclosure import NONE, Enclosure
from morfax.tracer.drawing.lengths import Told
from morfax.tracer.drawing.lettering import lettering
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.following.open_ends import from_reference, stances_at
from morfax.tracer.following.plain_places import aperture_for, stands_near, view_of
from morfax.tracer.following.start import put_down
from morfax.tracer.marks.reference import Reference, references
from morfax.tracer.program.head_runs import followed_from_an_end
from morfax.tracer.program.laid.small_lines import small_lines
from morfax.tracer.program.lines import selection
from morfax.tracer.program.lines.selection import Contour
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import View

Kind = Literal["closed", "open", "several", "dot", "joined", "lost"]
Place = tuple[float, float]

# cells whose apertures differ by less find the same ends and places; by trial
FIRST_LOOKS = 2  # places at which the head looks before it asks as a run asks; by trial


@dataclass(frozen=True, slots=True)
class Entry:
    """What has one number: what it looks like, a place on it, its length and width (mm), its patch of ink.

    `inside` is the number of the nearest line round it. `can_begin`: the head can be put down on it, or, if
    small, it is taken for a letter. `joined_to` is the number of its patch, of a line that is joined to
    another; `piece_of` that of the line with gaps along which it lies.
    """

    number: int
    kind: Kind
    place_mm: Place
    length_mm: float
    width_mm: float
    patch: int
    inside: int | None = None
    is_solid: bool = False
    can_begin: bool = True
    is_small: bool = False  # no larger than a letter
    is_lettering: bool = False  # stands in a row with others of its size
    is_reference: bool = False  # the reference point from which another begins
    reference_mm: Place | None = None  # the reference point from which it begins
    joined_to: int | None = None
    piece_of: int | None = None

    @property
    def is_letter(self) -> bool:
        """Whether it is taken for a letter: small, and nowhere a place for the head."""
        return self.is_small and not self.can_begin

    @property
    def is_in_contours(self) -> bool:
        """Whether it is one of the contours: no letter, no rim of a filled shape, no reference point, and no
        piece of another line.
        """
        is_other = self.is_solid or self.is_reference or self.piece_of is not None
        return not (self.is_letter or is_other)


@dataclass(frozen=True, slots=True)
class Survey:
    """What has a number on a sheet, and the patches that have none; the lines, where they were followed, and
    the mm of ink that is joined to them, but is no line.
    """

    sheet: Sheet
    entries: tuple[Entry, ...]
    left_out: tuple[int, ...]
    lettering: tuple[int, ...]  # patches that are likely letters, with a number or without
    lines: tuple[Line, ...] = ()
    not_followed_mm: float | None = None

    @property
    def left_out_mm(self) -> float:
        """Length of the patches that have no number, mm."""
        return float(self.sheet.told.lengths_mm[list(self.left_out)].sum())

    @property
    def width_mm(self) -> float | None:
        """The usual width of a line, mm; None without lines."""
        widths = [entry.width_mm for entry in self.entries if entry.kind != "dot"]
        return float(np.median(widths)) if widths else None


def survey(setup: Setup) -> Survey:
    """Look at a sheet without following a line."""
    sheet = setup.sheet
    contours, _ = selection.plan(sheet, "contours")
    letters = lettering(sheet)
    # 1. patches that are lines
    drawn, sizes = _references(setup), sheet.told
    seen = [
        _of_patch(setup, contour, view, drawn, sizes)
        for contour, view in _viewed(setup, contours)
    ]
    entries = {entry.patch: entry for entry in _with_references(seen, contours)}
    # 2. dots that stand alone, and slots whose sides run together
    for patch, line in small_lines(setup):
        size = line.start_mm, line.length_mm, line.width_mm
        entries[patch] = Entry(line.number, "dot" if line.is_dot else "closed", *size, patch)
    # 3. what lies inside which, and what stands in rows
    enclosure = sheet.patches.enclosure
    loops = sheet.loops()
    for patch, entry in entries.items():
        entries[patch] = replace(
            entry,
            kind=_kind(entry.kind, int(loops[patch])),
            inside=_around(patch, enclosure, entries),
            is_lettering=patch in letters,
        )
    left_out = tuple(p for p in range(sheet.patches.count) if p not in entries)
    in_order = sorted(entries.values(), key=lambda entry: entry.number)
    return Survey(sheet, tuple(in_order), left_out, tuple(sorted(letters)))


def _viewed(setup: Setup, contours: list[Contour]) -> Iterator[tuple[Contour, View]]:
    """Each contour with the sheet as cells see it that suit its width; thin ones first."""
    view, seen_mm = None, 0.0
    for contour in sorted(contours, key=lambda contour: contour.stroke.width_mm):
        width_mm = setup.settings.line_width_mm or contour.stroke.width_mm
        aperture_mm = setup.settings.aperture_mm or aperture_for(setup.sheet.drawing, width_mm)
        if view is None or abs(aperture_mm - seen_mm) > APART_MM:
            view, seen_mm = view_of(setup.sheet, aperture_mm, width_mm), aperture_mm
        yield contour, replace(view, width_mm=width_mm)


def _references(setup: Setup) -> list[Reference]:
    """The crosses and rings that stand alone, each of which a line may begin at."""
    widths_mm = setup.sheet.widths_mm[selection.lines_of(setup.sheet)]
    if not len(widths_mm):
        return []
    view = view_of(setup.sheet, setup.settings.aperture_mm, float(np.median(widths_mm)))
    return list(references(setup.sheet, view))


def _of_patch(
    setup: Setup, contour: Contour, view: View, drawn: list[Reference], sizes: Told
) -> Entry:
    """What a patch looks like, but for what it goes round: "several" with more than two ends, "closed" with
    none.
    """
    sheet, stroke = setup.sheet, contour.stroke
    ends = list(stances_at(view, stroke.ends_mm, setup.settings.gap_mm))
    begins_at = [
        found
        for found in drawn
        if from_reference(found.place_mm, ends) and found.is_sure(sheet, stroke.patch)
    ]
    starts_mm = contour.starts_mm
    return Entry(
        contour.number,
        "several" if len(ends) > 2 else "open" if ends else "closed",
        starts_mm[0],
        float(sizes.lengths_mm[stroke.patch]),
        float(sizes.widths_mm[stroke.patch]),
        stroke.patch,
        is_solid=bool(sheet.are_solid[stroke.patch]),
        can_begin=_can_begin(setup, contour, view, starts_mm),
        is_small=contour.reach_mm < selection.LETTER_MM,
        reference_mm=_begins_at(setup, contour, begins_at[0]) if begins_at else None,
    )


def _begins_at(setup: Setup, contour: Contour, drawn: Reference) -> Place | None:
    """The place of a reference point from which a line begins; None of a ring from which it leads to no
    contour (see `trace`), so that the ring is a hole.
    """
    if drawn.kind != "ring" or setup.sheet.bare_rings:
        return drawn.place_mm
    line = followed_from_an_end(setup, contour.stroke, contour.number)
    return line.reference_mm if line is not None else None


def _kind(by_ends: Kind, loops: int) -> Kind:
    """What a patch is by its ends and by how many areas it goes round."""
    if by_ends == "dot":
        return "dot"
    if loops == 0 and by_ends != "several":
        return "open"
    return "closed" if loops == 1 and by_ends == "closed" else "several"


def _can_begin(setup: Setup, contour: Contour, view: View, starts_mm: list[Place]) -> bool:
    """Whether the head can be put down on a patch; asked as a run asks where the first looks find nothing."""
    for start_mm in starts_mm[:FIRST_LOOKS]:
        if stands_near(view, contour.stroke, start_mm):
            return True
    for start_mm in starts_mm:
        try:
            next(put_down(setup.sheet, start_mm, setup.settings))
        except LineFault:
            continue
        return True
    return followed_from_an_end(setup, contour.stroke, contour.number) is not None


def _with_references(seen: list[Entry], contours: list[Contour]) -> Iterator[Entry]:
    """The entries; those are marked that are the reference point from which another begins."""
    places_mm = [entry.reference_mm for entry in seen if entry.reference_mm is not None]
    middles_mm = {contour.number: contour.stroke.middles_mm for contour in contours}
    for entry in seen:
        own = selection.are_about(middles_mm[entry.number], places_mm)
        yield replace(entry, is_reference=own and entry.is_small)


def _around(patch: int, enclosure: Enclosure, entries: dict[int, Entry]) -> int | None:
    """The number of the nearest line round a patch."""
    patch = int(enclosure.inside[patch])
    while patch != NONE and patch not in entries:
        patch = int(enclosure.inside[patch])
    return entries[patch].number if patch != NONE else None
