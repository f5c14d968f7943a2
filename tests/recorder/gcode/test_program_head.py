"""The head of a program: its source, its size, its lines and holes, its smallest inner radius."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.motion import Path as MotionPath
from morfax.recorder.gcode.blocks import record_blocks
from morfax.recorder.gcode.made import Made
from tests.recorder.gcode.parts import part


def head_of(path: MotionPath, folder: Path, machine_name: str = "linuxcnc") -> list[str]:
    """The comments of a program."""
    file = folder / "a.ngc"
    record_blocks(
        path, file, machine_name=machine_name, made=Made("scan.png", "6 mm wide, outside")
    )
    lines = file.read_text().split("\n")
    return [line.strip("(); ") for line in lines if line.startswith(("(", ";"))]


def test_the_head_says_what_the_program_is(tmp_path: Path) -> None:
    told = head_of(part(), tmp_path)
    assert told[:4] == [
        "for linuxcnc: LinuxCNC: mill or router",
        "from scan.png",
        "tool: 6 mm wide, outside",
        "cut 30.00 x 20.00 mm, 1 line, 1 drilled hole, Z down to -3.00 mm",
    ]
    assert told[4].startswith("length 97.9 mm, about 17 s")
    assert "Z down" not in head_of(part(), tmp_path, "grbl-pen")[3]


def outline(radius_mm: float, *, hollow: bool) -> MotionPath:
    """A square of 40 mm with one corner rounded to the outside, or hollowed out."""
    turn = np.linspace(0, np.pi / 2, 60)
    cos, sin = radius_mm * np.cos(turn), radius_mm * np.sin(turn)
    bend = np.column_stack([40 - sin, 40 - cos])
    if not hollow:
        bend = np.column_stack([40 - radius_mm + cos, 40 - radius_mm + sin])
    xy = np.vstack([[(0, 0), (40, 0)], bend, [(0, 40), (0, 0)]]) + 5
    points = np.column_stack([xy, np.full(len(xy), -1.0)])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return MotionPath(np.r_[0.0, np.cumsum(steps / 10)], points)


def test_the_smallest_inner_radius_is_that_of_bends_into_the_part(tmp_path: Path) -> None:
    outward = head_of(outline(6.0, hollow=False), tmp_path)
    assert not any("inner" in line for line in outward)  # a convex part has none
    told = head_of(outline(6.0, hollow=True), tmp_path)
    assert "smallest inner radius 6.00 mm" in told


@pytest.mark.parametrize("sense", [1, -1])
def test_the_way_round_does_not_matter_and_a_sharp_inner_corner_is_told(
    sense: int, tmp_path: Path
) -> None:
    xy = [(0, 0), (40, 0), (40, 20), (20, 20), (20, 40), (0, 40), (0, 0)][::sense]
    points = np.array([(x + 5, y + 5, -1.0) for x, y in xy])
    told = head_of(MotionPath(4.0 * np.arange(len(xy)), points), tmp_path)
    assert "sharp inner corners" in told
