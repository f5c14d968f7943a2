"""Chains of corners: teeth with sides of a width or two have all their corners where they were drawn."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.polyline import nearest_mm, with_places
from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.own_ink import NEARLY, OwnInk
from morfax.tracer.program.laid import cut_corners
from morfax.tracer.program.laid.corner_chains import (
    _along,
    _Chains,
    _Corner,
    _News,
    with_chains,
)
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace import trace
from tests.tracer.inked import UM, inked, polyline
from tests.tracer.program.laid.ways import turned

PEN_MM = 0.7
# a third of a pixel of 0.127 mm, at 200 dpi, and half of one at 300: the head alone is 60 to 190 um off
OFF_MM = 40 * UM


def teeth(tip_mm: float, root_mm: float, high_mm: float, lean_mm: float) -> Array:
    """A row of eight teeth, (n, 2) mm."""
    pitch_mm = tip_mm + root_mm + 2 * lean_mm
    across = np.array([0.0, lean_mm, lean_mm + tip_mm, 2 * lean_mm + tip_mm])
    along = (np.arange(8)[:, None] * pitch_mm + across).ravel()
    row = np.column_stack([along, np.tile([0.0, high_mm, high_mm, 0.0], 8)])
    return np.vstack([[-4, 0], row, [8 * pitch_mm, 0], [8 * pitch_mm + 4, 0]])


def bar(row: Array) -> Array:
    """A bar with a row of teeth along one side, closed."""
    return np.vstack([row, [row[-1] - [0, 5], row[0] - [0, 5], row[0]]])


def drawn_at(places: Array, by_rad: float) -> Array:
    """A line over some corners (n, 2) mm, turned, on a sheet."""
    return polyline(*map(tuple, turned(places, by_rad)))


def furthest_mm(drawn: Array, line: Line) -> float:
    """How far a line and the drawn one lie apart, at most."""
    truth = with_places(drawn, 0.01)
    off = nearest_mm(truth, line.places_mm).max(), nearest_mm(line.places_mm, truth).max()
    return float(max(off))


BROAD, NARROW, SHORT = (0.8, 0.8, 1.6, 0.3), (0.5, 0.9, 1.5, 0.4), (0.7, 1.0, 1.6, 0.4)


@pytest.mark.parametrize(
    ("sizes_mm", "dpi", "turned_rad"),
    [(SHORT, 200, 1.1), (BROAD, 300, 1.1), (NARROW, 400, 2.0)],
)
def test_a_closed_line_has_all_corners_of_its_teeth(
    sizes_mm: tuple[float, float, float, float], dpi: float, turned_rad: float
) -> None:
    drawn = drawn_at(bar(teeth(*sizes_mm)), turned_rad)
    (line,) = trace(inked(drawn, width_mm=PEN_MM, dpi=dpi, seed=3)).lines
    assert line.ending == "closed"
    assert furthest_mm(drawn, line) < OFF_MM


def test_an_open_line_has_all_corners_of_its_teeth() -> None:
    drawn = drawn_at(teeth(*SHORT), 2.0)
    (line,) = trace(inked(drawn, width_mm=PEN_MM, dpi=200, seed=3)).lines
    assert line.ending == "ended"
    assert furthest_mm(drawn, line) < OFF_MM


def test_tips_that_were_drawn_round_stay_round() -> None:
    """Each tip is half a circle of 0.7 mm: a corner there would be 0.29 mm off."""
    up = np.linspace(np.pi, 0.0, 60)
    tip = np.column_stack([0.7 + 0.7 * np.cos(up), 1.2 + 0.7 * np.sin(up)])
    tooth = np.vstack([[0, 0], tip, [1.4, 0]])
    row = np.vstack([tooth + np.array([2.6 * k, 0]) for k in range(8)])
    drawn = drawn_at(bar(np.vstack([[-4, 0], row, [24, 0]])), 0.3)
    (line,) = trace(inked(drawn, width_mm=PEN_MM, dpi=300, seed=3)).lines
    assert line.ending == "closed"
    assert furthest_mm(drawn, line) < 60 * UM  # two thirds of a pixel


def test_a_line_on_its_ink_stays_as_the_head_ran() -> None:
    drawn = drawn_at(bar(teeth(3.0, 3.0, 4.0, 1.0)), 0.3)
    drawing = inked(drawn, seed=3)
    own = OwnInk(drawing, trace(drawing).lines)
    assert with_chains(Setup(drawing.sheet), own) is own


def test_only_chains_near_to_what_was_laid_anew_are_looked_at_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Along an outline of a coast 20 chains were fitted anew for each that was laid."""
    drawn = drawn_at(bar(teeth(*SHORT)), 1.1)
    drawing = inked(drawn, width_mm=PEN_MM, dpi=200, seed=3)
    given = list[tuple[Setup, OwnInk]]()

    def kept(setup: Setup, own: OwnInk, *laid_mm: Array) -> OwnInk:
        given.append((setup, own))
        return with_chains(setup, own, *laid_mm)

    monkeypatch.setattr(cut_corners, "with_chains", kept)
    trace(drawing)
    setup, own = given[0]
    (before,) = own.lines
    (mended,) = with_chains(setup, own).lines
    assert furthest_mm(drawn, mended) < furthest_mm(drawn, before)
    # looked at again where it was laid, and where it was not beside its ink when it was last looked at
    left_mm = np.array([place.place_mm for place in own.beside(NEARLY)])
    far_mm = before.loop_mm.min(axis=0)[None] - 100.0
    every = BoxedLines.of(own.lines)
    for laid_mm, told_mm, is_laid in (
        (far_mm, left_mm, False),
        (before.loop_mm[::40], left_mm, True),
        (far_mm, far_mm, True),
    ):
        news = _News(laid_mm, told_mm)
        relaid = _Chains(setup, before, every, left_mm, news).mended()
        assert (relaid.line is not before) is is_laid


def test_a_chain_runs_through_its_sharp_corners_and_rounds_the_others_by_their_radius() -> None:
    """A round of radius r at a right angle is r (sqrt 2 - 1) off the corner."""
    places, radius_mm = np.array([[4.0, 0.0], [4.0, 3.0], [8.0, 3.0]]), 0.5
    radii = 0.0, radius_mm, 0.0
    run = [_Corner(0, 0, 0, place, radius) for place, radius in zip(places, radii, strict=True)]
    way = _along(run, (np.zeros(2), np.array([8.0, 6.0])), 0.25).way
    off_mm = nearest_mm(places, with_places(way, 0.01))
    assert off_mm == pytest.approx([0.0, radius_mm * (2**0.5 - 1), 0.0], abs=1 * UM)
