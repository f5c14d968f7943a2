"""trace and run by their behaviour, and what they say of drawings that cannot be traced."""

from __future__ import annotations

import math
import re
import struct
import zlib
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
from morfax.tracer.drawing import components as patches
from morfax.tracer.drawing import memory as room
from morfax.tracer.drawing.components import Patches, runs_of
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet
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


@pytest.fixture(scope="module")
def small() -> np.ndarray:
    """Grey values of a small drawing: a line of 0.5 mm round an ellipse of 19 x 14 mm."""
    grey = np.full((320, 320), 240, np.uint8)
    cv2.ellipse(grey, (160, 160), (110, 80), 20, 0, 360, 30, 6, cv2.LINE_AA)
    return grey


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
        "compare", CAM, "cam.wav", "--tolerance", "25um", "-o", "error.png", "--json"
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


def test_another_line_is_traced_from_its_start(morfax: Morfax, here: Path) -> None:
    """The bracket's slot, 8 x 30 mm, instead of its outline."""
    answer = morfax(
        "trace", SAMPLES / "bracket.png", "--start", "48,26", "-o", "slot.csv", "--json"
    )
    assert answer.exit_code == 0 and answer.figures["ending"] == "closed"
    assert answer.figures["length_mm"] == pytest.approx(2 * 22 + 8 * np.pi, rel=0.005)


def test_several_starts_are_one_program_the_slot_before_its_outline(
    morfax: Morfax, here: Path
) -> None:
    bracket = SAMPLES / "bracket.png"
    call = ("trace", bracket, "--start", "40,7", "--start", "48,26", "-o", "both.csv", "--json")
    answer = morfax(*call)
    assert answer.exit_code == 0 and answer.err == ""
    slot, outline = answer.figures["lines"]
    assert (slot["line"], outline["line"]) == (2, 1)
    assert slot["length_mm"] == pytest.approx(2 * 22 + 8 * np.pi, rel=0.005)
    assert len(read_path("both.csv").runs()) == 2
    call = ("trace", bracket, "--start", "50.5,26", "--start", "48,26", "-o", "one.csv")
    answer = morfax(*call)
    assert (
        answer.exit_code == 4 and "are on the same line; leave one of them out" in answer.fault
    )
    call = ("trace", bracket, "--start", "48,26", "--start", "20,50", "-o", "one.csv")
    answer = morfax(*call)
    assert answer.exit_code == 4 and "no line within 3 mm of 20,50 mm" in answer.fault
    assert not Path("one.csv").exists()


def test_a_plain_trace_says_what_else_is_on_the_sheet(morfax: Morfax, here: Path) -> None:
    told = morfax("trace", SAMPLES / "bracket.png", "-o", "outline.csv").err
    assert "the sheet has 1 other line of about 72 mm, inside it: --lines contours cuts" in told
    both = morfax(
        "trace", SAMPLES / "bracket.png", "--lines", "contours", "-o", "b.csv", "--json"
    )
    assert [line["line"] for line in both.figures["lines"]] == [
        2,
        1,
    ]  # as it says: the hole first
    for words in (("--start", "48,26"), ("--lines", "1")):
        told = morfax("trace", SAMPLES / "bracket.png", *words, "-o", "outline.csv").err
        assert told == ""
    assert morfax("trace", SAMPLES / "program.png", "-o", "program.csv").err == ""


def test_all_lines_are_one_program_listed_and_numbered(morfax: Morfax, here: Path) -> None:
    """The bracket's slot, then its outline; the table has a row for each, the JSON an entry."""
    call = ("trace", SAMPLES / "bracket.png", "--lines", "contours", "-o", "bracket.csv")
    answer = morfax(*call, "--picture", "lines.svg", "--json")
    assert answer.exit_code == 0 and answer.figures["patches_left_out"] == 0
    slot, outline = answer.figures["lines"]
    assert (slot["line"], outline["line"]) == (2, 1) and slot["ending"] == outline[
        "ending"
    ] == "closed"
    assert answer.figures["length_mm"] == pytest.approx(
        slot["length_mm"] + outline["length_mm"], abs=1e-3
    )
    assert len(read_path("bracket.csv").runs()) == 2
    from_slot = np.subtract(slot["start_place_mm"], outline["start_place_mm"])
    assert answer.figures["idle_mm"] == pytest.approx(np.hypot(*from_slot), abs=0.1)
    assert Path("lines.svg").read_text().count("<!-- 2 -->") == 1  # the axes count in tens
    table = morfax(*call).out.splitlines()
    rows = table[
        table.index(next(row for row in table if "cell share" in row and "ending" in row)) :
    ]
    assert rows[0].split() == ["ending", "length", "line", "width", "start", "cell", "share"]
    assert [row.split()[:3] for row in rows[1:3]] == [
        ["line", "2", "closed"],
        ["line", "1", "closed"],
    ]


def test_run_plays_all_lines_off_one_tape(morfax: Morfax, here: Path) -> None:
    answer = morfax(
        "run", SAMPLES / "bracket.png", "--lines", "contours", "-o", "results", "--json"
    )
    assert answer.exit_code == 0 and answer.figures["missed_ink_share"] < 0.01
    assert answer.figures["played_to_traced"]["max_mm"] < PLAYED_WITHIN_MM


def test_lines_that_there_are_not_are_refused(morfax: Morfax, here: Path) -> None:
    bracket = SAMPLES / "bracket.png"
    answer = morfax("trace", bracket, "--lines", "1,3")
    assert answer.exit_code == 4 and "no line 3: the drawing has lines 1, 2" in answer.fault
    answer = morfax("trace", bracket, "--lines", "inner")
    assert (
        answer.exit_code == 2
        and "give all, contours, outer, or numbers such as 1,3" in answer.fault
    )
    answer = morfax("trace", bracket, "--lines", "contours", "--start", "1,1")
    assert answer.exit_code == 2 and "--start picks one line, --lines several" in answer.fault
    assert list(here.iterdir()) == []


def test_a_lost_line_among_several_leaves_the_others_cut(morfax: Morfax, here: Path) -> None:
    """A ring, and a line into a bar as broad as ten lines."""
    grey = np.full((600, 1200), 255, np.uint8)
    cv2.line(grey, (50, 350), (1100, 350), 0, 6)
    cv2.rectangle(grey, (600, 330), (1190, 370), 0, -1)
    cv2.circle(grey, (200, 150), 100, 0, 6, cv2.LINE_AA)
    Image.fromarray(grey).save("bar.png", dpi=DPI)
    answer = morfax(
        "trace",
        "bar.png",
        "--lines",
        "contours",
        "--line-width",
        "0.5mm",
        "-o",
        "bar.csv",
        "--json",
    )
    assert answer.exit_code == 4 and answer.figures["incomplete"] is True
    endings = {line["line"]: line["ending"] for line in answer.figures["lines"]}
    (lost,) = (number for number, ending in endings.items() if ending == "lost")
    assert sorted(endings.values()) == ["closed", "lost"]
    assert (
        f"line {lost} of 2 is incomplete, the others are cut" in answer.fault
        and "heading" in answer.fault
    )
    assert len(read_path("bar.incomplete.csv").runs()) == 2


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


@pytest.mark.parametrize("kind", ["1", "I;16", "LA", "RGBA", "CMYK", "P"])
def test_every_kind_of_image_can_be_traced(
    morfax: Morfax, here: Path, small: np.ndarray, kind: str
) -> None:
    grey = Image.fromarray(small)
    image = (
        Image.fromarray(small.astype(np.uint16) * 257) if kind == "I;16" else grey.convert(kind)
    )
    image.save("part.tif", dpi=DPI)
    answer = morfax("trace", "part.tif", "-o", "part.csv", "--json")
    assert answer.exit_code == 0 and answer.figures["ending"] == "closed"


def test_an_image_without_a_resolution_asks_for_one(
    morfax: Morfax, here: Path, small: np.ndarray
) -> None:
    Image.fromarray(small).save("photo.png")
    answer = morfax("trace", "photo.png")
    assert answer.exit_code == 3 and "--dpi" in answer.fault and "--width" in answer.fault
    by_dpi = morfax("trace", "photo.png", "--dpi", 300, "-o", "a.csv", "--json").figures
    by_width = morfax(
        "trace", "photo.png", "--width", f"{320 * 25.4 / 300}mm", "-o", "b.csv", "--json"
    ).figures
    assert by_dpi["length_mm"] == pytest.approx(by_width["length_mm"], abs=1 * UM)
    assert morfax("trace", "photo.png", "--dpi", 300, "--width", "20mm").exit_code == 2


@pytest.mark.parametrize("blank", [255, 0, 128])
def test_a_blank_sheet_holds_no_line(morfax: Morfax, here: Path, blank: int) -> None:
    Image.fromarray(np.full((400, 400), blank, np.uint8)).save("blank.png", dpi=DPI)
    answer = morfax("trace", "blank.png")
    assert answer.exit_code == 3 and "no line" in answer.fault


def test_what_is_no_image_is_told(morfax: Morfax, here: Path) -> None:
    (here / "words.png").write_text("these are words")
    (here / "cut.png").write_bytes(CAM.read_bytes()[:5000])
    for file in ("words.png", "cut.png"):
        answer = morfax("trace", file)
        assert answer.exit_code == 3 and file in answer.fault


def test_a_sheet_larger_than_the_memory_says_what_it_needs(
    morfax: Morfax, here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Asked before it is unpacked: of this one there is nothing but the head of the file."""
    monkeypatch.setattr(room, "free_bytes", lambda: 4_000_000_000)
    Image.fromarray(np.zeros((10, 10), np.uint8)).save("huge.png", dpi=DPI)
    whole = bytearray((here / "huge.png").read_bytes())
    whole[16:24] = struct.pack(">II", 30_000, 30_000)
    whole[28] = 1  # interlaced: it is held as a whole
    whole[29:33] = struct.pack(">I", zlib.crc32(whole[12:29]))
    (here / "huge.png").write_bytes(whole)
    answer = morfax("trace", "huge.png")
    assert answer.exit_code == 3
    for said in ("30000 x 30000 pixels", "8.4 GB", "4.0 GB", "lower resolution"):
        assert said in answer.fault


def test_a_sheet_in_strips_is_the_same_sheet(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = Drawing.open(CAM)
    lines = Sheet.of(whole)
    monkeypatch.setattr(patches, "STRIP_PX", 64 * 1024)
    in_strips = Drawing.open(CAM)
    assert np.allclose(in_strips.darkness, whole.darkness, atol=1e-5)
    again = Sheet.of(in_strips)
    assert again.longest().length_mm == pytest.approx(lines.longest().length_mm, abs=1 * UM)
    assert again.longest().middles_mm == pytest.approx(lines.longest().middles_mm)


def test_patches_are_those_of_opencv() -> None:
    """On paper strewn with ink at random, where many touch at a corner only, and in strips."""
    ink = (np.random.default_rng(3).random((300, 200)) < 0.35).astype(np.uint8)
    found = Patches.of(runs_of(ink[top : top + 70], top) for top in range(0, 300, 70))
    count, labels, stats, _ = cv2.connectedComponentsWithStats(ink)
    assert found.count == count - 1
    assert sorted(found.areas) == sorted(stats[1:, cv2.CC_STAT_AREA])
    largest = np.arange(found.count) == np.argmax(found.areas)
    own = labels == 1 + np.argmax(stats[1:, cv2.CC_STAT_AREA])
    assert (found.painted(largest, 20, 250, 30, 190) == own[20:250, 30:190]).all()


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
