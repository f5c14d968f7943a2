"""The cubic recorder: points and slopes at equal intervals, exact differences, corners as stops."""

from __future__ import annotations

from pathlib import Path as FilePath

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.contour import distance
from morfax.motion.faults import MotionFault
from morfax.motion.motion import Path, thin
from morfax.motion.polyline import UM
from morfax.motion.segments import Limits, segments
from morfax.player.cubics.cubic import play_cubic
from morfax.player.cubics.interpolator import CubicInterpolator
from morfax.recorder.cubics.cubics import (
    LIMITS,
    _nearest_mm,
    _samples,
    differences,
    hermite,
    record_cubics,
)
from morfax.recorder.cubics.file import (
    CubicFormat,
    read_program,
)
from tests.recorder.steps.paths import SQUARE, circle
from tests.recorder.steps.test_steps import STAR, TOOL

SAMPLES = st.lists(
    st.tuples(*[st.tuples(st.integers(-(10**6), 10**6), st.integers(-(10**5), 10**5))] * 3),
    min_size=2,
    max_size=6,
)


@pytest.mark.parametrize(
    "path",
    [circle(10, 10), circle(1, 10), SQUARE, STAR],
    ids=["10 mm", "1 mm", "square", "star"],
)
def test_the_machine_runs_what_was_recorded(tmp_path: FilePath, path: Path) -> None:
    report = record_cubics(path, tmp_path / "a.cubic")
    assert report.deviation_mm <= 2 * UM
    found = distance(thin(play_cubic(tmp_path / "a.cubic")), path)
    assert found.hausdorff_mm <= 2 * UM + 2 * UM  # and the servo's lag round the bends


def test_a_tolerance_sets_the_interval(tmp_path: FilePath) -> None:
    reports = [
        record_cubics(circle(10, 10), tmp_path / "a.cubic", tolerance_mm=um * UM)
        for um in (50, 2, 0.6)
    ]
    intervals_s = [report.format.interval_s for report in reports]
    assert sorted(intervals_s, reverse=True) == intervals_s and intervals_s[0] > intervals_s[-1]
    for report, um in zip(reports, (50, 2, 0.6), strict=True):
        assert report.deviation_mm <= um * UM
        assert 2800 < report.format.point_rate_hz < 5700
    with pytest.raises(MotionFault, match="give a larger tolerance"):
        record_cubics(circle(10, 10), tmp_path / "b.cubic", tolerance_mm=1e-5)
    assert not (tmp_path / "b.cubic").exists()


def test_corners_are_stops(tmp_path: FilePath) -> None:
    report = record_cubics(SQUARE, tmp_path / "a.cubic")
    assert report.stops == 5
    program = read_program(tmp_path / "a.cubic")
    places = np.cumsum(program.words[..., 0], axis=0)
    assert len(places) == report.intervals
    corner = distance(thin(play_cubic(tmp_path / "a.cubic")), SQUARE).reference_to_path
    # the corner itself is reached, but for what is left of the lag
    assert corner.max_mm < 2.5 * UM


def test_the_tool_goes_down_and_up(tmp_path: FilePath) -> None:
    record_cubics(TOOL, tmp_path / "a.cubic")
    played = thin(play_cubic(tmp_path / "a.cubic"))
    assert played.positions_mm[0] == pytest.approx([3, 3, 2], abs=1 * UM)
    assert played.positions_mm[-1] == pytest.approx([9, 7, 2], abs=1 * UM)
    assert played.positions_mm[:, 2].min() == pytest.approx(-1, abs=1 * UM)


@given(SAMPLES, st.sampled_from([(2, 1), (16, 1), (32, 1), (64, 4), (16, 4), (256, 2)]))
def test_ends_and_slopes_meet_to_the_digit(rows: list, steps: tuple[int, int]) -> None:  # type: ignore[type-arg]
    """Path continuous in slope across intervals, whatever the samples; and each sample met exactly."""
    from morfax.player.cubics.interpolator import ends, slopes

    samples, (points, linear) = np.array(rows, np.int64), steps
    words = differences(samples, points, linear)
    interpolator = CubicInterpolator(samples[0, :, 0], points, linear)
    ran = interpolator.run(words)[points - 1 :: points]
    assert (ran == samples[1:, :, 0] * points**3).all()
    assert (
        np.cumsum(ends(words, points, linear), axis=0) + samples[0, :, 0] * points**3 == ran
    ).all()
    start, end = slopes(words, points, linear)
    assert (end[:-1] == start[1:]).all()
    assert (start == 6 * samples[:-1, :, 1] * points**2).all()


@given(SAMPLES)
def test_the_registers_run_along_the_closed_form(rows: list) -> None:  # type: ignore[type-arg]
    samples = np.array(rows, np.int64)
    ran = CubicInterpolator(samples[0, :, 0], 16).run(differences(samples, 16)) / 16**3
    at = np.arange(1, len(ran) + 1) / 16
    assert ran == pytest.approx(hermite(samples, at), rel=1e-12, abs=1e-6)


def test_a_program_whose_steps_are_partly_linear_ends_exactly_and_runs_coarser(
    tmp_path: FilePath,
) -> None:
    path, wide = (
        circle(1, 5),
        Limits(100, 500, spacing_mm=0.005, window_mm=0.02, corner_rad=0.2),
    )
    fine = record_cubics(path, tmp_path / "fine.cubic", fmt=CubicFormat(points=64), limits=wide)
    coarse = record_cubics(
        path, tmp_path / "coarse.cubic", fmt=CubicFormat(points=64, linear=16), limits=wide
    )
    assert coarse.format.linear == 16 and fine.format.interval_s == coarse.format.interval_s
    off = [
        distance(thin(play_cubic(report.file)), path).path_to_reference.rms_mm
        for report in (fine, coarse)
    ]
    assert off[0] < off[1] < 20 * UM


def test_what_cannot_be_recorded_is_refused(tmp_path: FilePath) -> None:
    with pytest.raises(MotionFault, match="empty"):
        record_cubics([], tmp_path / "a.cubic")
    with pytest.raises(ValueError, match="above zero"):
        record_cubics(SQUARE, tmp_path / "a.cubic", tolerance_mm=0)
    for points, linear in [(12, 1), (1, 1), (0, 1), (16, 3)]:
        with pytest.raises(ValueError, match="powers of two"):
            differences(np.zeros((2, 3, 2), np.int64), points, linear)
    assert not list(tmp_path.iterdir())


def test_a_motion_that_stands_is_a_program_without_words(tmp_path: FilePath) -> None:
    record_cubics(Path(np.array([0.0, 1]), np.array([[1.0, 2, 3]] * 2)), tmp_path / "a.cubic")
    assert thin(play_cubic(tmp_path / "a.cubic")).positions_mm[-1] == pytest.approx([1, 2, 3])


@pytest.mark.parametrize("path", [circle(10, 10), SQUARE, STAR, TOOL])
def test_the_interval_is_the_longest_that_the_tolerance_and_a_tenth_of_the_time_allow(
    tmp_path: FilePath, path: Path
) -> None:
    """It is a half, a quarter … of 0.512 s; twice as long the program would be too far off, or too slow."""
    report = record_cubics(path, tmp_path / "a.cubic", tolerance_mm=2 * UM)
    interval_s = report.format.interval_s
    halves = np.log2(0.512 / interval_s)
    assert halves == round(halves) and 0 < halves < 7
    legs = segments(path, LIMITS)
    assert report.stops == len(legs) + 1
    longest_s = 1.1 * sum(float(leg.times_s[-1]) + leg.rest_s for leg in legs)
    assert report.intervals * interval_s <= longest_s
    samples, off_mm = _samples(legs, path.positions_mm[0], 2 * interval_s, 2000.0)
    assert off_mm > 2 * UM or (len(samples) - 1) * 2 * interval_s > longest_s


def test_a_motion_s_rest_is_a_rest_of_the_program(tmp_path: FilePath) -> None:
    """Two seconds at a corner: no word moves any axis there, and the program is as much longer."""
    corner = np.array([[0.0, 0, 0], [10, 0, 0], [10, 0, 0], [10, 10, 0]])
    intervals = []
    for rest_s in (0.0, 2.0):
        path = Path(np.array([0.0, 2.0, 2.0 + rest_s, 4.0 + rest_s]), corner)
        path = path if rest_s else Path(path.t_s[[0, 1, 3]], corner[[0, 1, 3]])
        report = record_cubics(path, tmp_path / "a.cubic")
        intervals.append(report.intervals * report.format.interval_s)
        still = ~read_program(tmp_path / "a.cubic").words.any(axis=(1, 2))
        assert still.sum() * report.format.interval_s == pytest.approx(
            rest_s, abs=report.format.interval_s
        )
    assert intervals[1] - intervals[0] == pytest.approx(2.0, abs=0.1)


def test_a_program_states_where_it_is_every_64_intervals_and_at_its_ends(
    tmp_path: FilePath,
) -> None:
    """In the counts of the samples: within half a count of the path, 0.25 um."""
    report = record_cubics(circle(10, 10), tmp_path / "a.cubic", tolerance_mm=0.6 * UM)
    program = read_program(tmp_path / "a.cubic")
    assert sorted(program.checks) == [*range(0, report.intervals, 64), report.intervals]
    ran = CubicInterpolator(program.checks[0], report.format.points)
    places = ran.run(program.words)[report.format.points - 1 :: report.format.points]
    for k, stated in program.checks.items():
        if k:
            assert places[k - 1].tolist() == [mm * report.format.points**3 for mm in stated]


@pytest.mark.parametrize(("points", "modulus_per_s"), [(64, 200.0), (2, 0.5 / 0.004)])
def test_the_servo_s_time_constant_is_four_points_or_more(
    tmp_path: FilePath, points: int, modulus_per_s: float
) -> None:
    """A speed modulus of 200 per second is a time constant of 5 ms."""
    path = circle(1, 10)
    fmt = record_cubics(path, tmp_path / "a.cubic", fmt=CubicFormat(points=points)).format
    assert fmt.modulus_per_s == min(200.0, fmt.points / fmt.interval_s / 4)
    assert fmt.point_rate_hz == fmt.points / fmt.interval_s


def test_how_far_a_run_is_off_is_measured_across_the_path() -> None:
    """Against every piece of the path one by one; the run wavers by some um."""
    chance = np.random.default_rng(0)
    turn = np.linspace(0, 2 * np.pi, 200)
    places = np.column_stack([10 * np.cos(turn), 6 * np.sin(turn), 0.1 * turn])
    run = places[chance.integers(0, 199, 500)] + chance.normal(0, 5 * UM, (500, 3))
    steps = np.diff(places, axis=0)
    squared = (steps**2).sum(axis=1)
    share = ((run[:, None] - places[:-1]) * steps).sum(axis=2) / squared
    foot = places[:-1] + np.clip(share, 0, 1)[..., None] * steps
    every = np.sqrt(((run[:, None] - foot) ** 2).sum(axis=2))
    assert _nearest_mm(places, run) == pytest.approx(every.min(axis=1), abs=1e-12)


def test_a_leg_is_one_interval_at_least_and_ends_at_rest(tmp_path: FilePath) -> None:
    """A tenth of a millimetre: the slopes at both its ends are zero, in the first and the last word."""
    path = Path(np.array([0.0, 0.05]), np.array([[0.0, 0, 0], [0.1, 0, 0]]))
    report = record_cubics(path, tmp_path / "a.cubic")
    program = read_program(tmp_path / "a.cubic")
    ran = CubicInterpolator(program.checks[0], report.format.points).run(program.words)
    steps = np.diff(np.vstack([np.zeros((1, 3)), ran[:, :3]]), axis=0)[:, 0]
    assert report.intervals >= 1 and steps.min() >= 0
    assert steps[0] < 0.2 * steps.max() and steps[-1] < 0.2 * steps.max()
    assert ran[-1, 0] / report.format.points**3 == 200  # counts


def test_the_report_has_the_figures_of_the_program(tmp_path: FilePath) -> None:
    report = record_cubics(SQUARE, tmp_path / "a.cubic")
    assert report.figures == {
        "intervals": len(read_program(tmp_path / "a.cubic").words),
        "interval_s": report.format.interval_s,
        "stops": 5,
        "deviation_mm": report.deviation_mm,
    }
