"""Lead screw and sector wheel against the vectors worked out from figures 2 and 4 of the patent."""

from collections.abc import Callable
from typing import Any

import pytest

from morfax.motion.axis import LeadScrew


def test_the_tape_s_own_screw_has_20_cycles_per_mm() -> None:
    screw = LeadScrew()
    assert screw.cycles_per_mm == 20.0
    assert screw.mm_per_cycle == 0.05
    assert screw.track_hz(6000.0, 100.0) == 8000.0
    assert screw.track_hz(6000.0, -100.0) == 4000.0


def test_the_historic_screw_as_worked_out(vectors: Callable[[str], Any]) -> None:
    worked = vectors("mf_tape")
    given = worked["params"]
    screw = LeadScrew(given["pitch_mm"], given["sectors"])
    assert screw.mm_per_cycle == given["mm_per_cycle"]
    # a wheel of so many sectors and turns gives the reference; a count of 1/64 cycle is 2 um
    assert given["sectors"] * given["n_ref_rev_s"] == given["f_ref_hz"]
    assert screw.mm_per_cycle / 64 == given["mm_per_phase_count_1_64"]
    for row in worked["rows"]:
        assert row["leadscrew_rev_s"] * given["pitch_mm"] == pytest.approx(
            row["axis_speed_mm_s"], abs=1e-9
        )
        speed_mm_s = row["axis_speed_mm_s"]
        assert screw.track_hz(given["f_ref_hz"], speed_mm_s) == pytest.approx(
            row["tape_hz"], abs=1e-9
        )
        assert speed_mm_s * screw.cycles_per_mm == pytest.approx(
            row["phase_rate_cycles_s"], abs=1e-9
        )
