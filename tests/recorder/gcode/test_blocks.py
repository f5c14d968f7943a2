"""The block recorder: the fewest lines and arcs within a tolerance, tangent where smooth, corners kept;
RS-274 text.
"""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion.contour import distance
from morfax.motion.pathfile import read_path
from morfax.player.gcode.machine_reader import read_program
from morfax.recorder.gcode.arcs import fit
from morfax.recorder.gcode.blocks import record_blocks
from morfax.recorder.gcode.machine import TOLERANCE_MM
from morfax.recorder.gcode.normal_equations import BREAK_RAD
from morfax.recorder.gcode.pieces import (
    corners,
    longest_pieces,
    resample,
)
from morfax.recorder.gcode.spline import LineOrArc
from tests.recorder.gcode.runs import FEWEST, SAMPLES, arc, run_of

ASKED = 1.3  # times as many segments at most


def bend(points: list[tuple[float, float]]) -> np.ndarray:
    return np.array(points, np.float64)


def segments(points: np.ndarray, tolerance_mm: float = TOLERANCE_MM) -> list[list[LineOrArc]]:
    return [chain.segments for chain in fit(points, tolerance_mm)]


@pytest.mark.parametrize("name", list(FEWEST))
def test_the_samples_need_hardly_more_than_the_fewest_segments(
    name: str, tmp_path: Path
) -> None:
    path = read_path(SAMPLES / f"{name}.csv")
    chains = [chain for run in path.runs() for chain in fit(run, TOLERANCE_MM)]
    assert sum(len(chain.segments) for chain in chains) <= ASKED * FEWEST[name]
    report = record_blocks(path, tmp_path / "part.ngc")
    assert report.deviation_mm <= TOLERANCE_MM
    there_and_back = distance(run_of(read_program(report.file)), path.runs())
    # 1 um: sagitta of what is drawn out here
    assert there_and_back.hausdorff_mm <= report.deviation_mm + 0.001


def test_a_rounded_square_is_four_lines_and_four_arcs() -> None:
    sides = [
        arc(3, a, a + math.pi / 2, c)
        for a, c in zip(
            np.arange(4) * math.pi / 2, [(7, 7), (3, 7), (3, 3), (7, 3)], strict=True
        )
    ]
    points = np.vstack([[[10.0, 5.0]], *sides, [[10.0, 5.0]]])
    (chain,) = segments(points)
    assert len(chain) == 9  # the side on which it starts is in two
    assert sorted(
        round(1 / s.curvature_per_mm, 2) for s in chain if s.curvature_per_mm
    ) == pytest.approx([3.0] * 4, abs=0.02)


def test_a_circle_is_two_arcs() -> None:
    ((one, two),) = segments(arc(20, 0.3, 0.3 + 2 * math.pi))
    assert one.turned_rad + two.turned_rad == pytest.approx(2 * math.pi, abs=1e-3)
    assert 1 / one.curvature_per_mm == pytest.approx(20, abs=0.002)


def test_a_line_is_one_line() -> None:
    ((line,),) = segments(np.column_stack([np.linspace(0, 90, 500), np.linspace(0, -20, 500)]))
    assert (line.curvature_per_mm, line.end_mm) == (0.0, pytest.approx((90, -20)))


@pytest.mark.parametrize("turn_deg", [15, 36, 90, 150, 174])
def test_corners_are_kept(turn_deg: float) -> None:
    turn = math.radians(turn_deg)
    points = np.vstack(
        [
            np.linspace([-30, 0], [0, 0], 300),
            np.linspace([0, 0], [30 * math.cos(turn), 30 * math.sin(turn)], 300)[1:],
        ]
    )
    chains = segments(points)
    assert [len(chain) for chain in chains] == [1, 1]
    assert chains[1][0].begin_mm == pytest.approx((0, 0), abs=1e-9)


def test_a_bend_is_no_corner() -> None:
    assert (
        len(
            corners(
                np.vstack(
                    [
                        np.linspace([-9, -1], [0, -1], 9),
                        arc(1.0, -math.pi / 2, math.pi / 2),
                        np.linspace([0, 1], [-9, 1], 9),
                    ]
                )
            )
        )
        == 0
    )


@given(st.integers(0, 10_000))
@settings(max_examples=25)
def test_a_smooth_line_is_run_tangent_at_every_joint_within_the_tolerance(seed: int) -> None:
    random = np.random.default_rng(seed)
    t = np.linspace(0, 1, 900)
    waves = sum(
        random.uniform(0.1, 4)
        * np.sin(2 * math.pi * random.uniform(0.2, 2) * t + random.uniform(0, 6))
        for _ in range(3)
    )
    points = np.column_stack([50 * t, waves])
    (chain,) = fit(points, TOLERANCE_MM)
    for before, after in pairwise(chain.segments):
        assert before.end_mm == pytest.approx(after.begin_mm, abs=1e-9)
        jump = math.remainder(
            after.heading_rad - before.heading_rad - before.turned_rad, 2 * math.pi
        )
        assert abs(jump) <= 10 * BREAK_RAD
    assert chain.deviation_mm <= TOLERANCE_MM
    drawn = np.vstack([_drawn_segment(segment) for segment in chain.segments])
    # 1 um of sagitta, 1 um between samples
    assert distance(drawn, points).hausdorff_mm <= TOLERANCE_MM + 0.002
    fewest = len(longest_pieces(resample(points), TOLERANCE_MM))
    assert len(chain.segments) <= max(ASKED * fewest, fewest + 2)


def _drawn_segment(segment: LineOrArc) -> np.ndarray:
    return np.array(
        [
            segment.begin_mm,
            *(
                LineOrArc(
                    segment.begin_mm,
                    segment.heading_rad,
                    share * segment.length_mm,
                    segment.curvature_per_mm,
                ).end_mm
                for share in np.linspace(0, 1, 60)[1:]
            ),
        ]
    )
