"""How well the ends that a line may have explain the ink about them."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.ink import ends_on_ink
from morfax.tracer.ink.ends_on_ink import faded, misfits_of, reach_mm_of
from morfax.tracer.tangles.pen import ink_at
from tests.tracer.sensing.kernels import COMPILED_AND_PLAIN, kernel

PEN = 0.25, 0.04  # half its width, softness, mm


@COMPILED_AND_PLAIN
def test_a_pens_ink_is_looked_up_within_1e_10(plain: bool) -> None:
    look_up, fading = kernel(faded, plain), ends_on_ink._fading()
    away_mm = np.r_[np.linspace(0.0, 0.6, 2001), reach_mm_of(PEN) + np.array([-1e-12, 0.0])]
    found = [look_up(float(away), (*PEN, fading)) for away in away_mm]
    assert found == pytest.approx([ink_at(float(away), *PEN) for away in away_mm], abs=1e-10)
    assert found[0] == 1.0 and found[2000] == 0.0


@COMPILED_AND_PLAIN
def test_an_end_on_paper_explains_the_ink_of_a_line_that_ends_there(
    plain: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing else is near. Ends further on than its own cross paper, and are not looked at."""
    monkeypatch.setattr(ends_on_ink, "_misfits", kernel(ends_on_ink._misfits, plain))
    own_mm, ends_mm = 1.2, np.arange(0.0, 3.0, 0.01)
    s, u = (each.ravel() for each in np.mgrid[0.0:3.0:0.06, -0.5:0.5:0.06])
    seen = [
        ink_at(float(np.hypot(max(a - own_mm, 0.0), b)), *PEN)
        for a, b in zip(s, u, strict=True)
    ]
    far = np.full(len(s), 9.0)
    places = np.column_stack([s, u, far, np.ones(len(s)), np.zeros(len(s)), seen])
    misfits = misfits_of(places, PEN, ends_mm)
    assert ends_mm[int(np.argmin(misfits))] == pytest.approx(own_mm, abs=0.001)
    assert misfits.min() < 1e-12
    assert np.isinf(misfits[-1]) and np.isfinite(misfits[: int(own_mm / 0.01)]).all()
