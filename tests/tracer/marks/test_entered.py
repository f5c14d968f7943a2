"""Squares that a line enters."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.marks import entered as module
from morfax.tracer.marks.entered import entered
from tests.tracer.sensing.kernels import COMPILED_AND_PLAIN, kernel


@COMPILED_AND_PLAIN
def test_a_line_enters_the_squares_that_hold_one_of_its_places(
    plain: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "_enters", kernel(module._enters, plain))
    rng = np.random.default_rng(1)
    line, middles = np.cumsum(rng.normal(0, 0.5, (60, 2)), axis=0), rng.uniform(-6, 6, (80, 2))
    reach = rng.uniform(0.1, 2.0, 80)
    off = np.abs(line - middles[:, None]).max(axis=2).min(axis=1)
    found = entered(line, middles, reach)
    assert 5 < len(found) < 75
    assert found.tolist() == np.flatnonzero(off <= reach).tolist()
