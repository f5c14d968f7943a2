"""Speed limits along a way, against the closed form: v² is at most v² elsewhere and the gain to it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.speed_limits import braked, reachable

WAYS = st.integers(2, 30).flatmap(
    lambda n: st.tuples(
        st.lists(st.floats(0, 100), min_size=n, max_size=n),
        st.lists(st.floats(0, 5), min_size=n - 1, max_size=n - 1),
    )
)


@given(WAYS)
def test_speeds_are_as_high_as_the_gains_from_all_other_places_allow(
    way: tuple[list[float], list[float]],
) -> None:
    allowed, steps_mm = np.array(way[0]), np.array(way[1])
    at = np.r_[0.0, np.cumsum(2 * 500.0 * steps_mm)]
    within = allowed**2 + np.abs(at[:, None] - at)
    ahead = np.where(at >= at[:, None], within, np.inf)
    ahead[np.tril_indices(len(at), -1)] = np.inf
    both = np.sqrt(within.min(axis=1))
    assert reachable(allowed, 2 * 500.0 * steps_mm) == pytest.approx(both, abs=1e-6)  # mm/s
    assert braked(allowed, 2 * 500.0 * steps_mm) == pytest.approx(
        np.sqrt(ahead.min(axis=1)), abs=1e-6
    )


def test_one_gain_stands_for_all_steps_and_no_limit_stays_none() -> None:
    assert reachable(np.array([0.0, 9.0, 9.0, 0.0]), 4.0).tolist() == [0.0, 2.0, 2.0, 0.0]
    assert braked(np.array([np.inf, np.inf]), 4.0).tolist() == [np.inf, np.inf]
