"""The arc spline's least squares: the normal equations and their solution against numpy's."""

from itertools import pairwise

import numpy as np
import pytest

from morfax.recorder.gcode import normal_equations, settling
from morfax.recorder.gcode.arcs import fit
from morfax.recorder.gcode.normal_equations import BREAK_RAD
from morfax.recorder.gcode.pieces import longest_pieces, resample
from morfax.recorder.gcode.spline import ArcSpline, rows_of

TOLERANCE_MM = 0.01
# of the largest slope: what differences over 1e-7 mm leave in double precision
BY_DIFFERENCES = 1e-5


def _wavy(closed: bool) -> ArcSpline:
    """A spline of some ten segments on a wavy ring of 20 mm, or on three quarters of it."""
    angle = np.linspace(0, 2 * np.pi if closed else 1.5 * np.pi, 2000)
    radius = 20 + np.sin(5 * angle)
    places = resample(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]), 0.05)
    if closed:
        places[-1] = places[0]
    pieces = longest_pieces(places, TOLERANCE_MM)
    curved = np.ones(len(pieces), bool)
    curved[1] = False  # a line among the arcs
    return ArcSpline(places, pieces, curved)


def _seen(laid: ArcSpline, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What the spline is laid nearest to."""
    return laid.places[laid.few], laid.shares[laid.few], weights / TOLERANCE_MM


def _dense(band: np.ndarray, seam: np.ndarray) -> np.ndarray:
    """The matrix of the normal equations."""
    square = np.outer(seam, seam)
    for i, row in enumerate(band):
        for k in range(min(i + 1, len(row))):
            square[i, i - k] += row[k]
            square[i - k, i] += row[k] if k else 0.0
    return square


@pytest.mark.parametrize("closed", [False, True])
def test_the_right_side_is_the_slope_of_the_squared_residuals(closed):
    laid = _wavy(closed)
    weights = np.random.default_rng(1).uniform(0.5, 1, len(laid.few))
    seen = _seen(laid, weights)
    cost, band, pull, seam = settling.linearised(
        laid.joints, laid.halves, seen, laid.columns, laid.closed
    )
    assert laid.closed == closed == bool(seam.any())
    step = 1e-7
    costs = []
    for change in np.vstack([np.zeros(len(pull)), step * np.eye(len(pull))]):
        joints, halves = laid.joints.copy(), laid.halves.copy()
        settling.step(joints, halves, change, laid.columns)
        costs.append(settling.residuals(joints, halves, seen, laid.closed))
    assert cost == pytest.approx(float(costs[0] @ costs[0]))
    slopes = (np.array(costs[1:]) - costs[0]) / step
    largest = np.abs(slopes).max()
    assert (
        np.abs(slopes @ costs[0] - pull).max() < BY_DIFFERENCES * np.abs(pull).max() + largest
    )
    assert np.abs(_dense(band, seam) - slopes @ slopes.T).max() < BY_DIFFERENCES * largest**2


@pytest.mark.parametrize("closed", [False, True])
def test_the_solution_is_numpys(closed):
    laid = _wavy(closed)
    seen = _seen(laid, np.ones(len(laid.few)))
    _, band, pull, seam = settling.linearised(
        laid.joints, laid.halves, seen, laid.columns, laid.closed
    )
    band[:, 0] += 1e-4 * band[:, 0].mean()
    wanted = np.linalg.solve(_dense(band, seam), pull)
    found = normal_equations.solved(band.copy(), seam, pull)
    assert (
        np.abs(found - wanted).max() < 1e-6 * np.abs(wanted).max()
    )  # both lose digits to BREAK_RAD


def test_distances_are_those_from_the_circle_or_line_of_each_row():
    """By the centre, at the bend to the left of the beginning; a line has none."""
    laid = _wavy(True)
    table = settling.table_of(laid.joints, laid.halves)
    owner = settling.owners(table, laid.shares)
    x, y, heading, _, bend = rows_of(table)[owner].T
    (dx, dy), left = laid.places.T - (x, y), (-np.sin(heading), np.cos(heading))
    aside, curved = dx * left[0] + dy * left[1], bend != 0
    radius = 1 / np.where(curved, bend, 1.0)
    away = np.hypot(dx - radius * left[0], dy - radius * left[1])
    wanted = np.where(curved, np.sign(radius) * (np.abs(radius) - away), aside)
    found = normal_equations.offs(table, laid.places, owner)
    assert not curved.all() and np.abs(found - wanted).max() < 1e-9


def test_a_ring_of_waves_is_laid_within_the_tolerance_and_without_breaks():
    (chain,) = fit(_wavy(True).places, TOLERANCE_MM)
    assert chain.deviation_mm <= TOLERANCE_MM
    for one, after in pairwise(chain.segments):
        turned = after.heading_rad - one.heading_rad - one.turned_rad
        assert abs((turned + np.pi) % (2 * np.pi) - np.pi) < BREAK_RAD
