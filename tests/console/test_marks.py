"""The drawing as the program, by the command line's behaviour: reference point, turns, stops, overrides, the
operator at a terminal.
"""

from __future__ import annotations

import re
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.console.terminal import attended
from morfax.motion.pathfile import read_path
from morfax.tracer.following.line import Line
from morfax.tracer.program.program import Trace
from tests.console.conftest import SAMPLES, Answer, Morfax

PROGRAM = SAMPLES / "program.png"
CARD = ("--card", SAMPLES / "program.toml")
REFERENCE_MM = (8.5, 23.0)
TICK_MM, HOLE_MM, BESIDE_MM = (21.5, 23.0), (48.5, 27.0), (70.5, 21.0)
WITHIN_MM = 0.05  # the issue's
THINNED_MM = 0.0005  # a path file holds 0.2 um


def traced(morfax: Morfax, *options: object) -> Answer:
    answer = morfax(
        "trace", PROGRAM, "-o", "program.csv", "--force", "--json", "--quiet", *options
    )
    assert answer.exit_code == 0, answer.err
    return answer


def places(answer: Answer) -> list[tuple[float, float]]:
    return [tuple(stop["stop_place_mm"]) for stop in answer.figures.get("stops", [])]


def test_the_sample_program_is_one_path_with_its_stops(morfax: Morfax, here: Path) -> None:
    answer = traced(morfax, *CARD)
    assert answer.figures["reference_place_mm"] == pytest.approx(REFERENCE_MM, abs=WITHIN_MM)
    assert [stop["mark"] for stop in answer.figures["stops"]] == ["tick", "hole", "tick"]
    for found, truth in zip(places(answer), (TICK_MM, HOLE_MM, BESIDE_MM), strict=True):
        assert found == pytest.approx(truth, abs=WITHIN_MM)
    path = read_path("program.csv")
    assert path.xy_mm[0] == pytest.approx(REFERENCE_MM, abs=WITHIN_MM)
    assert path.xy_mm[-1] == pytest.approx(path.xy_mm[0], abs=0.001)
    assert path.positions_mm[:, 2].min() == pytest.approx(-8.0, abs=THINNED_MM)  # the hole
    moving_z = np.diff(path.positions_mm[:, 2]) != 0
    assert (
        np.abs(np.diff(path.xy_mm, axis=0)[moving_z]).max() < THINNED_MM
    )  # X and Y stand while Z moves


def test_where_z_goes_at_a_stop_is_told_in_numbers(morfax: Morfax, here: Path) -> None:
    down, hole, stand = (stop["z_mm"] for stop in traced(morfax, *CARD).figures["stops"])
    assert (down, stand) == ([-5.0], [-5.0])
    assert min(hole) == -8.0 and hole[-1] > 0
    answer = morfax("trace", PROGRAM, "-o", "program.csv", "--force")
    assert "-5 mm" in answer.out


def test_without_a_card_guide_lines_are_passed_by(morfax: Morfax, here: Path) -> None:
    assert [stop["mark"] for stop in traced(morfax).figures["stops"]] == ["tick", "tick"]


def test_override_passes_marks_by(morfax: Morfax, here: Path) -> None:
    assert len(places(traced(morfax, "--stop-override", "2"))) == 1
    assert places(traced(morfax, "--stop-override", "all")) == []


def test_ticks_without_a_reference_point_stop_nothing_until_they_are_called_marks(
    morfax: Morfax, here: Path
) -> None:
    sheet = np.full((500, 500), 255, np.uint8)
    cv2.circle(sheet, (250, 250), 150, 0, 6)
    cv2.line(sheet, (380, 250), (420, 250), 0, 6)
    Image.fromarray(sheet).save("plate.png", dpi=(300, 300))
    plain = morfax("trace", "plate.png", "-o", "plate.csv", "--json")
    assert places(plain) == [] and "1 tick or dot did not stop the head" in plain.err
    assert "--marks on" in plain.err
    marked = morfax("trace", "plate.png", "-o", "marked.csv", "--json", "--marks", "on")
    assert [stop["mark"] for stop in marked.figures["stops"]] == ["tick"]
    assert "did not stop" not in marked.err


def test_marks_of_a_drawn_program_may_be_taken_for_ink(morfax: Morfax, here: Path) -> None:
    assert places(traced(morfax, "--marks", "off")) == []


def test_a_stop_that_is_not_there_is_told_of(morfax: Morfax, here: Path) -> None:
    answer = morfax("trace", PROGRAM, "-o", "program.csv", "--stop-override", "2,7")
    assert answer.exit_code == 0 and "the drawing has no stop 7: 2 were found" in answer.err


def test_a_turn_at_a_junction_that_is_not_there_is_told_of(morfax: Morfax, here: Path) -> None:
    Path("card.toml").write_text(
        'turns = ["left", "right", "straight", "left", "straight", "right"]\n'
    )
    answer = morfax("trace", PROGRAM, "-o", "program.csv", "--card", "card.toml")
    junctions = answer.out.count("junction ")
    assert answer.exit_code == 0 and junctions < 4
    assert (
        f"there is no junction 4 (left), 6 (right) to turn at: the head came to {junctions}"
        in answer.err
    )


@pytest.mark.parametrize("round_about", ["left", "right"])
def test_a_turn_to_a_side_to_which_no_line_leads_is_told_of(
    morfax: Morfax, here: Path, round_about: str
) -> None:
    """The guide line leads off inward: to the right of the way round clockwise, for which the head turns left
    from the lead line.
    """
    inward = "left" if round_about == "right" else "right"
    Path("in.toml").write_text(f'turns = ["{round_about}", "{inward}"]\n')
    assert (
        "no line leads off"
        not in morfax("trace", PROGRAM, "-o", "in.csv", "--card", "in.toml").err
    )
    Path("out.toml").write_text(f'turns = ["{round_about}", "{round_about}"]\n')
    answer = morfax("trace", PROGRAM, "-o", "out.csv", "--card", "out.toml")
    assert (
        answer.exit_code == 0
        and f"no line leads off to the {round_about} at junction 2 of the line" in answer.err
    )


@pytest.mark.parametrize("stops", ["0", "-1", "two", "1,", "1.5"])
def test_stops_are_numbered_from_1(morfax: Morfax, here: Path, stops: str) -> None:
    answer = morfax("trace", PROGRAM, "-o", "program.csv", f"--stop-override={stops}")
    assert answer.exit_code == 2 and f"{stops!r} names no stops" in answer.err


def test_junctions_of_several_lines_are_counted_on_each_as_the_card_turns(
    morfax: Morfax, here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The head takes the card's turns on each line from the first on."""
    xy_mm, places_mm = np.zeros((6000, 2)), ((1.0, 2.0), (3.0, 4.0))
    lines = tuple(
        Line(xy_mm, "closed", 0.5, 9.0, number=n, junctions_mm=places_mm) for n in (2, 1)
    )
    monkeypatch.setattr(
        "morfax.tracer.program.trace_lines.trace_lines", lambda *_, **__: Trace(lines)
    )
    rows = morfax(
        "trace", PROGRAM, "-o", "program.csv", "--lines", "contours", "--json"
    ).figures["junctions"]
    assert [(row["of_line"], row["junction"]) for row in rows] == [
        (2, 1),
        (2, 2),
        (1, 1),
        (1, 2),
    ]


def test_zero_reference_puts_the_zero_there(morfax: Morfax, here: Path) -> None:
    traced(morfax, "--zero", "reference")
    assert read_path("program.csv").xy_mm[0] == pytest.approx((0, 0), abs=0.001)


def test_a_reference_point_may_be_named(morfax: Morfax, here: Path) -> None:
    answer = traced(morfax, "--reference-point", "8,23.5")
    assert answer.figures["reference_place_mm"] == pytest.approx((8.0, 23.5))


def test_a_named_reference_point_that_no_line_begins_at_is_told_of(
    morfax: Morfax, here: Path
) -> None:
    """The drawn one is taken then, and never a guide line for the lead line."""
    answer = morfax(
        "trace", PROGRAM, "-o", "program.csv", "--json", "--reference-point", "5,55"
    )
    assert answer.figures["reference_place_mm"] == pytest.approx(REFERENCE_MM, abs=WITHIN_MM)
    assert (
        "no line begins within 11 mm of the reference point 5,55 mm: the program does not begin there"
        in answer.err
    )


def test_a_stem_that_nothing_makes_a_lead_line_is_told_to_be_cut(
    morfax: Morfax, here: Path
) -> None:
    grey = np.full((300, 600), 240, np.uint8)
    cv2.circle(grey, (430, 150), 100, 30, 6, cv2.LINE_AA)
    cv2.line(grey, (60, 150), (330, 150), 30, 6, cv2.LINE_AA)
    Image.fromarray(grey).save("stem.png", dpi=(300, 300))
    answer = morfax("trace", "stem.png", "-o", "stem.csv", "--json")
    assert re.search(
        r"the line from 5.1,12.7 to the contour at 2[78][.0-9]+,12.7 mm is cut too", answer.err
    )
    told = morfax(
        "trace", "stem.png", "-o", "stem.csv", "--json", "--reference-point", "3,12.7"
    )
    assert "is cut too" not in told.err and told.figures["reference_place_mm"] == [3.0, 12.7]


def test_a_lead_line_that_goes_on_beyond_the_contour_is_told_to_be_a_guide_line(
    morfax: Morfax, here: Path
) -> None:
    grey = np.full((300, 600), 240, np.uint8)
    cv2.circle(grey, (430, 150), 100, 30, 6, cv2.LINE_AA)
    for end in ((360, 150), (80, 150)):
        cv2.line(grey, (40, 150), end, 30, 6, cv2.LINE_AA)
    cv2.line(grey, (60, 125), (60, 175), 30, 6, cv2.LINE_AA)
    Image.fromarray(grey).save("beyond.png", dpi=(300, 300))
    answer = morfax("trace", "beyond.png", "-o", "beyond.csv", "--lines", "contours")
    assert re.search(
        r"reference point 5.1,12.7 crosses another and ends at 30.\d,12.7 mm: it is taken for a guide",
        answer.err,
    )


@pytest.mark.parametrize(
    ("direction", "positive"), [("cw", False), ("ccw", True), ("left", False), ("right", True)]
)
def test_the_loop_is_taken_as_asked(
    morfax: Morfax, here: Path, direction: str, positive: bool
) -> None:
    traced(morfax, "--direction", direction)
    path = read_path("program.csv")
    x, y = path.xy_mm[path.tool].T
    assert (np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) > 0) == positive


def test_ask_needs_a_terminal(morfax: Morfax, here: Path) -> None:
    answer = morfax("trace", PROGRAM, "-o", "program.csv", "--ask")
    assert (
        answer.exit_code == 2
        and "--ask needs a terminal" in answer.err
        and not list(here.iterdir())
    )


def test_at_a_terminal_every_stop_is_asked_for(
    morfax: Morfax, here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = iter(["down 3mm 2mm/s", "sideways 2mm", "dwell 1s", "", ""])
    monkeypatch.setattr(attended, "at_terminal", lambda: True)
    monkeypatch.setattr("click.prompt", lambda *words, **options: next(answers))
    answer = morfax("trace", PROGRAM, "-o", "program.csv", "--ask")
    assert (
        answer.exit_code == 0
        and "stop 1 (tick) at 21.5" in answer.err
        and "'sideways 2mm' cannot be set" in answer.err
    )
    assert (
        "or nothing: to Z -5 mm" in answer.err and "or nothing: dwell 500 ms" in answer.err
    )  # at the lead line's tick
    path = read_path("program.csv")
    assert path.positions_mm[:, 2].min() == pytest.approx(
        -1.0, abs=THINNED_MM
    )  # 3 mm down from 2 mm above
    assert next(answers, None) is None  # and no more was asked


def test_an_answer_that_the_counters_cannot_show_is_asked_for_again(
    morfax: Morfax, here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = iter(["up 999.99mm", "up 1mm", "", ""])
    monkeypatch.setattr(attended, "at_terminal", lambda: True)
    monkeypatch.setattr("click.prompt", lambda *words, **options: next(answers))
    answer = morfax("trace", PROGRAM, "-o", "program.csv", "--ask")
    assert answer.exit_code == 0 and next(answers, None) is None
    assert (
        "'up 999.99mm' cannot be set" in answer.err
        and "the counters cannot show 1001.99 mm" in answer.err
    )


def test_a_card_may_wait_for_the_button(
    morfax: Morfax, here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path("part.toml").write_text('restart = "manual"\n')
    refused = morfax("trace", PROGRAM, "-o", "program.csv", "--card", "part.toml")
    assert refused.exit_code == 9 and "there is no terminal" in refused.fault
    pressed: list[str] = []
    monkeypatch.setattr(attended, "at_terminal", lambda: True)
    monkeypatch.setattr("click.prompt", lambda text, **options: pressed.append(text) or "")
    assert morfax("trace", PROGRAM, "-o", "program.csv", "--card", "part.toml").exit_code == 0
    assert len(pressed) == 2 and all("press Enter" in text for text in pressed)
