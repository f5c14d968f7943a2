"""The photocells against closed forms: a swept cell on a straight line, edges, rings and the way felt along a
line.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.sensing import photocell, ray
from tests.tracer.inked import UM
from tests.tracer.sensing.kernels import (
    AMPLITUDE_MM,
    APERTURE_MM,
    COMPILED_AND_PLAIN,
    FINE_MM,
    WIDE_MM,
    kernel,
)


@pytest.fixture(scope="module")
def behind(strip: Drawing) -> photocell.Cells:
    return photocell.behind_aperture(strip, APERTURE_MM)


def swept(
    cells: photocell.Cells, offset_mm: float, plain: bool = False, samples: int = 4000
) -> tuple[float, float]:
    """Fundamental and mean of a sweep centred so far to the left of the line."""
    middle = np.array([0.6, 3.0])
    return kernel(photocell.sweep, plain)(
        cells, middle, 0.0, (offset_mm, AMPLITUDE_MM), samples
    )


def point_cell(offset_mm: float) -> float:
    """b1 = (2/pi)(sqrt(1-s1²) - sqrt(1-s2²)), s = (±w/2 - e)/A clipped to ±1: the vectors' closed form."""
    s1, s2 = (
        min(max((edge - offset_mm) / AMPLITUDE_MM, -1), 1)
        for edge in (-WIDE_MM / 2, WIDE_MM / 2)
    )
    return 2 / math.pi * (math.sqrt(1 - s1 * s1) - math.sqrt(1 - s2 * s2))


# the swept cell


@COMPILED_AND_PLAIN
def test_a_swept_point_cell_sees_the_closed_form(
    strip: Drawing, vectors: Callable[[str], Any], plain: bool
) -> None:
    cells = photocell.Cells(strip.darkness, strip.pitch_mm, photocell.LEVEL)
    for row in vectors("mf_scan")["rows"]:
        offset_mm = row["offset_mm"]
        assert point_cell(offset_mm) == pytest.approx(row["point_cell_closed_form"], abs=1e-5)
        # pixels of 5 um make an edge a ramp of that; where it stands at the turn of the sweep (0.65 mm), that
        # is 0.1 of the sweep's time
        share = 0.03 if abs(abs(offset_mm) - 0.65) < 0.01 else 0.003
        assert swept(cells, offset_mm, plain)[0] == pytest.approx(
            row["point_cell_closed_form"], abs=share
        )


def test_a_swept_cell_with_an_aperture_sees_the_vectors(
    behind: photocell.Cells, vectors: Callable[[str], Any]
) -> None:
    """The vectors' aperture is a disc of 0.3 mm, ours a Gaussian of the same variance: 3 % of the peak of
    0.566 apart.
    """
    for row in vectors("mf_scan")["rows"]:
        assert swept(behind, row["offset_mm"])[0] == pytest.approx(row["first_sin"], abs=0.017)


def swung(cells: photocell.Cells, places_mm: np.ndarray) -> np.ndarray:
    """Fourier parts of what the cell sees on a swing: cosine and sine, of the first and second order."""
    angle = 2 * np.pi * (np.arange(len(places_mm)) + 0.5) / len(places_mm)
    seen = np.array([photocell.darkness_at(cells, 0.6, 3.0 + place) for place in places_mm])
    return np.array(
        [2 * (seen * wave(n * angle)).mean() for n in (1, 2) for wave in (np.cos, np.sin)]
    )


ANGLES = 2 * np.pi * (np.arange(4000) + 0.5) / 4000


def test_a_centred_swing_has_the_second_harmonic_alone(
    behind: photocell.Cells, vectors: Callable[[str], Any]
) -> None:
    """What the filter FSA rejects; our Gaussian aperture against the vectors' disc: 5 % of 0.41 apart."""
    for row in vectors("mf_scan")["rows"]:
        places = row["offset_mm"] + AMPLITUDE_MM * np.sin(ANGLES)
        first_cos, first_sin, second_cos, second_sin = swung(behind, places)
        assert first_cos == pytest.approx(row["first_cos"], abs=1e-3)
        assert first_sin == pytest.approx(row["first_sin"], abs=0.02)
        assert second_cos == pytest.approx(row["second_cos"], abs=0.02)
        assert second_sin == pytest.approx(row["second_sin"], abs=1e-3)


def test_a_swing_that_is_an_ellipse_shifts_the_phase_and_not_the_place(
    behind: photocell.Cells, vectors: Callable[[str], Any]
) -> None:
    """Swung along the line as well, over a line at an angle: the carrier turns, the signal gets smaller."""
    told = vectors("mf_scan")["elliptical"]
    for row in told["rows"]:
        along = told["Ax"] * np.cos(ANGLES) * math.tan(math.radians(row["psi_deg"]))
        places = told["e"] + AMPLITUDE_MM * np.sin(ANGLES) + along
        first_cos, first_sin, *_ = swung(behind, places)
        assert [-first_cos, first_sin] == pytest.approx(row["first"], abs=0.002)
        turned_deg = math.degrees(math.atan2(first_cos, -first_sin))
        assert abs(turned_deg) == pytest.approx(row["expected_carrier_phase_deg"], abs=0.5)
        assert 180 - abs(turned_deg) == pytest.approx(abs(row["measured_phase_deg"]), abs=0.5)
        centred = swung(behind, places - told["e"])
        assert abs(centred[:2]).max() < 1e-3  # no false offset


def test_the_fundamental_is_odd_and_the_mean_even(behind: photocell.Cells) -> None:
    assert abs(swept(behind, 0.0)[0]) < 1e-6  # float32 darkness
    for offset_mm in np.linspace(0.05, 1.6, 32):
        left, right = swept(behind, offset_mm), swept(behind, -offset_mm)
        assert left[0] == pytest.approx(-right[0], abs=1e-6)
        assert left[1] == pytest.approx(right[1], abs=1e-6)
        assert left[0] < 1e-6  # the head stands to the left, the line is on its right


def test_the_signal_is_linear_then_monotonic_then_gone(behind: photocell.Cells) -> None:
    """The facts stated with the vectors: linear within 15 % to 0.4 mm, monotonic to 0.79 mm, gone beyond 1.5
    mm.

    Monotonic to 0.79 mm is with a disc; the Gaussian's skirts bring the peak 0.03 mm nearer.
    """
    slope = (swept(behind, -0.02)[0] - swept(behind, 0.02)[0]) / 0.04
    assert slope == pytest.approx(0.484, rel=0.01)  # numeric with a disc, in the vectors
    for offset_mm in np.linspace(0.05, 0.4, 8):
        assert -swept(behind, offset_mm)[0] == pytest.approx(slope * offset_mm, rel=0.15)
    rising = [-swept(behind, offset_mm)[0] for offset_mm in np.linspace(0, 0.76, 50)]
    assert np.all(np.diff(rising) > 0)
    # amplitude + half the line + half the aperture = 1.5 mm; the Gaussian's skirt there is 1/40 of a cell's
    # light
    assert swept(behind, 1.5)[0] == pytest.approx(0, abs=0.005) and swept(behind, 1.6)[
        0
    ] == pytest.approx(0, abs=3e-4)
    assert swept(behind, 1.7)[1] < 3e-4


def test_the_mean_falls_when_the_line_goes(behind: photocell.Cells) -> None:
    on_it = swept(behind, 0.0)[1]
    assert on_it == pytest.approx(
        2 / math.pi * math.asin(WIDE_MM / 2 / AMPLITUDE_MM), abs=0.005
    )  # share of the time
    assert swept(behind, 1.6)[1] < 0.01 * on_it


# a cell at a place


@COMPILED_AND_PLAIN
def test_a_cell_reads_pixels_in_sheet_coordinates(plain: bool) -> None:
    """Pixel i covers [i, i+1) pitches; rows run down, Y up; straight in between; paper outside."""
    read = kernel(photocell.darkness_at, plain)
    ramp = np.arange(12, dtype=np.float32).reshape(3, 4) / 12
    cells = photocell.Cells(ramp, 0.1, 0.5)
    assert read(cells, 0.05, 0.25) == 0.0
    assert read(cells, 0.15, 0.15) == pytest.approx(5 / 12)  # second of the second row
    assert read(cells, 0.20, 0.15) == pytest.approx(5.5 / 12)
    assert read(cells, 0.15, 0.10) == pytest.approx(7 / 12)
    for x_mm, y_mm in ((-1, 0.1), (5, 0.1), (0.1, -1), (0.1, 5), (1e9, -1e9)):
        assert read(cells._replace(darkness=np.ones_like(ramp)), x_mm, y_mm) == 0.0


def test_an_aperture_narrower_than_a_pixel_changes_nothing(strip: Drawing) -> None:
    assert photocell.behind_aperture(strip, 0.003).darkness is strip.darkness


def test_an_aperture_keeps_the_ink(strip: Drawing, behind: photocell.Cells) -> None:
    assert behind.darkness.sum() == pytest.approx(strip.darkness.sum(), rel=1e-4)


# edges


def analytic(offset_mm: float, heading: float) -> NDArray[np.float32]:
    """Soft ink of a line of 0.5 mm at a distance to the left of (3, 3) mm, on 6 x 6 mm at 300 dpi, by its
    closed form.
    """
    from scipy.special import erf

    pitch = 25.4 / 300
    at = (np.arange(round(6 / pitch)) + 0.5) * pitch
    x, y = np.meshgrid(at, at[::-1] + (6 - at[-1] - at[0]))
    aside = -(x - 3) * math.sin(heading) + (y - 3) * math.cos(heading) - offset_mm
    sigma = math.hypot(0.05, 0.0375, pitch / math.sqrt(12)) * math.sqrt(
        2
    )  # lens, aperture and pixel
    return np.asarray(
        (erf((aside + 0.25) / sigma) - erf((aside - 0.25) / sigma)) / 2, np.float32
    )


@COMPILED_AND_PLAIN
@settings(max_examples=30)
@given(offset_mm=st.floats(-0.3, 0.3), heading=st.floats(-math.pi, math.pi))
def test_a_straight_line_s_edges_are_where_they_are_at_any_heading_and_place(
    plain: bool, offset_mm: float, heading: float
) -> None:
    height = analytic(0, 0).shape[0] * 25.4 / 300
    place = 3.0, 3.0 - (6 - height)
    find = kernel(ray.edges, plain)
    cells = photocell.Cells(analytic(offset_mm, heading), 25.4 / 300, 0.5)
    right, left = find(cells, *place, heading, 1.0)
    # straight between pixels of 85 um, an edge 0.1 mm soft is off by up to 3 um; both are off alike, away
    # from the ink
    assert left - right == pytest.approx(0.5, abs=8 * UM)
    assert (left + right) / 2 == pytest.approx(offset_mm, abs=3 * UM)


@COMPILED_AND_PLAIN
def test_edges_that_are_not_there_are_nan(strip: Drawing, plain: bool) -> None:
    find = kernel(ray.edges, plain)
    cells = photocell.Cells(strip.darkness, FINE_MM, 0.5)
    assert np.isnan(find(cells, 0.6, 5.0, 0.0, 0.8)).all()  # no ink within half the reach
    right, left = find(cells, 0.6, 3.1, 0.0, 0.3)
    assert math.isnan(right) and left == pytest.approx(
        0.25, abs=FINE_MM
    )  # 0.45 mm to the right is out of reach


def test_an_edge_costs_one_look_at_each_place_across(monkeypatch: pytest.MonkeyPatch) -> None:
    """The line is looked for within half the reach, and its edges are in what was seen there."""
    looks = list[tuple[float, float]]()

    def counted(cells: photocell.Cells, x_px: float, y_px: float) -> float:
        looks.append((x_px, y_px))
        return float(photocell.darkness_on.py_func(cells, x_px, y_px))

    monkeypatch.setattr(ray, "darkness_on", counted)
    cells = photocell.Cells(analytic(0.1, 0.0), 25.4 / 300, 0.5)
    right, left = ray.edges_beside.py_func(cells, (3.0, 3.0), (1.0, 0.0), 1.2)
    assert left - right == pytest.approx(0.5, abs=8 * UM)
    steps = round(0.5 * 1.2 / (photocell.STEP_PX * cells.pitch_mm))  # to either side
    assert len(set(looks)) == len(looks) <= 2 * steps + 2


def two_lines(darker: float) -> photocell.Cells:
    """A line of 0.3 mm along X at (3, 3) mm, and one above it that is as far away as both are wide."""
    lines = analytic(0.0, 0.0) * 0.8
    return photocell.Cells(np.maximum(lines, darker * analytic(0.9, 0.0)), 25.4 / 300, 0.4)


@COMPILED_AND_PLAIN
@pytest.mark.parametrize(("darker", "middle_mm"), [(0.7, 0.0), (1.0, 0.9)])
def test_edges_are_those_of_the_darkest_place(
    plain: bool, darker: float, middle_mm: float
) -> None:
    height_mm = len(analytic(0, 0)) * 25.4 / 300
    find = kernel(ray.edges, plain)
    for heading in (0.0, math.pi):  # the other line to the left, and to the right
        right, left = find(two_lines(darker), 3.0, height_mm - 3.0, heading, 2.2)
        aside_mm = middle_mm * math.cos(heading)
        assert (left + right) / 2 == pytest.approx(aside_mm, abs=20 * UM)
        assert left - right == pytest.approx(0.5, abs=40 * UM)
