"""`--cutter` and `--side` by their behaviour."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.console.conftest import SAMPLES, Morfax


def test_what_the_cutter_leaves_is_listed_and_the_edge_is_compared_with_the_drawing(
    morfax: Morfax, here: Path
) -> None:
    answer = morfax(
        "trace",
        SAMPLES / "gear.png",
        "--cutter",
        "3mm",
        "-o",
        "gear.csv",
        "--picture",
        "gear.png",
        "--json",
    )
    assert answer.exit_code == 0 and (here / "gear.png").exists()
    assert answer.figures["cutter_diameter_mm"] == 3 and answer.figures["side"] == "outside"
    assert len(answer.figures["unreached"]) == 8  # one between each two teeth
    assert 0.59 < answer.figures["unreached"][0]["left_mm"] < 0.61
    assert "does not reach into 8 places" in answer.err and "up to 0.60 mm" in answer.err
    compared = morfax("compare", SAMPLES / "gear.png", "gear.csv", "--cutter", "3mm", "--json")
    assert (
        compared.figures["path_to_ink"]["rms_mm"] < 0.006
        and compared.figures["path_to_ink"]["measured_share"] > 0.9
    )


def test_the_table_of_what_is_left_has_places(morfax: Morfax, here: Path) -> None:
    answer = morfax("trace", SAMPLES / "gear.png", "--cutter", "3mm", "-o", "gear.csv")
    assert answer.exit_code == 0
    (row,) = (line for line in answer.out.splitlines() if line.startswith("unreached 8"))
    assert len(row.split(" mm")) == 4  # place, what is left, stretch


def test_a_line_too_small_for_the_cutter_is_told_of_and_listed(
    morfax: Morfax, here: Path
) -> None:
    options = (
        SAMPLES / "bracket.png",
        "--lines",
        "contours",
        "-o",
        "bracket.csv",
        "--json",
        "--cutter",
    )
    answer = morfax("trace", *options, "12mm", "--picture", "bracket.png")
    assert answer.exit_code == 0 and (here / "bracket.png").exists()
    assert (
        "line 2 is left out: a cutter of 12 mm has no room beside it; one of up to 7.95 mm fits"
        in answer.err
    )
    assert [line["line"] for line in answer.figures["lines"]] == [1]
    (out,) = answer.figures["lines_left_out"]
    assert (
        out["line_left_out"] == 2
        and out["cutter_up_to_mm"] == 7.95
        and out["room_mm"] == pytest.approx(8, abs=0.02)
    )
    smaller = morfax("trace", *options, "7.95mm")
    assert smaller.exit_code == 0 and [line["line"] for line in smaller.figures["lines"]] == [
        2,
        1,
    ]
    assert "lines_left_out" not in smaller.figures and "left out" not in smaller.err


def test_a_line_s_cell_share_is_of_the_way_that_the_head_went_with_a_cutter_too(
    morfax: Morfax, here: Path
) -> None:
    bracket = ("trace", SAMPLES / "bracket.png", "--lines", "contours", "--json")
    plain = morfax(*bracket, "-o", "plain.csv").figures["lines"]
    cut = morfax(*bracket, "--cutter", "4mm", "--climb", "-o", "cut.csv").figures["lines"]
    shares = [{line["line"]: line["cell_share"] for line in lines} for lines in (plain, cut)]
    assert shares[0] == shares[1] and len(shares[0]) == 2


def test_a_drawn_program_is_traced_with_a_cutter_and_begins_and_ends_on_its_reference_point(
    morfax: Morfax, here: Path
) -> None:
    options = (
        "--card",
        SAMPLES / "program.toml",
        "--cutter",
        "6mm",
        "--zero",
        "reference",
        "-o",
        "beside.wav",
    )
    answer = morfax(
        "trace", SAMPLES / "program.png", *options, "--path", "beside.csv", "--json"
    )
    assert answer.exit_code == 0
    places = [stop["stop_place_mm"] for stop in answer.figures["stops"]]
    assert places == [
        pytest.approx(place, abs=0.05) for place in ((21.5, 23), (48.5, 27), (73.5, 21))
    ]
    played = morfax("play", "beside.wav", "-o", "played.csv", "--json")
    compared = morfax("compare", "played.csv", "beside.csv", "--json").figures
    assert played.exit_code == 0 and compared["a_to_b"]["max_mm"] < 0.003
    rows = (here / "beside.csv").read_text().splitlines()
    for row in (rows[-1], next(row for row in rows if row[:1].isdigit())):
        assert [float(number) for number in row.split(",")[1:3]] == pytest.approx(
            [0, 0], abs=1e-4
        )


def test_run_of_a_drawn_program_with_a_cutter_covers_its_lead_and_guide_lines(
    morfax: Morfax, here: Path
) -> None:
    options = ("--card", SAMPLES / "program.toml", "--cutter", "6mm", "--side", "inside")
    figures = morfax(
        "run", SAMPLES / "program.png", *options, "-o", "program", "--json"
    ).figures
    assert figures["played_to_ink"]["rms_mm"] < 0.004
    assert (
        figures["missed_ink_mm"] < 14
    )  # of 183 the arms of the cross, and the ticks: 10 without a cutter, a tick's more here


def test_run_takes_a_cutter(morfax: Morfax, here: Path) -> None:
    figures = morfax(
        "run", SAMPLES / "cam.png", "--cutter", "6mm", "-o", "cam", "--json"
    ).figures
    assert figures["played_to_ink"]["rms_mm"] < 0.004 and figures["missed_ink_mm"] == 0


@pytest.mark.parametrize(
    ("options", "exit_code", "said"),
    [
        (
            ("--side", "left"),
            2,
            "--side is the side of the cutter; give its diameter with --cutter",
        ),
        (
            ("--cutter", "300mm", "--side", "inside"),
            7,
            "a cutter of 300 mm has no room inside of any line; give a smaller --cutter, up to 70.8 mm,",
        ),
    ],
)
def test_what_cannot_be_is_one_line_and_nothing_is_written(
    morfax: Morfax, here: Path, options: tuple[str, ...], exit_code: int, said: str
) -> None:
    answer = morfax("trace", SAMPLES / "cam.png", *options)
    assert answer.exit_code == exit_code and said in answer.fault and not list(here.iterdir())


def test_a_hole_that_is_asked_for_alone_is_not_cut_as_an_outline_without_a_word(
    morfax: Morfax, here: Path
) -> None:
    options = (
        "trace",
        SAMPLES / "bracket.png",
        "--lines",
        "2",
        "--cutter",
        "3mm",
        "-o",
        "a.csv",
    )
    answer = morfax(*options)
    assert answer.exit_code == 0
    assert "line 2 lies inside line 1, which is not cut" in answer.err
    assert "give --side inside for a hole, or cut line 1, too" in answer.err
    for further in (("--side", "inside"), ("--side", "left"), ("--lines", "1,2")):
        assert "which is not cut" not in morfax(*options, *further).err


def test_a_cutter_takes_all_contours_unless_one_line_or_a_card_is_asked_for(
    morfax: Morfax, here: Path
) -> None:
    # a part is cut with its holes: the bracket has an outline and three holes
    bracket = ("trace", SAMPLES / "bracket.png", "--cutter", "3mm", "--json")
    asked = morfax(*bracket, "--lines", "contours", "-o", "asked.csv").figures
    usual = morfax(*bracket, "-o", "usual.csv").figures
    assert usual["lines"] == asked["lines"] and len(usual["lines"]) > 1
    assert Path("usual.csv").read_bytes() == Path("asked.csv").read_bytes()
    alone = morfax(*bracket, "--start", "5,5", "-o", "one.csv").figures
    assert "lines" not in alone
