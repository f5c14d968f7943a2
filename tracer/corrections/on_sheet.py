"""Corrections laid on a sheet: every place in sheet mm, as the drawing and the head take them.

Signals: corrections with places on the picture, and the sheet's size in mm and pixels, in; strokes of rubber
and pen, turns, stops, start and reference point in sheet mm out.

    x_mm = column / columns · width_mm        y_mm = (1 - row / rows) · height_mm

with the columns and rows that the file of corrections states. So a place in pixels stays where it is when the
scale of the drawing is put right, when a reference point moves, and when the same sheet comes in more pixels
or fewer: a PDF rendered more finely, a photograph made flat anew. A place in mm is one of the sheet, as
--start takes it; it moves when the scale is changed.

A picture of another shape is another picture: its corrections are refused.

Source: our own. Questions: a sheet that was scanned again lies otherwise under the lid, and no shape tells:
only the sum of the file does, which is a warning, because saving a picture anew changes the sum too.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import CardFault

if TYPE_CHECKING:
    from morfax.tracer.corrections.corrections import (
        Correction,
        Corrections,
        Direction,
        Kind,
        Place,
        Span,
    )

RUBBER_MM = 2.0  # diameter of the rubber where no width is given: our own figure
SAME_SHAPE_PX = 2.0  # rounding of a rendered page, in the larger picture's pixels
# a turn or a stop is served by a junction or a line within this, or within these widths of the line
REACH_MM, REACH_WIDTHS = 2.0, 3.0

PlaceMm = tuple[float, float]


@dataclass(frozen=True, slots=True)
class CorrectionStroke:
    """A stroke of the rubber or of the pen: places (n, 2) mm; its width, None for the line's own."""

    number: int
    do: Kind
    places_mm: Array
    width_mm: float | None


@dataclass(frozen=True, slots=True)
class TurnAt:
    """How the head goes through the junction at a place; only when it comes from a side, if one is given."""

    number: int
    do: Kind
    place_mm: PlaceMm
    coming_from_mm: PlaceMm | None = None

    def enlarged(self, times: float) -> TurnAt:
        """The same where the head sees the line so many times as large."""
        x, y = self.place_mm
        come = self.coming_from_mm
        from_mm = None if come is None else (times * come[0], times * come[1])
        return TurnAt(self.number, self.do, (times * x, times * y), from_mm)


@dataclass(frozen=True, slots=True)
class StopAt:
    """A stop or a drill point at a place, or none."""

    number: int
    do: Kind
    place_mm: PlaceMm


@dataclass(frozen=True, slots=True)
class OnSheet:
    """Corrections as they lie on a sheet; `ink_changed` has the numbers of those that changed its ink."""

    corrections: Corrections
    strokes: tuple[CorrectionStroke, ...] = ()
    turns: tuple[TurnAt, ...] = ()
    stops: tuple[StopAt, ...] = ()
    start_mm: PlaceMm | None = None
    direction: Direction | None = None
    reference_mm: PlaceMm | None = None
    ink_changed: frozenset[int] = field(default=frozenset())

    @property
    def fingerprint(self) -> str:
        """A short sum of what the corrections say: the same corrections have the same."""
        said = repr(
            [(o.do, o.at, o.width, o.coming_from, o.direction) for o in self.corrections.each]
        )
        return hashlib.sha256(said.encode()).hexdigest()[:12]

    def place_of(self, number: int) -> PlaceMm:
        """The place of a correction by its number, mm."""
        placed: dict[int, PlaceMm] = {s.number: _first(s.places_mm) for s in self.strokes}
        placed |= {turn.number: turn.place_mm for turn in self.turns}
        placed |= {stop.number: stop.place_mm for stop in self.stops}
        for kind, place_mm in (("start", self.start_mm), ("reference", self.reference_mm)):
            if self.corrections.each[number - 1].do == kind and place_mm is not None:
                return place_mm
        return placed[number]


@dataclass(frozen=True, slots=True)
class SheetSize:
    """A sheet as it was read: its size in mm, and in pixels of the picture."""

    width_mm: float
    height_mm: float
    columns: int
    rows: int

    def laid(self, corrections: Corrections) -> OnSheet:
        """Corrections on this sheet; raises CardFault if they belong to a picture of another shape, or one of
        them lies beside the sheet.
        """
        from morfax.tracer.corrections.corrections import INKED, STOPS, TURNS

        self._check_shape(corrections)
        each = [
            (n, one, self._places_mm(corrections, n, one))
            for n, one in enumerate(corrections.each, 1)
        ]
        starts = [(one, mm) for _, one, mm in each if one.do == "start"]
        references = [mm for _, one, mm in each if one.do == "reference"]
        return OnSheet(
            corrections,
            tuple(
                CorrectionStroke(n, one.do, mm, self._width_mm(corrections, one))
                for n, one, mm in each
                if one.do in INKED
            ),
            tuple(
                TurnAt(n, one.do, _first(mm), self._from_mm(corrections, n, one))
                for n, one, mm in each
                if one.do in TURNS
            ),
            tuple(StopAt(n, one.do, _first(mm)) for n, one, mm in each if one.do in STOPS),
            _first(starts[-1][1]) if starts else None,
            starts[-1][0].direction if starts else None,
            _first(references[-1]) if references else None,
        )

    def _check_shape(self, corrections: Corrections) -> None:
        """Raise CardFault for a picture of another shape."""
        of = corrections.picture
        if of is None:
            return
        rows = self.columns * of.rows / of.columns
        if abs(rows - self.rows) > SAME_SHAPE_PX * max(1.0, self.columns / of.columns):
            raise CardFault(
                f"{corrections.file or 'the file of corrections'} belongs to {of.name} of {of.columns} x"
                f" {of.rows} pixels, and the drawing has {self.columns} x {self.rows}: it is another"
                " picture; give the right file with --corrections, or leave it out with --no-corrections"
            )

    def _places_mm(self, corrections: Corrections, number: int, one: Correction) -> Array:
        """The places of a correction, (n, 2) mm; raises CardFault for one beside the sheet."""
        places_mm = np.array([self._mm(corrections, place) for place in one.at])
        inside = (places_mm >= 0) & (places_mm <= [self.width_mm, self.height_mm])
        if not inside.all():
            beside = one.at[int(np.argmin(inside.all(axis=1)))]
            raise CardFault(
                f"{corrections.file or 'the file of corrections'}: correction {number}, {one.do}, is at"
                f" {beside}, beside the sheet of {self.width_mm:.1f} x {self.height_mm:.1f} mm"
                f" ({self.columns} x {self.rows} pixels); give a place on it"
            )
        return places_mm

    def _from_mm(
        self, corrections: Corrections, number: int, one: Correction
    ) -> PlaceMm | None:
        """The side from which a head comes for whom a turn counts, mm."""
        return None if one.coming_from is None else self._mm(corrections, one.coming_from)

    def _mm(self, corrections: Corrections, place: Place) -> PlaceMm:
        """A place in sheet mm."""
        if place.unit == "mm":
            return place.x, place.y
        of = corrections.picture
        columns, rows = (self.columns, self.rows) if of is None else (of.columns, of.rows)
        return place.x / columns * self.width_mm, (1 - place.y / rows) * self.height_mm

    def _width_mm(self, corrections: Corrections, one: Correction) -> float | None:
        """The width of a stroke, mm; None for a pen as wide as the line."""
        if one.width is None:
            return RUBBER_MM if one.do == "rub" else None
        return self._span_mm(corrections, one.width)

    def _span_mm(self, corrections: Corrections, span: Span) -> float:
        """A length on the picture, mm."""
        if span.unit == "mm":
            return span.amount
        of = corrections.picture
        return span.amount * self.width_mm / (self.columns if of is None else of.columns)

    def in_pixels(self, place: Place) -> Place:
        """A place in pixels of this sheet's picture."""
        if place.unit == "px":
            return place
        from morfax.tracer.corrections.corrections import Place

        return Place(
            place.x / self.width_mm * self.columns, (1 - place.y / self.height_mm) * self.rows
        )

    def span_in_pixels(self, span: Span) -> Span:
        """A length in pixels of this sheet's picture."""
        from morfax.tracer.corrections.corrections import Span

        return span if span.unit == "px" else Span(span.amount / self.width_mm * self.columns)


def _first(places_mm: Array) -> PlaceMm:
    """The first place."""
    return float(places_mm[0, 0]), float(places_mm[0, 1])
