"""The running time of a program: closed forms, and what LinuxCNC's simulation took for four programs."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.pathfile import read_path
from morfax.recorder.gcode.blocks import record_blocks
from morfax.recorder.gcode.machine import Machine, machine
from morfax.recorder.gcode.plan import Feeds
from morfax.recorder.gcode.program_text import Block
from morfax.recorder.gcode.running_time import running_time_s

SAMPLES = Path(__file__).parents[3] / "samples"
PLAIN = Machine(
    "plain", "", rapid_mm_s=(50, 50, 20), acceleration_mm_s2=(500, 500, 200), corner_mm=0.01
)
START = np.zeros(3)
EXACT = 1e-9


def line(x: float, y: float, z: float = 0.0, code: str = "G1", feed: float = 10.0) -> Block:
    """A line to a place."""
    return Block(code, (x, y, z), feed_mm_s=feed)


def test_one_line_speeds_up_runs_and_brakes() -> None:
    # 100 mm at 10 mm/s, and one ramp's worth of time, v/a
    assert running_time_s(START, [line(100, 0)], PLAIN) == pytest.approx(
        10 + 10 / 500, rel=EXACT
    )
    # 0.1 mm is too short for 10 mm/s: a triangle, 2 sqrt(s/a)
    short_s = 2 * math.sqrt(0.1 / 500)
    assert running_time_s(START, [line(0.1, 0)], PLAIN) == pytest.approx(short_s, rel=EXACT)


def test_a_line_cut_in_parts_takes_no_longer() -> None:
    parts = [line(x, 0) for x in range(1, 101)]
    whole = running_time_s(START, [line(100, 0)], PLAIN)
    assert running_time_s(START, parts, PLAIN) == pytest.approx(whole, rel=1e-6)


def test_a_corner_is_run_at_the_speed_that_rounds_it_off() -> None:
    # a right angle: b = 45 degrees, r = corner sin b / (1 - sin b)
    sin = math.sqrt(0.5)
    corner_mm_s = math.sqrt(500 * 0.01 * sin / (1 - sin))
    expected = 2 * (
        10 + (2 * 10 - corner_mm_s) / 500 - (2 * 100 - corner_mm_s**2) / (2 * 500) / 10
    )
    found = running_time_s(START, [line(100, 0), line(100, 100)], PLAIN)
    assert found == pytest.approx(expected, rel=1e-6)
    back = running_time_s(START, [line(100, 0), line(0, 0)], PLAIN)
    assert back == pytest.approx(2 * (10 + 10 / 500), rel=1e-6)  # round about: a stop


def test_no_axis_runs_faster_than_its_own_speed() -> None:
    up = running_time_s(START, [line(0, 0, 20, "G0")], PLAIN)
    assert up == pytest.approx(20 / 20 + 20 / 200, rel=EXACT)
    # X and Y at 50 mm/s each, accelerated at 500 each
    root = math.sqrt(2)
    askew = running_time_s(START, [line(100, 100, 0, "G0")], PLAIN)
    assert askew == pytest.approx(2 + (50 * root) / (500 * root), rel=EXACT)
    fast = running_time_s(START, [line(100, 0, feed=1000)], PLAIN)
    assert fast == pytest.approx(2 + 50 / 500, rel=EXACT)


def test_a_small_circle_is_run_no_faster_than_it_can_be_turned() -> None:
    circle = Block("G3", (0, 0, 0), (0.1, 0.0), 50.0)
    fastest = math.sqrt(math.sqrt(3) / 2 * 500 * 0.1)
    assert running_time_s(START, [circle], PLAIN) > 2 * math.pi * 0.1 / fastest


def test_dwells_count_wherever_they_stand() -> None:
    wanted = replace(PLAIN, begin=("M3", "G4 P2000"), dwell_unit_s=1e-3)
    words = Block("words", (0, 0, 0), words=("M5", "G4 P200"))
    blocks = [Block("G4", (0, 0, 0), dwell_s=1.0), words]
    assert running_time_s(START, blocks, wanted) == pytest.approx(3.2, rel=EXACT)


def test_a_torch_in_a_hole_is_slower() -> None:
    torch = machine("qtplasmac")
    slow = [Block("words", (0, 0, 0), words=("M67 E3 Q60",)), line(100, 0)]
    whole, slower = (running_time_s(START, b, torch) for b in (slow[1:], slow))
    assert slower / whole == pytest.approx(1 / 0.6, rel=0.05)  # ramps aside


@pytest.mark.parametrize(
    ("name", "feed_mm_s", "took_s"),
    [
        # took: LinuxCNC 2.9's simulation (milltask, motmod) with this machine's speeds and accelerations,
        # from the program's start on (python -m benchmarks linuxcnc)
        ("bracket", None, 33.73),
        ("bracket", 40.0, 11.97),
        ("gear", 40.0, 7.76),
        ("program", None, 29.01),
    ],
)
def test_the_time_is_that_of_linuxcnc_s_simulation(
    name: str, feed_mm_s: float | None, took_s: float, tmp_path: Path
) -> None:
    path, feeds = read_path(SAMPLES / f"{name}.csv"), Feeds(feed_mm_s)
    report = record_blocks(path, tmp_path / "a.ngc", feeds=feeds)
    assert report.duration_s == pytest.approx(took_s, rel=0.07)
