"""play: motors, zero and feed override as the command line takes them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.jobs import play
from morfax.motion.contour import distance
from morfax.motion.pathfile import read_path
from morfax.player.tape.phase_lock import MOTORS
from tests.console.conftest import Morfax

UM = 1e-3


def test_the_motors_offered_are_those_there_are() -> None:
    assert tuple(MOTORS) == play.MOTORS


def test_an_override_runs_the_same_path_in_another_time(
    morfax: Morfax, here: Path, tape_file: Path
) -> None:
    plain = morfax("play", tape_file, "-o", "a.csv", "--json").figures
    faster = morfax(
        "play", tape_file, "-o", "b.csv", "--feed-override", "120%", "--json"
    ).figures
    assert faster["duration_s"] == pytest.approx(plain["duration_s"] / 1.2, rel=1e-3)
    assert distance(read_path("a.csv"), read_path("b.csv")).hausdorff_mm < 1 * UM


def test_a_zero_shifts_the_path(morfax: Morfax, here: Path, tape_file: Path) -> None:
    assert morfax("play", tape_file, "-o", "a.csv", "-q").exit_code == 0
    assert (
        morfax(
            "play", tape_file, "-o", "b.csv", "-q", "--zero-adjustment", "0.5mm,-1,20um"
        ).exit_code
        == 0
    )
    ends = [read_path(file).positions_mm[[0, -1]] for file in ("a.csv", "b.csv")]
    assert np.abs(ends[1] - ends[0] - [0.5, -1, 0.02]).max() < 0.1 * UM


def test_hydraulic_motors_follow_later(morfax: Morfax, here: Path, tape_file: Path) -> None:
    electric = morfax("play", tape_file, "--json").figures
    hydraulic = morfax("play", tape_file, "--motor", "hydraulic", "--json").figures
    assert hydraulic["largest_following_error_mm"] > electric["largest_following_error_mm"]


def test_wheels_that_are_wrong_show_in_the_path(
    morfax: Morfax, here: Path, tape_file: Path
) -> None:
    assert morfax("play", tape_file, "-o", "a.csv", "-q").exit_code == 0
    words = ("--wheel-eccentricity", "0.2mm", "--wheel-division", "0")
    assert morfax("play", tape_file, "-o", "b.csv", "-q", *words).exit_code == 0
    apart = distance(read_path("b.csv"), read_path("a.csv")).hausdorff_mm
    # on each axis 5 mm / 2 pi of 0.2 in 30 mm at most: 5.3 um
    assert 3 * UM < apart < 5.3 * np.sqrt(2) * UM


def test_a_dead_lamp_stops_the_machine(morfax: Morfax, here: Path, tape_file: Path) -> None:
    answer = morfax("play", tape_file, "-o", "a.csv", "--lamp", "5%")
    assert answer.exit_code == 6
    assert "its pick-up gives no signal: the lamp has 5% of its light" in answer.fault


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--feed-override", "300%"), "the override is 300%; give 10% to 200%"),
        (("--feed-override", "0"), "'0' is no share; give 120%"),
        (("--zero-adjustment", "1"), "is no place"),
        (
            ("--zero-adjustment", "1,2,3,4"),
            "a zero of 4 places does not fit; the tape has 3 axes",
        ),
        (("--zero-adjustment", "0,5m"), "a zero of 5000 mm is too far"),
        (("--wheel-eccentricity", "5mm"), "5 mm off its axis is broken; give 0 to 3 mm"),
        (
            ("--wheel-division", "1mm"),
            "1 mm off their places make no wheel; give 0 to 0.188 mm",
        ),
        (("--lamp", "150%"), "the lamp has 150% of its light; give 0% to 100%"),
        (("--motor", "steam"), "'steam' is not one of 'electric', 'hydraulic'"),
    ],
)
def test_what_is_refused(
    morfax: Morfax, here: Path, tape_file: Path, words: tuple[str, ...], says: str
) -> None:
    answer = morfax("play", tape_file, "-o", "a.csv", *words)
    assert answer.exit_code == 2 and says in answer.fault
    assert not list(here.glob("*.csv"))


def test_other_controls_have_none_of_it(morfax: Morfax, here: Path, path_file: Path) -> None:
    assert morfax("record", path_file, "-o", "a.steps", "-q").exit_code == 0
    assert (
        "--motor, --zero-adjustment is for tapes"
        in morfax("play", "a.steps", "--zero-adjustment", "1,1", "--motor", "electric").fault
    )
    assert (
        "--feed-override is for tapes and for programs of"
        in morfax("play", "a.steps", "--feed-override", "50%").fault
    )
    assert (
        "--zero-adjustment is for files, not for a pipe"
        in morfax("play", "-", "--zero-adjustment", "1,1").fault
    )
