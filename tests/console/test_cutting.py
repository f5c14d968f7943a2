"""`--climb`, `--lead-in`, `--lead-out`, `--start-at`, `--kerf` by their behaviour."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.pathfile import read_path
from morfax.motion.polyline import area_mm2
from tests.console.conftest import SAMPLES, Morfax

BRACKET = (SAMPLES / "bracket.png", "--lines", "all", "-o", "a.csv")


def test_leads_are_told_with_what_each_line_has_and_the_path_still_fits_the_drawing(
    morfax: Morfax, here: Path
) -> None:
    """In the slot, 8 mm wide, an arc of 3 mm has no room beside a cut of 4 mm: it is 2.55 mm."""
    answer = morfax(
        "trace", *BRACKET, "--kerf", "4mm", "--climb", "--lead-in", "3mm", "--lead-out", "1mm,line",
        "--zero", "lower-left", "--json",
    )  # fmt: skip
    assert answer.exit_code == 0
    assert answer.figures["cutter_diameter_mm"] == 4
    rows = {row["of_line"]: row for row in answer.figures["leads"]}
    assert rows[1]["lead_in_mm"] == 3 and rows[1]["lead_out_mm"] == 1
    assert rows[2]["lead_in_mm"] == pytest.approx(2.55)
    said = "no room for a lead-in of 3 mm everywhere: 2.55 mm at line 2; --lead-in 2.5mm fits everywhere"
    assert said in answer.err
    x, y = answer.figures["zero_place_mm"]
    compared = morfax(
        "compare",
        SAMPLES / "bracket.png",
        "a.csv",
        "--kerf",
        "4mm",
        "--zero",
        f"{x},{y}",
        "--json",
    )
    found = compared.figures["path_to_ink"]
    # as without leads: leads are not compared
    assert found["rms_mm"] < 0.007 and found["measured_share"] > 0.97


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--climb", "--conventional"), "--climb and --conventional were both given"),
        (("--climb", "--direction", "cw"), "both say which way round"),
        (("--kerf", "1mm", "--cutter", "1mm"), "--kerf and --cutter are the same"),
        (("--kerf", "-1mm"), "'-1mm' is no length here; it may be 0.05mm to 500mm"),
        (("--lead-in", "-3mm"), "'-3mm' is no lead; its size may be 0.1mm to 100mm"),
        (("--lead-in", "3mm,spiral"), "'3mm,spiral' is no lead; give its size"),
        (("--lead-out", "wide"), "'wide' is no length"),
        (("--start-at", "end"), "'end' is not one of 'corner', 'straight', 'nearest'"),
        (("--zero", "middle"), "give sheet, reference, lower-left, centre, or a place X,Y"),
    ],
)
def test_what_does_not_go_is_one_line_of_wrong_use(
    morfax: Morfax, here: Path, options: tuple[str, ...], said: str
) -> None:
    answer = morfax("trace", *BRACKET, *options)
    assert answer.exit_code == 2 and said in answer.fault
    assert not (here / "a.csv").exists()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--climb",), "--climb is for closed lines, and the line is open"),
        (("--lead-in", "3mm"), "a lead is for closed lines, and the line is open"),
    ],
)
def test_an_open_line_alone_is_refused_and_nothing_is_written(
    morfax: Morfax, here: Path, options: tuple[str, ...], said: str
) -> None:
    answer = morfax("trace", SAMPLES / "curve.png", "-o", "a.csv", *options)
    assert answer.exit_code not in (0, 2) and said in answer.fault
    assert not (here / "a.csv").exists()


def test_the_zero_of_a_part_is_not_of_a_drawing(morfax: Morfax, path_file: Path) -> None:
    answer = morfax("compare", SAMPLES / "cam.png", path_file, "--zero", "centre")
    assert (
        answer.exit_code == 2
        and "give the place that trace printed as zero_place_mm" in answer.fault
    )


def test_record_puts_the_zero_where_it_is_asked_for(morfax: Morfax, here: Path) -> None:
    """A square of 10 mm with its corner at 5,7 and a lead before it: leads do not count."""
    places = [(2, 7), (5, 7), (15, 7), (15, 17), (5, 17), (5, 7)]
    rows = ["2,7,2,0", *(f"{x},{y},-1,1" for x, y in places), "5,7,2,0"]
    (here / "square.csv").write_text("\n".join(["x_mm,y_mm,z_mm,tool", *rows]))
    for zero, x_mm, y_mm in (("lower-left", 5, 7), ("centre", 10, 12), ("1,2", 1, 2)):
        answer = morfax("record", "square.csv", "-o", "a.wav", "--zero", zero, "--json")
        start = answer.figures["start_place_mm"]
        assert start[:2] == pytest.approx([2 - x_mm, 7 - y_mm], abs=0.01)
        assert answer.figures["zero_place_mm"] == pytest.approx([x_mm, y_mm], abs=0.01)
    answer = morfax("record", "square.csv", "-o", "b.wav", "--zero", "reference")
    assert answer.exit_code == 2 and "--zero reference is a point on a drawing" in answer.fault
    assert not (here / "b.wav").exists()


def test_a_program_says_its_zero_and_the_size_of_the_part_and_compare_takes_them(
    morfax: Morfax, here: Path
) -> None:
    words = (
        SAMPLES / "bracket.png",
        "--lines",
        "contours",
        "--cutter",
        "4mm",
        "--lead-in",
        "2mm",
    )
    answer = morfax("trace", *words, "-o", "a.ngc", "--zero", "lower-left", "--json")
    assert answer.exit_code == 0, answer.err
    drawn_mm = read_path(SAMPLES / "bracket.csv").xy_mm  # the sample's own truth
    head = "\n".join((here / "a.ngc").read_text().split("\n")[:9])
    place_mm = re.search(r"\(zero at ([\d.]+),([\d.]+) mm of the sheet\)", head)
    size_mm = re.search(r"\(part ([\d.]+) x ([\d.]+) mm\)", head)
    assert place_mm and size_mm
    zero_mm = [float(number) for number in place_mm.groups()]
    assert zero_mm == pytest.approx(
        drawn_mm.min(axis=0), abs=0.02
    )  # as well as the head follows
    assert zero_mm == pytest.approx(answer.figures["zero_place_mm"], abs=0.0001)
    assert [float(number) for number in size_mm.groups()] == pytest.approx(
        np.ptp(drawn_mm, axis=0), abs=0.03
    )
    told = (SAMPLES / "bracket.png", "a.ngc", "--cutter", "4mm", "--json")
    for zero in ((), ("--zero", "lower-left")):
        compared = morfax("compare", *told, *zero)
        assert compared.figures["path_to_ink"]["rms_mm"] < 0.015
        assert "a.ngc says that its zero is at" in compared.err
    # 7 mm away hardly any of it lies on ink, and what does is no measure
    far = morfax("compare", *told, "--zero", "sheet", "--tolerance", "5mm")
    assert far.exit_code == 1 and far.figures["within_tolerance"] is False
    assert "% of the path lies along the drawing's ink: the path leaves the ink" in far.err


@pytest.mark.parametrize(
    "placed", [(), ("--turn", "90deg"), ("--mirror", "x", "--turn", "30deg")]
)
def test_a_plotter_that_cannot_come_to_a_lead_is_told_the_zero_that_goes(
    morfax: Morfax, here: Path, placed: tuple[str, ...]
) -> None:
    """(Fails turned or mirrored where a zero on the sheet does not go with the drawing.)"""
    words = ("trace", SAMPLES / "bracket.png", "--lines", "contours", "--kerf", "1mm", *placed)
    plot = (*words, "--lead-in", "3mm", "-o", "a.plt", "--zero")
    refused = morfax(*plot, "lower-left")
    assert refused.exit_code == 7 and not (here / "a.plt").exists()
    zero = re.search(
        r"and a plotter begins at 0, 0; give --zero ([-\d.]+,[-\d.]+)$", refused.fault
    )
    assert zero and morfax(*plot, zero[1]).exit_code == 0


@pytest.mark.parametrize("mirror", [(), ("--mirror", "x"), ("--mirror", "y")])
def test_a_mirrored_program_climbs_too(
    morfax: Morfax, here: Path, mirror: tuple[str, ...]
) -> None:
    """The tool on the left of its travel: the hole counter-clockwise, then the outline clockwise."""
    words = ("trace", SAMPLES / "bracket.png", "--lines", "contours", "--climb", "-o", "a.csv")
    assert morfax(*words, *mirror).exit_code == 0
    areas_mm2 = [area_mm2(run) for run in read_path(here / "a.csv").runs()]
    hole_mm2, outline_mm2 = areas_mm2
    assert hole_mm2 > 0 > outline_mm2
