"""compare between paths and tapes: both ways, the tolerance, the picture."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.pathfile import read_path, write_path
from morfax.motion.placement import Placement
from tests.console.conftest import SAMPLES, Morfax

UM = 1e-3


@pytest.fixture
def aside(here: Path, path_file: Path) -> Path:
    """The path, 0.1 mm further right, in the current folder."""
    rows = np.loadtxt(path_file, delimiter=",", skiprows=1)
    rows[:, 1] += 0.1
    np.savetxt(
        "aside.csv", rows, delimiter=",", header="t_s,x_mm,y_mm,z_mm", comments="", fmt="%.6f"
    )
    return here / "aside.csv"


def test_a_path_is_no_distance_from_itself(morfax: Morfax, path_file: Path) -> None:
    answer = morfax("compare", path_file, path_file, "--tolerance", "0.1um", "--json")
    assert answer.exit_code == 0
    assert answer.figures["a_to_b"] == {"rms_mm": 0, "p95_mm": 0, "max_mm": 0}
    assert answer.figures["within_tolerance"] is True


def test_a_shifted_circle_is_as_far_off_as_it_was_shifted(
    morfax: Morfax, aside: Path, path_file: Path
) -> None:
    figures = morfax("compare", aside, path_file, "--json").figures
    assert figures["largest_mm"] == pytest.approx(0.1, abs=1 * UM)
    # the distance is the shift's part across the circle: RMS of the cosine
    assert figures["a_to_b"]["rms_mm"] == pytest.approx(0.1 / np.sqrt(2), abs=1 * UM)
    assert figures["b_to_a"]["rms_mm"] == pytest.approx(0.1 / np.sqrt(2), abs=1 * UM)


@pytest.mark.parametrize(("tolerance", "exit_code"), [("101um", 0), ("99um", 1)])
def test_beyond_the_tolerance_the_exit_code_is_1(
    morfax: Morfax, aside: Path, path_file: Path, tolerance: str, exit_code: int
) -> None:
    answer = morfax("compare", aside, path_file, "--tolerance", tolerance)
    assert answer.exit_code == exit_code
    assert "largest" in answer.out and answer.err == ""


def test_a_tape_is_played_for_the_comparison(
    morfax: Morfax, path_file: Path, tape_file: Path
) -> None:
    answer = morfax("compare", tape_file, path_file, "--tolerance", "3um", "--json")
    assert answer.exit_code == 0
    assert answer.figures["a"] == str(tape_file)


def test_the_picture_shows_the_error(morfax: Morfax, aside: Path, path_file: Path) -> None:
    assert morfax("compare", aside, path_file, "--picture", "error.png").exit_code == 0
    assert Path("error.png").read_bytes().startswith(b"\x89PNG")


def test_two_drawings_are_wrong_use(morfax: Morfax) -> None:
    answer = morfax("compare", SAMPLES / "cam.png", SAMPLES / "gear.png")
    assert answer.exit_code == 2 and "both drawings" in answer.fault


def test_a_kind_is_read_off_the_content_before_the_name(
    morfax: Morfax, here: Path, tape_file: Path
) -> None:
    (here / "tape.csv").write_bytes(tape_file.read_bytes())
    assert morfax("compare", "tape.csv", tape_file, "--tolerance", "1um").exit_code == 0


def test_a_path_that_only_crosses_the_ink_is_no_path_of_that_drawing(
    morfax: Morfax, here: Path
) -> None:
    (here / "across.csv").write_text("x,y\n5,60\n85,61\n")
    answer = morfax("compare", SAMPLES / "cam.png", "across.csv", "--tolerance", "1mm")
    assert answer.exit_code == 7 and "scale" in answer.fault


@pytest.mark.parametrize(("zero", "exit_code"), [("10mm,0", 0), ("10.5,0", 1)])
def test_a_path_from_another_zero_is_compared_where_it_was_drawn(
    morfax: Morfax, here: Path, zero: str, exit_code: int
) -> None:
    morfax("trace", SAMPLES / "cam.png", "-o", "cam.csv")
    path = read_path(here / "cam.csv")
    write_path(Placement(origin_mm=(10.0, 0.0)).path(path), here / "moved.csv")
    answer = morfax(
        "compare",
        SAMPLES / "cam.png",
        "moved.csv",
        "--zero",
        zero,
        "--tolerance",
        "50um",
        "--json",
    )
    assert answer.exit_code == exit_code


@pytest.mark.parametrize(
    ("zero", "said"),
    [
        ((), "has another zero than the sheet's lower left corner: --zero X,Y gives it"),
        (("--zero", "0,0"), "has another zero than the --zero that was given"),
    ],
)
def test_what_may_be_wrong_with_a_path_beside_the_ink_depends_on_what_is_known_of_its_zero(
    morfax: Morfax, here: Path, zero: tuple[str, ...], said: str
) -> None:
    """The bracket's own outline 15 mm to the right: two of its sides still lie along ink."""
    outline_mm = read_path(SAMPLES / "bracket.csv").runs()[0]
    rows = [f"{x_mm + 15:.4f},{y_mm:.4f}" for x_mm, y_mm in outline_mm]
    (here / "beside.csv").write_text("\n".join(["x,y", *rows]))
    answer = morfax("compare", SAMPLES / "bracket.png", "beside.csv", *zero)
    assert said in answer.err and "--picture shows where" in answer.err


def test_a_zero_without_a_drawing_is_refused(morfax: Morfax, path_file: Path) -> None:
    answer = morfax("compare", path_file, path_file, "--zero", "reference")
    assert answer.exit_code == 2 and "--zero is a place on a drawing" in answer.fault


def test_a_reference_point_that_is_not_drawn_is_a_fault(
    morfax: Morfax, path_file: Path
) -> None:
    answer = morfax("compare", SAMPLES / "cam.png", path_file, "--zero", "reference")
    assert (
        answer.exit_code == 4
        and "the drawing has no small cross or ring; give its place" in answer.fault
    )
