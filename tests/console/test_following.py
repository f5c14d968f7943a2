"""play --following: the error of each axis against its limit, as a picture and as CSV; its figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.console.conftest import Morfax

SUFFIXES = (".wav", ".steps", ".cubic", ".ngc")


@pytest.fixture(scope="module", params=SUFFIXES)
def program(
    request: pytest.FixtureRequest, path_file: Path, tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """The circle as a program in each medium."""
    from morfax.console.cli import main

    file = tmp_path_factory.mktemp("programs") / f"circle{request.param}"
    assert main(["record", str(path_file), "-o", str(file), "--quiet"]) == 0
    return file


def test_every_control_tells_and_writes_how_its_axes_followed(
    morfax: Morfax, here: Path, program: Path
) -> None:
    answer = morfax("play", program, "--following", "a.csv", "--following", "a.png", "--json")
    assert answer.exit_code == 0
    assert answer.figures["following"] == ["a.csv", "a.png"]
    assert (here / "a.png").read_bytes().startswith(b"\x89PNG")
    header, *_ = (here / "a.csv").read_text().splitlines()
    assert header.split(",")[:5] == [
        "t_s",
        "x_demand_mm",
        "x_actual_mm",
        "x_error_mm",
        "x_limit_mm",
    ]
    rows = np.loadtxt(here / "a.csv", delimiter=",", skiprows=1)
    assert rows[-1, 0] == pytest.approx(answer.figures["duration_s"], abs=0.03)
    for axis, first in (("x", 1), ("y", 5), ("z", 9)):
        demand, actual, error, limit = rows[:, first : first + 4].T
        assert error == pytest.approx(demand - actual, abs=2e-7)  # seven digits
        assert (np.abs(error) <= limit).all()
        told = answer.figures[f"{axis}_axis"]
        # the row nearest to its limit is not always that of the largest error, but little less
        assert (
            0.8 * told["following_error_mm"] - 1e-7
            <= np.abs(error).max()
            <= told["following_error_mm"] + 1e-7
        )
        assert told["limit_share"] == pytest.approx((np.abs(error) / limit).max(), abs=1e-3)
    assert answer.figures["largest_following_error_mm"] == max(
        answer.figures[f"{axis}_axis"]["following_error_mm"] for axis in "xyz"
    )


def test_raw_keeps_every_sample(morfax: Morfax, here: Path, tape_file: Path) -> None:
    assert morfax("play", tape_file, "--following", "a.csv", "--raw").exit_code == 0
    times_s = np.loadtxt(here / "a.csv", delimiter=",", skiprows=1)[:, 0]
    assert np.diff(times_s) == pytest.approx(1 / 6000, abs=2e-7)


@pytest.mark.parametrize("name", ["a.txt", "nowhere/a.png"])
def test_a_name_that_cannot_be_written_is_refused_before_anything_moves(
    morfax: Morfax, here: Path, tape_file: Path, name: str
) -> None:
    answer = morfax("play", tape_file, "--following", name)
    assert answer.exit_code in (2, 8) and name in answer.fault


def test_a_fault_leaves_the_errors_up_to_it_under_a_name_that_says_so(
    morfax: Morfax, here: Path, hasty_file: Path
) -> None:
    assert morfax("record", hasty_file, "-o", "hasty.wav").exit_code == 0
    answer = morfax(
        "play", "hasty.wav", "--following", "errors.csv.png", "--following", "errors.csv"
    )
    assert answer.exit_code == 6
    assert sorted(file.name for file in here.glob("*.incomplete*")) == [
        "errors.csv.incomplete.png",
        "errors.incomplete.csv",
    ]
    assert not (here / "errors.csv").exists()
