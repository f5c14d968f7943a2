"""Tracks in another order: put right where only one order is possible, else told before anything moves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.faults import TapeFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import TapeFormat, record
from morfax.recorder.wear.settings import Wear
from morfax.recorder.wear.transport import age
from tests.player.worn import program

ORDERS = [(2, 1, 3, 4), (3, 2, 1, 4), (4, 2, 3, 1), (2, 3, 4, 1), (4, 3, 2, 1)]


def mixed(
    folder: Path,
    end_mm: tuple[float, float, float],
    order: tuple[int, ...],
    *,
    checked: bool = False,
) -> tuple[Path, Path]:
    """A tape that ends there, as it was recorded and with its tracks in another order."""
    positions = program(2.0, 20.0)
    record(
        Motion(positions + np.linspace(0, 1, len(positions))[:, None] ** 3 * np.array(end_mm)),
        folder / "a.wav",
        None if checked else TapeFormat(),
    )
    age(
        folder / "a.wav",
        folder / "b.wav",
        replace(Wear(), order=order, speed=0.002, noise_db=46),
    )
    return folder / "a.wav", folder / "b.wav"


@pytest.mark.parametrize("order", ORDERS)
def test_an_end_that_tells_the_axes_apart_puts_them_in_order(
    tmp_path: Path, order: tuple[int, ...]
) -> None:
    right, wrong = mixed(tmp_path, (1.0, 2.0, -1.0), order)
    playback = play(wrong)
    ended = join(playback).positions_mm[-1]
    assert playback.found_order == tuple(order.index(track) + 1 for track in (1, 2, 3, 4))
    assert ended == pytest.approx(
        join(play(right)).positions_mm[-1], abs=1e-3
    )  # mm: noise of 46 dB at rest


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("end_mm", [(0.0, 0.0, 0.0), (1.0, 1.0, 0.0)])
def test_an_end_that_does_not_is_a_fault_before_anything_moves(
    tmp_path: Path, order: tuple[int, ...], end_mm: tuple[float, float, float]
) -> None:
    with pytest.raises(
        TapeFault, match=rf"the reference is on track {order.index(1) + 1}.*--tracks"
    ):
        play(mixed(tmp_path, end_mm, order)[1])


@pytest.mark.parametrize("order", ORDERS)
def test_tracks_that_say_which_they_are_are_put_in_order(
    tmp_path: Path, order: tuple[int, ...]
) -> None:
    right, wrong = mixed(tmp_path, (0.0, 0.0, 0.0), order, checked=True)
    playback = play(wrong)
    assert playback.found_order == tuple(order.index(track) + 1 for track in (1, 2, 3, 4))
    went, wanted = join(playback).positions_mm, join(play(right)).positions_mm
    assert np.abs(went[-1] - wanted[-1]).max() < 1e-3  # mm: noise of 46 dB at rest


def test_tracks_in_order_are_left_alone(tmp_path: Path) -> None:
    assert play(mixed(tmp_path, (1.0, 2.0, -1.0), (1, 2, 3, 4))[1]).found_order is None
