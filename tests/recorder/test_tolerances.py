"""The stated tolerance, measured on the program file itself: what the words, lines and steps in it say.

The recorder's own report is not asked. 30 mm of waves are recorded at many tolerances, so close to each other
that a recorder with a larger tolerance of its own takes a coarser program somewhere.
"""

from __future__ import annotations

from pathlib import Path as FilePath

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.contour import distances_mm
from morfax.motion.faults import MotionFault
from morfax.motion.motion import Path
from morfax.player.cubics.interpolator import CubicInterpolator
from morfax.player.gcode.machine_reader import read_program
from morfax.player.steps.stepping import decode, pulses_of
from morfax.recorder.cubics import file as cubic_file
from morfax.recorder.cubics.cubics import record_cubics
from morfax.recorder.gcode.blocks import record_blocks
from morfax.recorder.steps import file as step_file
from morfax.recorder.steps.file import StepFormat
from morfax.recorder.steps.steps import record_steps
from tests.recorder.gcode.runs import run_of

UM = 1e-3
DRAWN_UM = 1.0  # sagitta of the arcs as `run_of` draws them
COUNTED_UM = 0.01  # the waves are given as chords of 10 um: sagitta below 0.02 um


def waves() -> Path:
    """Bends of many radii and no corner, 10 mm/s."""
    t = np.linspace(0, 1, 4001)
    y_mm = 2 * np.sin(5 * np.pi * t) + 0.6 * np.sin(14 * np.pi * t + 1)
    xyz_mm = np.column_stack([30 * t, y_mm, 0 * t])
    lengths_mm = np.linalg.norm(np.diff(xyz_mm, axis=0), axis=1)
    return Path(np.r_[0.0, np.cumsum(lengths_mm)] / 10, xyz_mm)


def off_um(places_mm: Array) -> float:
    """The largest distance of some places from the waves, um."""
    return float(distances_mm(places_mm[:, :2], waves().positions_mm[:, :2]).max()) / UM


def interpolated_mm(file: FilePath) -> Array:
    """The places through which the words of a cubic program lead."""
    program = cubic_file.read_program(file)
    points, start = program.format.points, np.array(program.checks[0])
    ran = CubicInterpolator(start, points, program.format.linear).run(program.words) / points**3
    return np.vstack([start, ran]) / program.format.counts_per_mm


def interval_ends_mm(file: FilePath) -> Array:
    """The places at the ends of the intervals of a step program."""
    program = step_file.read_program(file)
    counts, _ = decode(program)
    steps = np.cumsum(pulses_of(counts, program.format.rates), axis=0)
    return np.array(program.format.start_mm) + steps * program.format.step_mm


@pytest.mark.parametrize("tolerance_um", [None, 1.2, 2, 3, 5, 8, 12, 20, 30, 50])
def test_a_cubic_program_keeps_its_tolerance(
    tmp_path: FilePath, tolerance_um: float | None
) -> None:
    asked_mm = None if tolerance_um is None else tolerance_um * UM
    record_cubics(waves(), tmp_path / "a.cubic", tolerance_mm=asked_mm)
    stated_um = tolerance_um or 2.0  # docs/background/sea.md
    assert off_um(interpolated_mm(tmp_path / "a.cubic")) <= stated_um + COUNTED_UM


@pytest.mark.parametrize("tolerance_um", [5, 10, 30])
def test_a_block_program_keeps_its_tolerance(tmp_path: FilePath, tolerance_um: float) -> None:
    # 10 um is the default
    how = {} if tolerance_um == 10 else {"tolerance_mm": tolerance_um * UM}
    record_blocks(waves(), tmp_path / "a.ngc", **how)
    run_mm = np.vstack(run_of(read_program(tmp_path / "a.ngc")))
    assert off_um(run_mm) <= tolerance_um + DRAWN_UM


@pytest.mark.parametrize("tolerance_um", [6, 10, 25, 80])
def test_a_step_program_keeps_its_tolerance(tmp_path: FilePath, tolerance_um: float) -> None:
    # one step of 10 um is the default
    how = {} if tolerance_um == 10 else {"tolerance_mm": tolerance_um * UM}
    record_steps(waves(), tmp_path / "a.steps", **how)
    assert off_um(interval_ends_mm(tmp_path / "a.steps")) <= tolerance_um + COUNTED_UM


def test_steps_larger_than_the_tolerance_are_refused(tmp_path: FilePath) -> None:
    """Steps of 10 um reach any place within 5 um on each axis, 7 um in all; not within 3."""
    file = tmp_path / "a.steps"
    record_steps(waves(), file, tolerance_mm=8 * UM, fmt=StepFormat(step_mm=0.01))
    assert off_um(interval_ends_mm(file)) <= 8 + COUNTED_UM
    for tolerance_um in (2, 3, 4):
        with pytest.raises(MotionFault, match=f"allowed 0.00{tolerance_um} mm"):
            record_steps(
                waves(), file, tolerance_mm=tolerance_um * UM, fmt=StepFormat(step_mm=0.01)
            )
