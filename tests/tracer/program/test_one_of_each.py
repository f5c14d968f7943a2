"""One line of each patch: which is the line, the run from an open end or the run round about."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.marks import reference
from morfax.tracer.program import one_of_each
from morfax.tracer.program.head_runs import followed_from_an_end
from morfax.tracer.program.lines import selection
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import arc, inked, polyline

SHEET = Sheet.of(inked(arc((16, 16), 10)))


def line(ending: str, length_mm: float, ink_mm: float = 100.0, y_mm: float = 0.0) -> Line:
    """A line along X, as it might have ended."""
    places = np.column_stack([np.linspace(0, length_mm, 50), np.full(50, y_mm)])
    return Line(places, ending, 0.5, length_mm, ink_mm=ink_mm)


@pytest.mark.parametrize(
    ("from_end", "round_about", "taken"),
    [
        # an end that is no end led round a part of the ink
        (line("joined", 40), line("closed", 95), "round"),
        # a stem that leads to a small loop
        (line("joined", 40), line("closed", 30), "end"),
        (line("joined", 40), line("joined", 95), "end"),
        # a stem, and the loop that it leads to
        (line("joined", 70, y_mm=2.0), line("closed", 95), "end"),
        # a tip in which two sides of the loop meet
        (line("joined", 70), line("closed", 70), "round"),
        (line("ended", 40), line("closed", 95), "end"),
        (None, line("closed", 95), "round"),
    ],
)
def test_a_line_from_an_end_that_leads_round_little_of_the_ink_gives_way(
    monkeypatch: pytest.MonkeyPatch, from_end: Line | None, round_about: Line, taken: str
) -> None:
    monkeypatch.setattr(one_of_each, "followed_from_an_end", lambda *_: from_end)
    monkeypatch.setattr(one_of_each, "followed", lambda *_, **__: round_about)
    asked, _ = selection.plan(SHEET, (1,))
    (found,), unclear, _ = one_of_each.one_of_each(Setup(SHEET), asked, (1,))
    assert found is (from_end if taken == "end" else round_about) and not unclear


def test_a_tip_in_which_two_sides_meet_begins_no_lead_line() -> None:
    """A wedge of 9 degrees, 14 mm long: its tip looks like an open end."""
    wedge = np.array([(0, 0), (2.2, 0), (1.1, 14.0), (0, 0)])
    c, s = math.cos(1.2), math.sin(1.2)
    turned = wedge @ np.array([[c, s], [-s, c]])
    places = [(x, y) for x, y in (turned - turned.min(axis=0) + 4).tolist()]
    sheet = Sheet.of(inked(polyline(*places), width_mm=0.3, dpi=600, seed=1))
    asked, _ = selection.plan(sheet, "contours")
    (found,), _, _ = one_of_each.one_of_each(Setup(sheet), asked, "contours")
    assert found.ending == "closed" and not found.is_lead


@pytest.mark.parametrize(("apart_mm", "felt"), [(9.2, 0), (8.0, 2)])
def test_a_hole_s_neighbours_are_felt_as_reference_points_only_within_reach_of_a_lead_line(
    monkeypatch: pytest.MonkeyPatch, apart_mm: float, felt: int
) -> None:
    """Holes of 6 mm: a lead line of a ring begins 1.8 mm off it at the most, and is felt for 1.2 mm; if
    no ink is so near, no ring is felt, nor the hole's own."""
    setup = Setup(Sheet.of(inked(arc((10, 10), 3), arc((10 + apart_mm, 10), 3))))
    places = list[np.ndarray]()
    monkeypatch.setattr(reference, "_ring", lambda view, place: places.append(place))
    asked, _ = selection.plan(setup.sheet, "contours")
    assert followed_from_an_end(setup, asked[0].stroke, asked[0].number) is None
    assert len({tuple(np.round(place, 1)) for place in places}) == felt


def test_reference_points_of_lines_are_those_that_they_or_their_leads_begin_at() -> None:
    plain, led = line("closed", 40), replace(line("closed", 40), reference_mm=(1.0, 2.0))
    assert one_of_each.references_of([plain, led]) == [led.begin_mm]


@pytest.mark.parametrize(
    ("came_mm", "ending", "times"),
    [
        (24.0, "ended", 1),  # across a gap, into what the cells of the window see
        (24.0, "lost", 1),
        (65.0, "ended", 2),
    ],
)
def test_a_patch_is_followed_on_all_of_a_sheet_only_if_the_head_came_far_off_it(
    monkeypatch: pytest.MonkeyPatch, came_mm: float, ending: str, times: int
) -> None:
    sheet = Sheet.of(
        inked(polyline((4, 4), (16, 4)), polyline((150, 200), (200, 200)), dpi=100)
    )
    (_, contour), _ = selection.plan(sheet, "contours")
    windows = list[object]()

    def follow(setup: Setup, contour: selection.Contour, is_letter: bool) -> object:
        windows.append(setup.sheet.window)
        places = np.column_stack([np.linspace(4, came_mm, 50), np.full(50, 4.0)])
        setup.runs._low_mm, setup.runs._high_mm = places[0], places[-1]
        return one_of_each._Found(Line(places, ending, 0.5, came_mm))

    monkeypatch.setattr(one_of_each, "_follow", follow)
    setup = Setup(sheet)
    about = one_of_each._about(setup, contour)
    one_of_each._follow_in_window(setup, about, contour, False)
    assert len(windows) == times and windows[0] is not None
    assert times == 1 or windows[-1] is None


def test_of_a_sheet_no_more_is_seen_about_a_hole_than_what_may_lead_onto_it() -> None:
    """A hole alone, and one with another beside it."""
    drawn = [arc((x, 20), 3.0) for x in (20, 60, 68, 150)]
    sheet, around_mm = Sheet.of(inked(*drawn, arc((90, 60), 3.0), dpi=150)), list[float]()
    for place in (drawn[0][0], drawn[1][0]):
        patch = sheet.patch_at(place)
        top = sheet.patches.boxes[patch][0]
        contour = selection.Contour(1, sheet.stroke(patch), 6.0)
        window = one_of_each._about(Setup(sheet), contour).sheet.window
        assert window is not None
        around_mm.append((top - window[0]) * sheet.drawing.pitch_mm)
    alone_mm, beside_mm = around_mm
    assert beside_mm - alone_mm == pytest.approx(15.0 - 2.75, abs=0.5)


def test_the_outline_of_a_net_whose_ends_lead_to_ends_is_run_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """From an end of the chord the head would only come to its other end."""
    monkeypatch.setattr(
        one_of_each, "_follow_in_window", lambda *_: pytest.fail("the head runs")
    )
    plate = polyline((4, 4), (34, 4), (34, 20), (4, 20), (4, 4))
    sheet = Sheet.of(inked(plate, polyline((1, 9), (37, 14))))
    asked, _ = selection.plan(sheet, "contours")
    found = one_of_each.one_of_each(Setup(sheet), asked, "contours")
    (outline,) = found.lines
    assert outline.ending == "closed" and outline.length_mm == pytest.approx(92, abs=0.5)
    assert [each.ending for each in found.others[outline.number]] == ["ended"]
