"""Contour measures: known distances between known curves, and that different curves are told apart."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion import contour
from morfax.motion.contour import distance, distances_mm, length_mm, pointwise
from morfax.motion.faults import MotionFault
from morfax.motion.motion import Motion, Path

MM = 1.0
SAMPLE_MM = 0.01  # of both polylines
ROUNDING_MM = 1e-9


def circle(
    radius_mm: float, points: int, x_mm: float = 0.0, turn_rad: float = 0.0
) -> np.ndarray:
    angle = turn_rad + np.linspace(0, 2 * np.pi, points)
    return np.column_stack([x_mm + radius_mm * np.cos(angle), radius_mm * np.sin(angle)])


def resampled(run: np.ndarray, points: int) -> np.ndarray:
    """The same polyline with other points on it, its own corners kept."""
    s = np.r_[0, np.cumsum(np.hypot(*np.diff(run, axis=0).T))]
    at = np.union1d(s, np.linspace(0, s[-1], points))
    return np.column_stack([np.interp(at, s, column) for column in run.T])


def as_path(run: np.ndarray, z_mm: float = 0.0) -> Path:
    return Path(
        np.arange(len(run), dtype=float), np.column_stack([run, np.full(len(run), z_mm)])
    )


@settings(max_examples=30)
@given(st.integers(0, 10_000), st.integers(2, 5000))
def test_equal_curves_with_other_points_are_nothing_apart(seed: int, points: int) -> None:
    corners = np.random.default_rng(seed).uniform(-20, 20, (8, 2))  # crosses itself, too
    apart = distance(resampled(corners, points), corners)
    # a sample nearer than half a sample to a crossing may find four samples of the other branch nearest
    assert apart.hausdorff_mm <= SAMPLE_MM / 2
    assert apart.path_to_reference.rms_mm <= 0.02 * SAMPLE_MM


def test_a_place_on_a_line_is_on_it_though_a_sample_of_another_line_is_nearer() -> None:
    line, beside = np.array([[0.0, 0], [10, 0]]), np.array([[0.005, 0.004], [0.005, 5]])
    assert distances_mm(np.array([[0.005, 0.0]]), [line, beside])[0] <= ROUNDING_MM


def test_concentric_circles_are_their_radii_apart() -> None:
    apart = distance(circle(20.05, 20_001), circle(20.0, 20_001))
    sagitta_mm = 20 * (np.pi / 20_000) ** 2 / 2  # of the polylines
    for summary in (apart.path_to_reference, apart.reference_to_path):
        assert summary.rms_mm == pytest.approx(0.05, abs=2 * sagitta_mm)
        assert summary.p95_mm == pytest.approx(0.05, abs=2 * sagitta_mm)
        assert summary.max_mm == pytest.approx(0.05, abs=2 * sagitta_mm)
    assert apart.hausdorff_mm == pytest.approx(0.05, abs=2 * sagitta_mm)


def test_a_shifted_circle_is_off_by_a_cosine() -> None:
    shift_mm = 0.1
    apart = distance(circle(20, 10_001, x_mm=shift_mm), circle(20, 10_001)).path_to_reference
    second_order_mm = shift_mm**2 / 20
    assert apart.max_mm == pytest.approx(shift_mm, abs=second_order_mm)
    assert apart.rms_mm == pytest.approx(shift_mm / np.sqrt(2), abs=second_order_mm)
    assert apart.p95_mm == pytest.approx(
        shift_mm * np.sin(0.95 * np.pi / 2), abs=second_order_mm
    )


def test_what_the_path_misses_shows_on_the_way_back_only() -> None:
    line = np.array([[0.0, 0.0], [100.0, 0.0]])
    apart = distance(line * [0.9, 1], line)
    assert apart.path_to_reference.max_mm <= ROUNDING_MM
    assert apart.reference_to_path.max_mm == pytest.approx(10 * MM)
    assert apart.hausdorff_mm == pytest.approx(10 * MM)
    # a tenth of the length is 0 ... 10 mm off: mean of squares 0.1 · 10² / 3
    assert apart.reference_to_path.rms_mm == pytest.approx(np.sqrt(10 / 3), abs=SAMPLE_MM)
    assert apart.reference_to_path.p95_mm == pytest.approx(5 * MM, abs=2 * SAMPLE_MM)


def test_many_points_in_one_place_weigh_no_more_than_their_length() -> None:
    line = np.array([[0.0, 0.0], [100.0, 0.0]])
    crowded = np.vstack(
        [np.column_stack([np.linspace(0, 0.001, 50_000), np.full(50_000, 1.0)]), line]
    )
    assert distance(crowded, line).path_to_reference.rms_mm < 0.1 * MM


def test_a_corner_cut_is_found_at_its_apex() -> None:
    corner = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]])
    cut = np.array([[0.0, 0.0], [9.0, 0.0], [10.0, 1.0], [10.0, 10.0]])
    apart = distance(cut, corner)
    assert apart.reference_to_path.max_mm == pytest.approx(np.sqrt(0.5) * MM, abs=ROUNDING_MM)
    assert apart.path_to_reference.max_mm == pytest.approx(0.5 * MM, abs=SAMPLE_MM)


def test_nothing_bridges_two_runs() -> None:
    runs = [np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([[9.0, 0.0], [10.0, 0.0]])]
    whole = np.array([[0.0, 0.0], [10.0, 0.0]])
    assert distance(runs, whole).reference_to_path.max_mm == pytest.approx(
        4 * MM, abs=SAMPLE_MM
    )
    assert length_mm(runs) == pytest.approx(2 * MM)


def test_only_what_is_in_the_work_counts() -> None:
    path = Path(
        np.arange(4.0), np.array([[0, 5, 2.0], [0, 0, 2.0], [0, 0, -3.0], [10, 0, -3.0]])
    )
    line = np.array([[0.0, 0.0], [10.0, 0.0]])
    assert distance(path, line).hausdorff_mm <= ROUNDING_MM
    assert length_mm(path) == pytest.approx(10 * MM)
    assert distance(Motion(path.positions_mm), path).hausdorff_mm <= ROUNDING_MM


def test_the_error_at_each_point() -> None:
    points, error_mm = pointwise(circle(20, 5001, x_mm=0.1), circle(20, 5001))
    assert points.shape == (len(error_mm), 2)
    expected_mm = np.abs(np.hypot(*points.T) - 20)
    assert (
        np.abs(error_mm - expected_mm).max() < 20 * (np.pi / 5000) ** 2
    )  # twice the polyline's sagitta


def test_length_of_a_circle() -> None:
    ring = circle(20, 10_001)
    assert length_mm(ring) == pytest.approx(2 * np.pi * 20, rel=(np.pi / 10_000) ** 2)


@settings(max_examples=30)
@given(st.floats(-50, 50), st.floats(-50, 50), st.floats(0, 7))
def test_a_distance_does_not_depend_on_where_the_sheet_lies(
    x_mm: float, y_mm: float, turn_rad: float
) -> None:
    path, reference = (
        circle(5, 200),
        resampled(np.array([[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0]]), 10),
    )
    turn = np.array(
        [[np.cos(turn_rad), -np.sin(turn_rad)], [np.sin(turn_rad), np.cos(turn_rad)]]
    )
    here, there = (
        distance(path, reference),
        distance(path @ turn + [x_mm, y_mm], reference @ turn + [x_mm, y_mm]),
    )
    assert there.hausdorff_mm == pytest.approx(here.hausdorff_mm, abs=1e-6 * MM)
    assert there.path_to_reference.rms_mm == pytest.approx(
        here.path_to_reference.rms_mm, abs=1e-6 * MM
    )


def test_a_very_long_path_is_sampled_further_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("morfax.motion.contour.LARGEST_SAMPLES", 1000)
    line = np.array([[0.0, 0.0], [1e6, 0.0]])
    points, error_mm = pointwise(line + np.array([0, 0.5]), line)
    assert len(points) <= 1002
    assert error_mm == pytest.approx(0.5 * MM)


def test_a_single_point_has_a_distance() -> None:
    apart = distance(np.array([[3.0, 4.0]]), np.array([[0.0, 0.0]]))
    assert apart.hausdorff_mm == apart.path_to_reference.rms_mm == 5 * MM


def test_how_far_a_long_comparison_is_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contour, "AT_ONCE", 1000)
    told = list[float]()
    distance(circle(2, 2000), circle(2.1, 2000), told.append)
    assert len(told) > 4 and told == sorted(told)
    assert told[0] == 0.0 and 0.5 in told and told[-1] < 1.0


def test_what_is_no_contour() -> None:
    line = np.array([[0.0, 0.0], [1.0, 0.0]])
    with pytest.raises(MotionFault, match="never has its tool in the work"):
        distance(as_path(line, z_mm=2.0), line)
    for wrong in (np.zeros((3, 3)), np.zeros(4), np.zeros((0, 2)), line * np.nan):
        with pytest.raises(ValueError, match="no polyline"):
            length_mm(wrong)
    with pytest.raises(ValueError, match="empty"):
        length_mm([])


def test_figures_print_in_one_line() -> None:
    line = np.array([[0.0, 0.0], [1.0, 0.0]])
    assert "Hausdorff 0.5000 mm" in str(distance(line + np.array([0, 0.5]), line))
