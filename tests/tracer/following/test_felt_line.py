"""A felt line: how far nothing leaves it, from either of its ends."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.following import felt_line
from morfax.tracer.following.felt_line import bare_from_mm

WAY = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [8.0, 2.0]])  # 10 mm


@pytest.mark.parametrize(("bare_mm", "from_mm"), [(4.0, 6.0), (0.0, None), (10.0, None)])
def test_from_where_on_nothing_leaves_a_way_is_felt_back_from_its_end(
    bare_mm: float, from_mm: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """None if something does to the way's end, or nothing does at all."""
    felt = list[Array]()

    def bare(_: object, way: Array, seen: Array) -> float:
        felt.append(way)
        return bare_mm

    monkeypatch.setattr(felt_line, "_bare_mm", bare)
    assert bare_from_mm(cast(Any, None), WAY, np.empty((0, 3))) == from_mm
    assert np.array_equal(felt[0], WAY[::-1])
