"""The recording unit's options: what they put on the tape, what is compared, and what is refused."""

from pathlib import Path

import numpy as np
import pytest

from morfax.jobs.machine import recording as unit
from morfax.motion.motion import Path as MotionPath
from morfax.motion.pathfile import read_path, write_path
from morfax.recorder.tape.pickups import DEFAULT_PICK_UP, PICK_UPS
from morfax.recorder.tape.tape import Tape
from tests.console.conftest import SAMPLES, Morfax


def test_the_names_offered_are_those_there_are() -> None:
    assert tuple(PICK_UPS) == unit.PICK_UPS and unit.PICK_UPS[0] == DEFAULT_PICK_UP


def test_the_default_tape_is_the_same_byte_for_byte(
    morfax: Morfax, here: Path, path_file: Path
) -> None:
    assert morfax("record", path_file, "-o", "a.wav", "-q").exit_code == 0
    assert (
        morfax(
            "record", path_file, "-o", "b.wav", "-q", "--pickup", "resolver", "--turn", "360"
        ).exit_code
        == 0
    )
    assert Path("a.wav").read_bytes() == Path("b.wav").read_bytes()


def test_a_pick_up_is_on_the_tape_with_its_travel_per_cycle(
    morfax: Morfax, here: Path, path_file: Path
) -> None:
    answer = morfax("record", path_file, "-o", "a.wav", "--pickup", "scale", "--json")
    assert answer.figures["pickup"] == "scale"
    with Tape.open("a.wav") as tape:
        assert (tape.format.pickup, tape.format.mm_per_cycle) == ("scale", 0.1)
    assert '"pickup": "scale"' in morfax("inspect", "a.wav", "--json").figures["text"]


def test_mirror_turn_and_scale_of_a_path(morfax: Morfax, here: Path) -> None:
    write_path(
        MotionPath(np.array([0.0, 1, 2]), np.array([[10.0, 5, 2], [14, 5, 0], [14, 7, 0]])),
        "l.csv",
    )
    answer = morfax(
        "record",
        "l.csv",
        "-o",
        "l.wav",
        "--mirror",
        "x",
        "--scale",
        "200%",
        "--turn",
        "90deg",
        "--json",
    )
    assert "a cutter's radius that the path allows for is scaled too" in answer.err
    assert answer.figures["end_place_mm"] == pytest.approx([6, -3, 0], abs=1e-9)
    assert morfax("play", "l.wav", "-o", "played.csv", "-q").exit_code == 0
    assert read_path("played.csv").positions_mm[-1] == pytest.approx(
        [6, -3, 0], abs=1e-5
    )  # what a path file keeps


def test_a_scaled_program_names_the_tool_that_it_needs(morfax: Morfax, here: Path) -> None:
    answer = morfax(
        "trace", SAMPLES / "cam.png", "--cutter", "3mm", "--scale", "2", "-o", "cam.ngc"
    )
    assert (
        "scaled by 2: the program is for a cutter of 6 mm, X and Y run 2 times as fast"
        in answer.err
    )
    assert "(tool: 6 mm wide, outside)\n" in Path("cam.ngc").read_text()


def test_a_mirrored_drawing_is_compared_as_the_head_saw_it(morfax: Morfax, here: Path) -> None:
    answer = morfax(
        "run",
        SAMPLES / "cam.png",
        "-o",
        "out",
        "--mirror",
        "y",
        "--turn",
        "30deg",
        "-q",
        "--json",
    )
    assert answer.exit_code == 0
    assert answer.figures["played_to_ink"]["max_mm"] < 0.02  # as without: 0.0065
    traced, played = read_path("out/cam.traced.csv"), read_path("out/cam.played.csv")
    assert (
        np.abs(traced.xy_mm.min(axis=0) - played.xy_mm.min(axis=0)).max() < 0.01
    )  # both as the machine ran
    assert answer.figures["mirrored"] == "Y"


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("-o", "a.ngc", "--pickup", "coil"), "--pickup is for tapes"),
        (
            ("-o", "a.wav", "--pickup", "gramophone"),
            "'gramophone' is not one of 'resolver', 'photocell'",
        ),
        (("-o", "a.wav", "--mirror", "z"), "'z' is not one of 'x', 'y'"),
        (("-o", "a.wav", "--scale", "0"), "give 120%, 50% or a bare number"),
        (("-o", "a.wav", "--turn", "north"), "'north' is no angle; give 90deg"),
    ],
)
def test_what_is_refused(
    morfax: Morfax, here: Path, path_file: Path, words: tuple[str, ...], says: str
) -> None:
    answer = morfax("record", path_file, *words)
    assert answer.exit_code == 2 and says in answer.fault
    assert not list(here.glob("a.*"))


def test_a_path_alone_has_no_pick_up(morfax: Morfax, here: Path) -> None:
    assert (
        "--pickup is for tapes"
        in morfax("trace", SAMPLES / "cam.png", "-o", "a.csv", "--pickup", "coil").fault
    )
