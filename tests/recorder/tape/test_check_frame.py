"""Frames of the check signal: what is told comes back, and what is damaged is not taken for right."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.recorder.tape.check_frame import (
    COUNTS_PER_CYCLE,
    LEAST_ACCELERATION,
    LEAST_SPEED,
    NUMBERS,
    SYMBOLS,
    SYNC,
    SYNC_SYMBOLS,
    CheckFrame,
    from_bits,
    said_by,
    to_bits,
    to_code,
    to_value,
    turn_cycles,
)

OCTAVE_STEP = 2 ** (1 / 8)  # speeds and accelerations are rounded up to this


@given(
    track=st.integers(0, 15),
    number=st.integers(0, 5 * NUMBERS),
    cycles=st.floats(-5e5, 5e5),
    speed=st.floats(0.5, 2e4),
    acceleration=st.floats(32, 1e6),
    last=st.booleans(),
    version=st.sampled_from(list(COUNTS_PER_CYCLE)),
    middle=st.floats(-5e5, 5e5),
)
def test_what_is_told_comes_back(
    track: int,
    number: int,
    cycles: float,
    speed: float,
    acceleration: float,
    last: bool,
    version: int,
    middle: float,
) -> None:
    said = CheckFrame(track, number, cycles, speed, acceleration, last, version, middle)
    bits = to_bits(said)
    assert bits.shape == (SYMBOLS,)
    assert set(np.unique(bits)) == {-1, 1}
    found = from_bits(bits[None])[0]
    assert found is not None
    assert (found.track, found.number, found.last) == (track, number % NUMBERS, last)
    assert (found.version, found.grain_cycles) == (version, 1 / COUNTS_PER_CYCLE[version])
    off = math.remainder(found.cycles - cycles, found.turn_cycles)
    assert abs(off) <= 0.5 / COUNTS_PER_CYCLE[version]
    if version == 3 and track:
        assert found.middle_cycles is not None and 0 <= found.middle_cycles < 1
        assert abs(math.remainder(found.middle_cycles - middle, 1)) <= 0.5 / 64
    else:
        assert found.middle_cycles is None
        assert found.cycles == pytest.approx(cycles, abs=0.5 / COUNTS_PER_CYCLE[version])
    assert speed * (1 - 1e-6) <= found.speed <= speed * OCTAVE_STEP * (1 + 1e-6)
    assert acceleration * (1 - 1e-6) <= found.acceleration
    assert found.acceleration <= acceleration * OCTAVE_STEP * (1 + 1e-6)


def test_rest_is_told_as_rest_and_too_much_as_no_bound() -> None:
    found = from_bits(to_bits(CheckFrame(1, 0, 0.0, 0.0, 0.0))[None])[0]
    assert found is not None
    assert (found.speed, found.acceleration) == (0.0, 0.0)
    found = from_bits(to_bits(CheckFrame(1, 0, 0.0, 1e9, 1e12))[None])[0]
    assert found is not None
    assert (found.speed, found.acceleration) == (math.inf, math.inf)


def test_a_track_that_has_no_room_is_refused() -> None:
    with pytest.raises(ValueError, match=r"track 16 .*no room"):
        to_bits(CheckFrame(16, 0, 0.0))


@pytest.mark.parametrize(("version", "bits"), [(2, 26), (3, 20)])
@pytest.mark.parametrize("cycles", [8192.0, 524288.0, 3e6, -3e6 + 0.25])
def test_counts_begin_again_beyond_what_they_can_tell(
    cycles: float, version: int, bits: int
) -> None:
    """Beyond 0.4 m at 20 cycles per mm, as paths on most sheets are; 26 m in version 2."""
    found = from_bits(to_bits(CheckFrame(1, 0, cycles, version=version))[None])[0]
    assert found is not None
    assert found.turn_cycles == 2**bits / 64
    assert math.remainder(found.cycles - cycles, found.turn_cycles) == 0.0
    assert abs(found.cycles) <= found.turn_cycles / 2


def test_a_later_version_is_not_read() -> None:
    told = 4 << 61
    assert said_by(told) is None
    assert said_by(3 << 61) == CheckFrame(0, 0, 0.0)


def test_one_and_two_wrong_symbols_are_always_found() -> None:
    """A CRC-32 finds every error of one and two bits in 96."""
    bits = to_bits(CheckFrame(2, 77, 1234.5, 200.0, 1e4))
    places = range(SYNC_SYMBOLS, SYMBOLS)
    pairs = [(one, other) for one in places for other in places if one <= other]
    wrong = np.tile(bits, (len(pairs), 1))
    for row, (one, other) in zip(wrong, pairs, strict=True):
        row[one] *= -1
        if other != one:
            row[other] *= -1
    assert from_bits(wrong) == [None] * len(pairs)


def test_random_symbols_are_no_frame() -> None:
    """20 000 here, 10 million in benchmarks.check_signal; one in 4e9 is expected to pass, if that."""
    random = np.random.default_rng(14)
    symbols = random.integers(0, 2, (20_000, SYMBOLS), dtype=np.int8) * 2 - 1
    assert not any(from_bits(symbols))


def test_the_sync_word_is_like_itself_only() -> None:
    """A third of its symbols at most agree at any other place, or from behind."""
    word = SYNC.astype(float)
    full = np.correlate(word, word, "full")
    full[SYNC_SYMBOLS - 1] = 0
    assert np.abs(full).max() <= SYNC_SYMBOLS / 3
    assert abs(word @ word[::-1]) <= SYNC_SYMBOLS / 2


@pytest.mark.parametrize("least", [LEAST_SPEED, LEAST_ACCELERATION])
def test_eight_codes_are_an_octave_from_the_least_on(least: float) -> None:
    """126 codes reach 15.6 octaves further; the last one is no bound."""
    assert [to_code(value, least) for value in (0.0, -1.0, least / 9, least)] == [0, 0, 1, 1]
    assert to_code(2 * least, least) == 9 and to_code(2.01 * least, least) == 10
    assert to_value(1, least) == least and to_value(9, least) == 2 * least
    largest = least * 2 ** (125 / 8)
    assert to_code(largest, least) == 126 and to_value(126, least) == pytest.approx(largest)
    assert to_code(1.01 * largest, least) == 127 and to_value(127, least) == math.inf
    assert to_value(0, least) == 0.0


@pytest.mark.parametrize(
    ("version", "track", "cycles"),
    [(1, 1, 1 << 22), (2, 1, 1 << 20), (3, 0, 1 << 20), (3, 1, 1 << 14)],
)
def test_counts_begin_again_behind_the_bits_that_tell_them(
    version: int, track: int, cycles: int
) -> None:
    assert turn_cycles(version, track) == cycles
    assert CheckFrame(track, 1, 0.0, version=version).turn_cycles == cycles
