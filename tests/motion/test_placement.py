"""Mirror, scale and turn: about which point, in which sense, and back again."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.motion import Motion, Path, join
from morfax.motion.placement import Placement

# X, Y, Z and a further axis, mm
L_SHAPE = np.array([[10.0, 5, 2, 7], [14, 5, -3, 8], [14, 7, -3, 9]])
WHOLE = st.floats(-1e3, 1e3, allow_nan=False)


def placed(placement: Placement) -> list[list[float]]:
    return (
        join(placement.stream([Motion(L_SHAPE[:1]), Motion(L_SHAPE[1:])]))
        .positions_mm[:, :2]
        .round(12)
        .tolist()
    )


@pytest.mark.parametrize(
    ("placement", "expected"),
    [
        (Placement("x"), [[10, 5], [6, 5], [6, 7]]),
        (Placement("y"), [[10, 5], [14, 5], [14, 3]]),
        (Placement(scale=2), [[10, 5], [18, 5], [18, 9]]),
        (Placement(turn_rad=math.pi / 2), [[10, 5], [10, 9], [8, 9]]),
        (
            Placement("x", 2, math.pi / 2),
            [[10, 5], [10, -3], [6, -3]],
        ),  # mirrored first, then turned
        (Placement("x", about_mm=(0, 0)), [[-10, 5], [-14, 5], [-14, 7]]),
    ],
)
def test_about_the_start_unless_another_point_is_given(
    placement: Placement, expected: list[list[float]]
) -> None:
    assert placed(placement) == expected


def test_z_and_further_axes_stay() -> None:
    moved = join(Placement("y", 3, 1).stream([Motion(L_SHAPE)])).positions_mm
    assert np.array_equal(moved[:, 2:], L_SHAPE[:, 2:])


def test_nothing_asked_for_is_the_stream_itself() -> None:
    stream = [Motion(L_SHAPE)]
    assert Placement().stream(stream) is stream
    assert Placement(turn_rad=2 * math.pi).is_plain


@given(
    st.sampled_from(["", "x", "y"]),
    st.floats(0.01, 100),
    st.floats(-10, 10),
    st.tuples(WHOLE, WHOLE),
)
def test_a_path_comes_back(
    mirror: str, scale: float, turn_rad: float, about_mm: tuple[float, float]
) -> None:
    path = Path(np.arange(3.0), L_SHAPE)
    placement = Placement(mirror, scale, turn_rad, about_mm)
    # float64 keeps 1e-16 of 1e5 mm, a few roundings
    assert np.abs(placement.back(placement.path(path)).positions_mm - L_SHAPE).max() < 1e-8
    legs = [
        np.linalg.norm(np.diff(p.xy_mm, axis=0), axis=1) for p in (path, placement.path(path))
    ]
    assert legs[1] == pytest.approx(scale * legs[0], rel=1e-9)


def test_wrong_settings() -> None:
    with pytest.raises(ValueError, match="give x or y"):
        Placement("z")
    with pytest.raises(ValueError, match="above zero"):
        Placement(scale=0)
