"""Patent US 3062995 (SEA, Raymond and Jeudon, 1957): its coarse and its fine scale by the tables."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from morfax.player.cubics.cubic import HISTORIC
from morfax.player.cubics.scales import Scales
from tests.player.cubics.registers import codes

Vectors = Callable[[str], Any]


def test_coarse_and_fine_are_joined_as_told(vectors: Vectors) -> None:
    for case in vectors("sea_coarse_fine")["cases"]:
        ((fine, coarse, code),) = codes(np.array([float(case["X"])]), HISTORIC.scales)
        assert (fine, coarse) == (case["fine"], case["coarse_read"])
        assert fine >> 5 == case["fine_msb"]
        assert code == case["combined"] == case["X"]


def test_the_coarse_scale_may_be_late_by_one_digit_at_most(vectors: Vectors) -> None:
    position = np.arange(0, 39 * 64, dtype=float)
    for lag, right in vectors("sea_coarse_fine")["lag_in_coarse_LSB_vs_correct"].items():
        # half a count less, as a count is read in its middle
        late = float(lag) + (0.5 / 32 if float(lag) in (0.0, 1.0) else 0)
        read = codes(position, Scales(64, lag_digits=late))
        assert (read[:, 2] == position).all() == right, lag
