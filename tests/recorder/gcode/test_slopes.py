"""Tabs and ramps in G-code: Z up, along and down in lines, slopes as lines to whole depths, no faster than a
plunge.
"""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from morfax.motion import ramp
from morfax.motion.motion import Motion
from morfax.recorder.gcode.blocks import record_blocks
from morfax.recorder.gcode.plan import Feeds

_NUMBER = re.compile(r"-?\d+\.\d+")
Leg = tuple[tuple[float, float, float], float]  # to a place, mm, at a feed, mm/s


def program(tmp_path: Path, *legs: Leg, feeds: Feeds | None = None) -> list[str]:
    """The moves of a motion from 0, 0, 2 over some places, at rest at each of them."""
    places = [((0.0, 0.0, 2.0), 5.0), *legs]
    moves = [ramp.positions_mm(a, b, feed) for (a, _), (b, feed) in pairwise(places)]
    record_blocks([Motion(np.vstack(moves))], tmp_path / "a.ngc", feeds=feeds)
    lines = (tmp_path / "a.ngc").read_text().splitlines()
    begin = next(k for k, text in enumerate(lines) if text.startswith("G0 X"))
    return [
        _NUMBER.sub(_to_a_um, text) for text in lines[begin:-3]
    ]  # without check sum, M5, M2


def _to_a_um(number: re.Match[str]) -> str:
    """A place without the 0.2 um that a thinned path is off."""
    return f"{float(number[0]):.3f}".rstrip("0").rstrip(".")


def test_a_tab_is_up_at_the_feed_of_z_along_and_down(tmp_path: Path) -> None:
    text = program(
        tmp_path,
        ((0, 0, -5), 5),
        ((10, 0, -5), 10),
        ((10, 0, -4), 5),
        ((13, 0, -4), 10),
        ((13, 0, -5), 5),
        ((30, 0, -5), 10),
        ((30, 0, 2), 5),
    )
    assert text == [
        "G0 X0 Y0",
        "G1 Z-5 F300",
        "G1 X10 F600",
        "G1 Z-4 F300",
        "G1 X13 F600",
        "G1 Z-5 F300",
        "G1 X30 F600",
        "G0 Z2",
    ]


def test_a_ramp_is_one_line_to_a_whole_depth_and_to_and_fro_two(tmp_path: Path) -> None:
    """Where a ramp begins and ends, at rest, the first µm climb less than the noise of a path."""
    text = program(
        tmp_path,
        ((0, 0, 0), 5),
        ((14.31, 0, -0.75), 10),
        ((0, 0, -1.5), 10),
        ((28.62, 0, -1.5), 10),
        ((28.62, 10, -3.0), 10),
        ((28.62, 10, 2), 5),
    )
    assert [line.split(" F")[0].split(" X")[0] for line in text[1:]] == [
        "G1 Z0",
        *("G1", "G1", "G1"),
        "G1 Y10 Z-3",
        "G0 Z2",
    ]
    assert [line.split(" Z")[1].split(" ")[0] for line in text[2:4]] == ["-0.75", "-1.5"]
    ends_mm = [float(line.split(" X")[1].split(" ")[0]) for line in text[2:5]]
    assert ends_mm == pytest.approx([14.31, 0, 28.62], abs=0.01)  # the tolerance


@pytest.mark.parametrize(
    ("feeds", "slope"),
    [
        (Feeds(40.0, 2.0), "F170"),  # at 45 degrees, the root of 2 times 2 mm/s
        (Feeds(40.0), "F424"),  # the plunge of the motion, 5 mm/s
        (Feeds(1.0), "F60"),
        (None, "F90"),  # the motion's own
    ],
)
def test_a_slope_is_run_no_faster_than_a_plunge(
    tmp_path: Path, feeds: Feeds | None, slope: str
) -> None:
    text = program(
        tmp_path,
        ((0, 0, 0), 5),
        ((3, 0, -3), 1.5),
        ((13, 0, -3), 10),
        ((13, 0, 2), 5),
        feeds=feeds,
    )
    assert text[2] == f"G1 X3 Z-3 {slope}"
