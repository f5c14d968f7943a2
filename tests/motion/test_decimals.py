"""Rows of numbers as text: what Python's own formatting makes of the same rounded numbers."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion import decimals as organ
from morfax.motion.decimals import lines_of

DECIMALS = [7, 5, 0, 5]


@pytest.fixture(params=[False, True], ids=["kernel", "plain"], autouse=True)
def _kernel(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """The compiled kernel, and plain Python."""
    if request.param:
        monkeypatch.setattr(organ, "_write", organ._write.py_func)


def formatted(numbers: np.ndarray) -> str:
    """The lines by Python's own formatting."""
    rounded = [np.round(numbers[:, at], many) + 0.0 for at, many in enumerate(DECIMALS)]
    return "".join(
        f"{t:.7f},{x:.5f},{tool:.0f},{y:.5f}\n" for t, x, tool, y in zip(*rounded, strict=True)
    )


@pytest.mark.parametrize("size", [1e-6, 1e-4, 0.1, 30.0, 1e4, 1e8])
def test_random_numbers(size: float) -> None:
    numbers = np.random.default_rng(1).normal(0, size, (200, 4))
    assert lines_of(numbers, DECIMALS) == formatted(numbers)


def test_zeros_have_no_sign_and_halves_are_rounded_to_even() -> None:
    numbers = np.array(
        [
            [0.0, -0.0, 1.0, -4e-6],
            [1e-7, 0.5e-5, 0.0, -1.5e-5],
            [9.99999996, 99.999996, 0, 1e-5],
        ]
    )
    assert lines_of(numbers, DECIMALS) == formatted(numbers)
    assert lines_of(numbers[:1], DECIMALS) == "0.0000000,0.00000,1,0.00000\n"


@pytest.mark.parametrize("odd", [np.nan, np.inf, -np.inf, 1e12, -3e15])
def test_what_has_no_such_decimals_is_left_to_python(odd: float) -> None:
    numbers = np.array([[1.0, 2.0, 0.0, 3.0], [1.5, odd, 1.0, 3.0]])
    assert lines_of(numbers, DECIMALS) == formatted(numbers)


def test_no_rows_are_no_text() -> None:
    assert lines_of(np.zeros((0, 4)), DECIMALS) == ""
