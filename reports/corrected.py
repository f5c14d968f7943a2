"""The operator's corrections in a picture: in a colour of their own, each with its number.

Signals in: corrections as they lie on a sheet. Out: marks for a plate, sheet mm.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.plane import left_of
from morfax.reports.looks import BELOW_PT, LINE_PT, NAMES, SPOT_PT, SPOTS, WORDS_PT
from morfax.reports.plate import Caption, Mark, Polyline, Spot, TintedArea

if TYPE_CHECKING:
    from morfax.tracer.corrections.on_sheet import CorrectionStroke, OnSheet, PlaceMm

COLOUR = "#d100b8"
TURNS = {"straight": "↑", "left": "↰", "right": "↱"}
STOPS = {"stop": "D", "drill": "o", "not-stop": "X"}
POINTS = {"start": "P", "reference": "*"}
TURN_RAD = np.linspace(0, 2 * np.pi, 24)
ROUND = np.column_stack([np.cos(TURN_RAD), np.sin(TURN_RAD)])  # the end of a rubber
RUBBED_ALPHA = 0.18  # what was rubbed out lets the paper shine through


def marks(laid: OnSheet) -> list[Mark]:
    """All corrections of a sheet."""
    drawn = list[Mark]()
    for stroke in laid.strokes:
        first = (float(stroke.places_mm[0, 0]), float(stroke.places_mm[0, 1]))
        drawn += [*_stroke(stroke), _number(stroke.number, first)]
    for turn in laid.turns:
        drawn += [
            Caption(turn.place_mm, TURNS[turn.do], 2 * SPOT_PT, COLOUR, centred=True),
            _number(turn.number, turn.place_mm),
        ]
    for stop in laid.stops:
        drawn += [_spot(STOPS[stop.do], stop.place_mm), _number(stop.number, stop.place_mm)]
    for number, one in laid.corrections.of("start", "reference"):
        place_mm = laid.start_mm if one.do == "start" else laid.reference_mm
        if place_mm is not None:
            drawn += [_spot(POINTS[one.do], place_mm), _number(number, place_mm)]
    return drawn


def _stroke(stroke: CorrectionStroke) -> list[Mark]:
    """A stroke of the rubber as areas, one of the pen as a line."""
    places_mm = stroke.places_mm
    if stroke.do == "bridge" and len(places_mm) > 1:
        return [Polyline(places_mm, COLOUR, LINE_PT, dash=(2, 1), order=SPOTS)]
    if stroke.do == "rub-area":
        return [_rubbed(places_mm)]
    half_mm = 0.5 * (stroke.width_mm or 1.0)
    drawn: list[Mark] = [
        _rubbed(place_mm + half_mm * ROUND)
        for place_mm in places_mm[:: max(1, len(places_mm) // 200)]
    ]
    for begin, end in pairwise(places_mm):
        along = (end - begin) / max(float(np.hypot(*(end - begin))), NOT_ZERO)
        left = half_mm * left_of(along)
        drawn.append(_rubbed(np.array([begin + left, end + left, end - left, begin - left])))
    return drawn


def _rubbed(corners_mm: Array) -> TintedArea:
    """An area that was rubbed out."""
    return TintedArea(corners_mm, COLOUR, RUBBED_ALPHA, edged=True, order=1)


def _spot(shape: str, place_mm: PlaceMm) -> Spot:
    """A place."""
    return Spot(place_mm, shape, SPOT_PT, COLOUR, order=NAMES)


def _number(number: int, place_mm: PlaceMm) -> Caption:
    """The number of a correction beside its place."""
    return Caption(place_mm, f"c{number}", WORDS_PT, COLOUR, BELOW_PT)
