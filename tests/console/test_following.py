"""play --following: the error of each axis against its limit, as a picture and as CSV; its figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.motion import Path as MotionPath
from morfax.player.monitor.chart import Chart
from morfax.reports.pictures import _followed
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


def test_every_control_draws_its_path_with_the_following_error(
    morfax: Morfax, here: Path, program: Path
) -> None:
    """In the worst place the error in colour is that of the figures: of one axis, or of both."""
    answer = morfax("play", program, "--picture", "a.png", "--json")
    assert answer.exit_code == 0 and answer.figures["picture"] == "a.png"
    assert (here / "a.png").read_bytes().startswith(b"\x89PNG")


def test_the_error_along_the_path_is_where_the_chart_has_it() -> None:
    """X stands 30 um and Y 40 um behind for a second; with the tool up nothing is shown."""
    chart = Chart(every_s=0.01)
    chart.begin(("x", "y", "z"))
    t_s = np.arange(0, 3, 1e-3)
    actual_mm = np.column_stack([10 * t_s, 0 * t_s, np.where(t_s < 2, -1.0, 2.0)])
    behind = ((t_s >= 1) & (t_s < 2))[:, None]
    demand_mm = actual_mm + behind * (0.03, 0.04, 0.0)
    chart.note(0, 1000.0, demand_mm, actual_mm, np.full_like(actual_mm, 0.1))
    shown = _followed(MotionPath(t_s, actual_mm), chart, "played")
    assert shown.points_mm is not None and shown.error_mm is not None
    x_mm = shown.points_mm[:, 0]
    assert x_mm.max() == pytest.approx(20.0, abs=0.2)
    assert shown.error_mm[x_mm < 9.9].max() == 0
    assert shown.error_mm[(x_mm > 10.1) & (x_mm < 19.9)] == pytest.approx(0.05, abs=1e-6)
