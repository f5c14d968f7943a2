"""The Z unit: set on five decades, exact to the count, and coincidence stops it at rest."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.faults import MotionFault
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.usual import COUNT_MM
from morfax.tracer.operator import zunit
from morfax.tracer.operator.zunit import (
    LARGEST_COUNT,
    Counters,
    Preset,
    QuillMove,
    coincidence,
    counted,
    counts_of,
    moves,
    z_moves,
)

SENSES = st.sampled_from(["up", "down"])
FEEDS = st.floats(0.5, 50)
ROUNDING_MM = 2e-11  # two thousand-millionths of a count, see `zunit.counted`


def run(start: Counters, *presets: Preset) -> np.ndarray:
    """Z of presets run from the counters' place, mm."""
    return z_moves(start.z_mm, moves(start, presets))


# the panel


def test_the_switches_and_the_counters_show_five_digits() -> None:
    assert Preset(705).digits == "00705" and Preset(LARGEST_COUNT).digits == "99999"
    assert (
        Counters(200).digits == "+00200" and Counters(200).after(Preset(705)).digits == "-00505"
    )
    assert Counters(200).after(Preset(705)).after(Preset(705, "up")) == Counters(
        200
    )  # they count both ways


@pytest.mark.parametrize("counts", [-1, LARGEST_COUNT + 1])
def test_more_than_five_decades_cannot_be_set(counts: int) -> None:
    with pytest.raises(
        ValueError,
        match=f"a move of {counts / 100:.2f} mm cannot be set on five decades; give 0 to 999.99 mm",
    ):
        Preset(counts)


def test_the_counters_go_no_further_than_five_digits() -> None:
    with pytest.raises(
        ValueError,
        match=r"the counters cannot show -1000.00 mm; they go from -999.99 to 999.99 mm",
    ):
        moves(Counters(-1), [Preset(LARGEST_COUNT)])


@pytest.mark.parametrize(
    "wrong",
    [{"sense": "left"}, {"feed_mm_s": 0.0}, {"feed_mm_s": float("inf")}, {"dwell_s": -1}],
)
def test_what_never_ends_or_has_no_sense_is_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ValueError, match="give"):
        Preset(100, **wrong)  # type: ignore[arg-type]


@given(st.integers(0, LARGEST_COUNT))
def test_counts_and_mm_are_the_same_length(counts: int) -> None:
    assert counts_of(counts * COUNT_MM) == counts == counts_of(Counters(counts).z_mm)
    assert counts_of(counts * COUNT_MM / 25.4 * 25.4) == counts  # by way of inches


def test_parts_of_a_count_are_none() -> None:
    with pytest.raises(
        ValueError, match=r"0.015 mm cannot be counted; give whole steps of 0.01 mm"
    ):
        counts_of(0.015)


# a move


@given(st.integers(-3000, 3000), st.integers(1, 4000), SENSES, FEEDS)
def test_coincidence_and_rest_fall_together_on_the_count(
    start: int, counts: int, sense: str, feed_mm_s: float
) -> None:
    counters, preset = Counters(start), Preset(counts, sense, feed_mm_s)  # type: ignore[arg-type]
    z_mm = run(counters, preset)
    assert z_mm[0] == counters.z_mm and z_mm[-1] == counters.after(preset).z_mm  # exactly
    met = coincidence(counted(z_mm - counters.z_mm), counts)
    assert (
        met is not None and len(z_mm) - 2 <= met <= len(z_mm) - 1
    )  # the last period may move by less than a rounding
    assert abs(z_mm[met] - z_mm[-1]) < 1e-6  # mm: the disc tells no such part of a count
    assert np.all(np.diff(z_mm) * (1 if sense == "up" else -1) >= 0)  # and it never comes back
    assert np.abs(np.diff(z_mm)).max() * MOTION_RATE_HZ <= feed_mm_s * (1 + 1e-9)  # rounding


def test_the_counters_pass_every_count_on_the_way() -> None:
    shown = counted(run(Counters(0), Preset(50, "down", 2.0)))
    assert sorted(set(shown.tolist()), reverse=True) == list(range(0, -51, -1))


def test_a_move_that_falls_short_has_no_coincidence() -> None:
    z_mm = run(Counters(0), Preset(499))
    assert coincidence(counted(z_mm), 499) is not None
    assert coincidence(counted(z_mm), 500) is None


def test_the_motor_stops_where_the_counters_agree_and_not_where_its_ramp_ends(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A disc with one hole too many in a hundred: the counters are there early, and so is the stop."""
    way = Counters(0), Preset(500), Preset(100, "up")
    monkeypatch.setattr(zunit, "_one", zunit._one.__wrapped__)  # counted anew each time
    monkeypatch.setattr(
        zunit, "counted", lambda come_mm, pulse_mm: counted(come_mm, pulse_mm / 1.01)
    )
    z_mm = run(*way)
    # 495 true counts of 500; and 1 % short of -4 on the way up from there
    assert z_mm.min() == pytest.approx(-4.95, abs=COUNT_MM)
    assert z_mm[-1] == pytest.approx(-4.00, abs=2 * COUNT_MM)
    # and one too few: the ramp ends before the counters are there
    monkeypatch.setattr(
        zunit, "counted", lambda come_mm, pulse_mm: counted(come_mm, pulse_mm / 0.99)
    )
    with pytest.raises(MotionFault, match=r"counters show 495 pulses .* and the switches 500"):
        run(*way)


@given(st.lists(st.tuples(st.integers(0, 500), SENSES, FEEDS), min_size=1, max_size=6))
def test_what_goes_down_and_up_again_ends_where_it_began(
    rows: list[tuple[int, str, float]],
) -> None:
    there = [Preset(counts, sense, feed) for counts, sense, feed in rows]  # type: ignore[arg-type]
    back = [
        Preset(p.counts, "down" if p.sense == "up" else "up", p.feed_mm_s)
        for p in reversed(there)
    ]
    assert run(Counters(200), *there, *back)[-1] == 2.0


def test_a_dwell_stands_for_its_time() -> None:
    still = run(Counters(-500), Preset(0, dwell_s=0.25))
    assert np.all(still == -5.0) and len(still) == 1 + 0.25 * MOTION_RATE_HZ
    with_dwell, without = (
        run(Counters(200), Preset(700, dwell_s=dwell_s)) for dwell_s in (0.5, 0.0)
    )
    assert np.array_equal(with_dwell, np.r_[without, np.full(3000, -5.0)])


def test_a_place_between_two_counts_is_reached_exactly_too() -> None:
    z_mm = z_moves(1 / 3, [QuillMove(-np.pi, 5.0), QuillMove(1 / 3, 5.0)])
    assert z_mm.min() == -np.pi and z_mm[-1] == 1 / 3


def test_no_move_is_no_motion() -> None:
    assert z_moves(2.0, []).shape == (0,)
