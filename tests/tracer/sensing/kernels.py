"""The kernels of the photocells, compiled and plain."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

WIDE_MM, AMPLITUDE_MM, APERTURE_MM = 0.7, 1.0, 0.3  # the line, sweep and cell of the vectors
FINE_MM = 0.005
COMPILED_AND_PLAIN = pytest.mark.parametrize("plain", [False, True], ids=["compiled", "plain"])


def kernel(function: Any, plain: bool) -> Callable[..., Any]:
    """A kernel as numba compiles it, or as plain Python."""
    return function.py_func if plain else function
