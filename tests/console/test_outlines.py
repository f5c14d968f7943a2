"""Drawings from CAD on the command line: onto a tape, into the machine, and against what was played."""

from __future__ import annotations

from pathlib import Path

import ezdxf
import numpy as np
import pytest
from ezdxf import units

from morfax.motion.pathfile import read_path
from tests.console.conftest import SAMPLES, Morfax

UM = 1e-3
TURN_MM = 0.03  # where a line without times starts at 10 mm/s at once, the drives swing by 20 um, by trial


@pytest.fixture
def part(here: Path) -> Path:
    """A slot of 40 x 10 mm with a hole of 6 mm, drawn outline first, and a word."""
    document = ezdxf.new("R2010", units=units.MM)
    space = document.modelspace()
    space.add_lwpolyline([(10, 5), (50, 5, 1), (50, 15), (10, 15, 1)], format="xyb", close=True)
    space.add_circle((20, 10), 3)
    space.add_text("M6")
    document.saveas("part.dxf")
    return here / "part.dxf"


def test_a_dxf_goes_onto_a_tape_and_is_compared_with_what_was_played(
    part: Path, morfax: Morfax
) -> None:
    recorded = morfax("record", part, "-o", "part.wav")
    assert recorded.exit_code == 0
    assert "part.dxf: 1 TEXT are no lines, and left out" in recorded.err
    assert morfax("play", "part.wav", "-o", "played.csv", "--quiet").exit_code == 0
    compared = morfax("compare", part, "played.csv", "--json").figures
    assert compared["largest_mm"] < TURN_MM
    assert compared["a_to_b"]["rms_mm"] < 1 * UM
    # what lies inside is cut first
    first = read_path("played.csv").runs()[0]
    assert np.abs(np.hypot(*(first - (20, 10)).T) - 3).max() < TURN_MM


def test_a_dxf_is_played_by_way_of_a_tape(part: Path, morfax: Morfax) -> None:
    played = morfax("play", part, "-o", "played.csv", "--json")
    assert played.exit_code == 0 and played.figures["drawn"] == str(part)
    assert morfax("compare", part, "played.csv", "--tolerance", TURN_MM).exit_code == 0
    assert sorted(file.name for file in Path().iterdir()) == ["part.dxf", "played.csv"]


@pytest.mark.parametrize("suffix", [".dxf", ".svg", ".plt"])
def test_what_record_draws_is_read_back(part: Path, morfax: Morfax, suffix: str) -> None:
    assert morfax("record", part, "-o", f"again{suffix}").exit_code == 0
    largest_mm = morfax("compare", part, f"again{suffix}", "--json").figures["largest_mm"]
    # the drawing's tolerance; a plotter file is played, with its steps and chords besides
    assert largest_mm < (0.01 if suffix != ".plt" else 0.01 + 0.0125 + 0.018 + 0.01) + 2 * UM


def test_a_dxf_becomes_g_code_at_the_feed(part: Path, morfax: Morfax) -> None:
    answer = morfax("record", part, "-o", "part.ngc", "--feed", "600mm/min", "--json")
    assert answer.exit_code == 0
    text = Path("part.ngc").read_text()
    assert "F600" in text and answer.figures["arcs"] >= 3
    # a part in another unit than its file says shows by its size
    size_mm = answer.figures["width_mm"], answer.figures["height_mm"]
    assert size_mm == pytest.approx((50, 10), abs=0.01)
    assert morfax("compare", part, "part.ngc", "--json").figures["largest_mm"] < 0.012


def test_a_program_with_z_of_a_drawing_without_depths_says_so(
    morfax: Morfax, here: Path
) -> None:
    assert morfax("record", SAMPLES / "cam.csv", "-o", "part.dxf").exit_code == 0
    told = "part.dxf states no depth: the tool runs along its lines at Z0"
    assert told in morfax("record", "part.dxf", "-o", "a.ngc").err
    assert told not in morfax("record", "part.dxf", "-o", "a.nc", "--machine", "grbl-pen").err


def test_a_drawing_without_a_unit_is_refused_and_takes_one(here: Path, morfax: Morfax) -> None:
    svg = '<svg xmlns="http://www.w3.org/2000/svg" width="90" height="90"><path d="M 0 0 L 9 0"/></svg>'
    Path("part.svg").write_text(svg)
    answer = morfax("record", "part.svg", "-o", "part.wav")
    assert answer.exit_code == 3
    said = "part.svg does not say its unit (its width is '90'); give it with --unit mm, or --unit in"
    assert answer.fault == f"morfax: {said}" and not Path("part.wav").exists()
    taken = morfax("record", "part.svg", "-o", "part.wav", "--unit", "in", "--json")
    assert taken.figures["length_mm"] == pytest.approx(9 * 25.4, abs=0.01)
    wrong = morfax("record", "part.svg", "-o", "part.wav", "--unit", "ell")
    assert wrong.exit_code == 2 and "'um', 'mm'" in wrong.fault


def test_a_unit_is_for_drawings_from_cad(path_file: Path, here: Path, morfax: Morfax) -> None:
    answer = morfax("record", path_file, "-o", "x.wav", "--unit", "in")
    assert answer.exit_code == 2 and "--unit is for drawings from CAD, .dxf" in answer.fault
    systems = morfax("compare", SAMPLES / "curve.png", "--systems", "all", "--unit", "in")
    assert systems.exit_code == 2 and "with --systems leave it out" in systems.fault


def test_nothing_of_a_dxf_is_traced(part: Path, morfax: Morfax) -> None:
    answer = morfax("trace", part, "-o", "part.ngc")
    assert answer.exit_code == 3
    assert "part.dxf already holds lines" in answer.fault and "morfax record" in answer.fault


def test_a_scan_is_compared_with_the_drawing_from_cad(here: Path, morfax: Morfax) -> None:
    """The scan's own traced line, as CAD would have it."""
    curve = SAMPLES / "curve.png"
    assert morfax("trace", curve, "-o", "curve.dxf").exit_code == 0
    compared = morfax("compare", curve, "curve.dxf", "--json").figures
    assert compared["path_to_ink"]["rms_mm"] < 0.02
