"""The reading of every program that the tests write notices a program that a control would not take."""

from __future__ import annotations

import shutil

import pytest

from morfax.recorder.gcode.machine import machine
from tests.programs import Programs, Written, misread, refused

RIGHT = ["G21 G17 G40 G49 G54 G80 G90 G94", "M3 S1000", "G0 Z2", "G0 X5 Y0", "G1 Z-1 F100",
         "G3 X-5 Y0 I-5 J0 F600", "G0 Z2", "M5", "M2"]  # fmt: skip
NO_CIRCLE = [line.replace("I-5", "I-5.2") for line in RIGHT]
NO_FEED = [line.split(" F")[0] for line in RIGHT]
reader = pytest.mark.skipif(
    shutil.which("rs274") is None, reason="rs274 of linuxcnc-uspace is not installed"
)


def written(*programs: list[str], by: str = "linuxcnc") -> list[Written]:
    return [Written(f"test {k}", machine(by), lines) for k, lines in enumerate(programs, 1)]


@reader
def test_linuxcnc_names_each_program_that_it_does_not_take_and_reads_the_others() -> None:
    told = refused(written(RIGHT, NO_CIRCLE, RIGHT, NO_FEED, RIGHT))
    assert [line.split(": ")[:2] for line in told] == [["test 2", "rs274"], ["test 4", "rs274"]]
    assert "G3 X-5 Y0 I-5.2 J0 F600" in told[0] and "zero feed rate" in told[1]


@reader
def test_a_feed_of_the_program_before_is_no_feed() -> None:
    assert refused(written(RIGHT, NO_FEED)) and not refused(written(RIGHT, RIGHT))


def test_programs_that_linuxcnc_cannot_read_are_read_as_their_own_machine_does() -> None:
    marlin = [line for line in RIGHT[1:] if line != "M2"]
    g21 = ["; for marlin: Marlin 2", "G21", "G90", *marlin, "; end of the program"]
    assert not refused(written(g21, by="marlin"))
    assert not misread(written(g21, by="marlin"))
    assert (
        "test 1: check, as marlin reads it" in misread(written([*g21, "G64"], by="marlin"))[0]
    )
    assert "breaks off" in misread(written(g21[:-1], by="marlin"))[0]
    (told,) = misread(written(RIGHT, NO_CIRCLE, by="grbl-router"))
    assert told.startswith("test 2: check, as grbl-router reads it")


def test_a_program_counts_once(request: pytest.FixtureRequest) -> None:
    kept = Programs()
    for _ in range(3):
        kept.add(RIGHT, machine("linuxcnc"))
    kept.add(RIGHT, machine("grbl-router"))
    assert len(kept.written) == 2
    assert all(each.test == request.node.nodeid for each in kept.written.values())
