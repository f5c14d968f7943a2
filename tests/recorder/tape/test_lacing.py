"""The lacing: columns become frames of 16 bit and float32, with the check signal beneath them."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.recorder.sound.sixteen_bit import in_16_bit
from morfax.recorder.tape import lacing
from morfax.recorder.tape.carrier import Carrier, PickUp
from morfax.recorder.tape.lacing import BARE, CHUNK_PERIODS, Beneath, LacingRoom, words_of

STEPS = 8
# the last chunk of periods is no whole one
PERIODS = 2 * CHUNK_PERIODS + 5


def way(axes: int) -> np.ndarray:
    """A motion at full speed on some axes, mm."""
    steps_mm = np.random.default_rng(axes).uniform(-0.015, 0.015, (PERIODS, axes))
    return np.cumsum(steps_mm, axis=0)


def test_four_tracks_of_16_bit_are_words_and_others_are_not() -> None:
    assert len(words_of(np.empty((10, 4), np.int16))) == 10
    assert len(words_of(np.empty((10, 4), np.float32))) == 0
    assert len(words_of(np.empty((10, 2), np.float32))) == 0
    assert len(words_of(np.empty((10, 3), np.int16))) == 0


@pytest.mark.parametrize("axes", [1, 2, 3, 5])
@pytest.mark.parametrize("level", [0.5, 1.0, 1.2])
def test_frames_of_16_bit_are_those_of_float32_rounded(axes: int, level: float) -> None:
    positions = way(axes)
    whole, samples = (
        Carrier(PickUp(level=level), positions[0], kind) for kind in (np.float32, np.int16)
    )
    stored = np.concatenate([samples.frames(positions), samples.rest()])
    assert stored.dtype == np.int16
    assert np.array_equal(
        stored, in_16_bit(np.concatenate([whole.frames(positions), whole.rest()]))
    )


@pytest.mark.parametrize("plain", [False, True])
@pytest.mark.parametrize("in_16", [False, True])
def test_the_check_signal_passes_from_symbol_to_symbol(
    monkeypatch: pytest.MonkeyPatch, plain: bool, in_16: bool
) -> None:
    if plain:
        for name in ("finish", "_said", "_add", "_add_in_16_bit", "rounded"):
            monkeypatch.setattr(lacing, name, getattr(lacing, name).py_func)
    random = np.random.default_rng(3)
    room = LacingRoom.of(3, STEPS)
    room.columns[:] = random.uniform(-0.5, 0.5, room.columns.shape)
    # eight at a time where doubles are four
    assert room.said.dtype == BARE.waves.dtype == np.float32
    waves, shares = random.uniform(0, 0.1, (2, STEPS, PERIODS)).astype(np.float32)
    symbols = random.integers(0, 9, (STEPS, PERIODS))
    bits = np.sign(random.normal(size=(10, 3)))
    first, count = 40, CHUNK_PERIODS - 3
    lacing.finish(room, first, count, Beneath(waves, shares, symbols), bits, in_16)
    for track in range(3):
        now, then = bits[symbols, track], bits[symbols + 1, track]
        wave = (waves * (now * (1 - shares) + then * shares))[:, first : first + count]
        wanted = room.columns[track, :, :count] + wave
        wanted = np.rint(wanted * 32767) if in_16 else wanted
        # a rounded sample may lie on the other side of a half; one of full scale 1 has a step of float32
        off = np.abs(room.finished[track, :, :count] - wanted)
        assert off.max() <= (1 if in_16 else 6e-8)
        assert off.mean() <= (1e-3 if in_16 else 6e-8)


@pytest.mark.parametrize("plain", [False, True])
def test_columns_lie_beside_each_other_as_frames(
    monkeypatch: pytest.MonkeyPatch, plain: bool
) -> None:
    lace, count = lacing.lace, CHUNK_PERIODS - 3
    if plain:
        lace = lace.py_func
        monkeypatch.setattr(lacing, "_pack", lacing._pack.py_func)
    for tracks in (3, 4):
        room = LacingRoom.of(tracks, STEPS)
        room.columns[:] = np.random.default_rng(4).integers(-32768, 32768, room.columns.shape)
        frames = np.empty((STEPS * count, tracks), np.int16)
        lace(room.columns, room.packed, frames, words_of(frames))
        wanted = room.columns[:, :, :count].transpose(2, 1, 0).reshape(-1, tracks)
        assert np.array_equal(frames, wanted)
