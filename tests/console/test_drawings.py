"""trace and run by their behaviour, and what they say of drawings that cannot be traced."""

from __future__ import annotations

import math
import re
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.console.options.tracing import DEFAULTS
from morfax.console.verbs.trace import command
from morfax.jobs.settings.settings import TraceSettings
from morfax.motion.contour import distance
from morfax.motion.pathfile import read_path
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Work
from tests.console.conftest import SAMPLES, Morfax

UM = 1e-3
CAM = SAMPLES / "cam.png"
TRACED_WITHIN_MM = 25 * UM  # what the issue allows at any place of a smooth line
PLAYED_WITHIN_MM = 3 * UM
CLOSED_WITHIN_MM = 20 * UM
DPI = (300.0, 300.0)


def test_a_drawing_becomes_a_tape_and_the_tape_the_drawn_contour(
    morfax: Morfax, here: Path
) -> None:
    traced = morfax("trace", CAM, "--path", "traced.csv", "--json")
    assert (
        traced.exit_code == 0
        and traced.figures["ending"] == "closed"
        and traced.figures["tape"] == "cam.wav"
    )
    assert morfax("play", "cam.wav", "-o", "played.csv").exit_code == 0
    path, played, truth = (
        read_path("traced.csv"),
        read_path("played.csv"),
        read_path(SAMPLES / "cam.csv"),
    )
    assert distance(path, truth).hausdorff_mm < TRACED_WITHIN_MM
    assert distance(played, path).hausdorff_mm < PLAYED_WITHIN_MM
    assert all(math.dist(way[0], way[-1]) < CLOSED_WITHIN_MM for way in path.runs())
    answer = morfax(
        "compare", CAM, "cam.wav", "--tolerance", "25um", "--picture", "error.png", "--json"
    )
    assert answer.exit_code == 0 and answer.figures["missed_ink_share"] < 0.01
    assert answer.figures["path_to_ink"]["rms_mm"] < 4 * UM
    assert (here / "error.png").exists()


def test_a_gap_too_wide_to_cross_is_told_with_the_option_that_crosses_it(
    morfax: Morfax, here: Path, small: np.ndarray
) -> None:
    grey = small.copy()
    grey[:120, 150:164] = 240  # 1.2 mm
    Image.fromarray(grey).save("ring.png", dpi=DPI)
    answer = morfax("trace", "ring.png", "-o", "ring.csv", "--json")
    assert answer.exit_code == 0 and answer.figures["ending"] == "ended"
    said = re.search(
        r"the line is open, but ends .* --gap ([0-9.]+mm) takes the head across", answer.err
    )
    assert said is not None
    closed = morfax("trace", "ring.png", "-o", "ring.csv", "--json", "--gap", said[1])
    assert closed.figures["ending"] == "closed" and "is open" not in closed.err


def test_the_first_dash_of_a_dashed_line_is_told_to_be_one_with_the_option_that_goes_on(
    morfax: Morfax, here: Path
) -> None:
    grey = np.full((120, 700), 240, np.uint8)
    for left in range(60, 640, 60):
        grey[57:64, left : left + 44] = 30  # 3.7 mm, and 1.35 mm of paper
    Image.fromarray(grey).save("dashes.png", dpi=DPI)
    answer = morfax("trace", "dashes.png", "-o", "dashes.csv", "--json")
    said = re.search(
        r"the line ends at .* goes on straight ahead .* --gap ([0-9.]+mm) takes the head across",
        answer.err,
    )
    assert answer.exit_code == 0 and said is not None and answer.figures["length_mm"] < 4
    whole = morfax("trace", "dashes.png", "-o", "dashes.csv", "--json", "--gap", said[1])
    assert (
        whole.figures["length_mm"] == pytest.approx((584 - 7) * 25.4 / 300, abs=0.1)
        and "ends at" not in whole.err
    )


def test_no_gap_is_gone_across_if_none_is_allowed(
    morfax: Morfax, here: Path, small: np.ndarray
) -> None:
    grey = small.copy()
    grey[:120, 150:157] = 240  # 0.6 mm
    Image.fromarray(grey).save("ring.png", dpi=DPI)
    for gap, ending in (("0.7mm", "closed"), ("0", "ended")):
        assert (
            morfax("trace", "ring.png", "-o", "ring.csv", "--json", "--gap", gap).figures[
                "ending"
            ]
            == ending
        )


def test_one_line_of_several_that_cross_is_told_to_be_one_of_several(
    morfax: Morfax, here: Path
) -> None:
    grey = np.full((400, 700), 240, np.uint8)
    for x in (200, 350, 500):
        cv2.circle(grey, (x, 200), 120, 30, 6, cv2.LINE_AA)
    Image.fromarray(grey).save("rings.png", dpi=DPI)
    one = morfax("trace", "rings.png", "-o", "rings.csv")
    said = re.search(
        r"about (\d+) mm of ink that is joined to the line was not followed: --lines all",
        one.err,
    )
    assert said is not None and int(said[1]) == pytest.approx(2 * 2 * np.pi * 10.2, rel=0.1)
    every = morfax("trace", "rings.png", "-o", "rings.csv", "--lines", "contours", "--json")
    assert [line["ending"] for line in every.figures["lines"]] == [
        "closed"
    ] * 3 and every.err == ""


def test_run_goes_the_whole_way_and_tells_all_three(morfax: Morfax, here: Path) -> None:
    answer = morfax("run", SAMPLES / "gear.png", "-o", "results", "--json")
    assert answer.exit_code == 0
    rows = {"traced_to_ink", "played_to_ink", "played_to_traced", "traced_to_played"}
    assert rows <= answer.figures.keys()
    names = {"gear.wav", "gear.traced.csv", "gear.played.csv", "gear.png", "gear.json"}
    assert {file.name for file in (here / "results").iterdir()} == names
    assert (here / "results" / "gear.json").read_text() == answer.out


def test_a_start_with_no_line_near_it_says_how_far_the_nearest_is(
    morfax: Morfax, here: Path
) -> None:
    answer = morfax("trace", CAM, "--start", "45,45")
    assert answer.exit_code == 4 and "mm" in answer.fault
    assert list(here.iterdir()) == []
    assert morfax("trace", CAM, "--start", "45,45", "--picture", "sheet.png").exit_code == 4
    assert (here / "sheet.incomplete.png").exists()  # to read a place off
    assert morfax("run", CAM, "--start", "45,45", "-o", "results").exit_code == 4
    assert [file.name for file in (here / "results").iterdir()] == ["cam.incomplete.png"]


def test_a_lost_line_keeps_what_was_traced_marked_incomplete(
    morfax: Morfax, here: Path
) -> None:
    """A line into a bar as broad as ten lines, which is no line to follow."""
    grey = np.full((500, 1200), 255, np.uint8)
    cv2.line(grey, (50, 250), (1100, 250), 0, 6)
    cv2.rectangle(grey, (600, 230), (1190, 270), 0, -1)
    Image.fromarray(grey).save("bar.png", dpi=DPI)
    head = ("--start", "20,21", "--line-width", "0.5mm")
    answer = morfax(
        "trace", "bar.png", *head, "--path", "bar.csv", "--picture", "seen.png", "--json"
    )
    assert answer.exit_code == 4 and "heading" in answer.fault
    assert answer.figures["ending"] == "lost" and answer.figures["incomplete"] is True
    kept = {"bar.incomplete.wav", "bar.incomplete.csv", "seen.incomplete.png"}
    assert {file.name for file in here.iterdir()} == kept | {"bar.png"}
    assert np.ptp(read_path("bar.incomplete.csv").xy_mm[:, 0]) > 40
    assert morfax("play", "bar.incomplete.wav").exit_code == 0


def test_the_drawing_s_name_is_never_written_over(
    morfax: Morfax, here: Path, small: np.ndarray
) -> None:
    Image.fromarray(small).save("part.png", dpi=DPI)
    before = (here / "part.png").read_bytes()
    assert morfax("run", "part.png", "-o", ".").exit_code == 8
    assert morfax("trace", "part.png", "--picture", "part.png").exit_code == 8
    assert (here / "part.png").read_bytes() == before
    assert [file.name for file in here.iterdir()] == ["part.png"]


def test_the_defaults_that_the_help_states_are_those_of_the_tracer() -> None:
    """They are stated twice, since --help shall not wait for the tracer."""
    types = {option.name: option.type for option in command.params}
    stated = {name: types[name].convert(text, None, None) for name, text in DEFAULTS.items()}
    settings, work = Settings(), Work()
    assert stated == {
        "speed_mm_s": settings.speed_mm_s,
        "gap_mm": settings.gap_mm,
        "depth_mm": work.depth_mm,
        "clearance_mm": work.clearance_mm,
    }


def test_what_is_not_set_is_the_head_s_and_the_tool_s_own() -> None:
    unset = TraceSettings()
    assert unset.of_head() == Settings()
    assert unset.operator(unset.card(), None) == Operator()
