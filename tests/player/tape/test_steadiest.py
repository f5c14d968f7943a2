"""The steadiest track: frequencies at moments of a block, and which track moves least."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.player.tape import steadiest as organ
from morfax.player.tape.steadiest import MOMENTS, Steadiest
from morfax.recorder.tape.format import TapeFormat

FORMAT = TapeFormat()


def tones(hz: tuple[float, ...], frames: int = 4096) -> np.ndarray:
    """Tracks with a tone each, as they are stored in a file."""
    t_s = np.arange(frames)[:, None] / FORMAT.sample_rate_hz
    return np.round(16000 * np.sin(2 * np.pi * np.array(hz) * t_s)).astype(np.int16)


@pytest.fixture(params=[False, True], ids=["kernel", "plain"])
def watch(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Steadiest:
    """The watch by compiled kernels, and by plain Python."""
    if request.param:
        for name in ("_frequencies", "_add_squares"):
            monkeypatch.setattr(organ, name, getattr(organ, name).py_func)
    return Steadiest(FORMAT, FORMAT.reference_hz)


def test_frequencies_are_those_of_the_tracks(watch: Steadiest) -> None:
    found = np.zeros((MOMENTS, 4))
    taps, clock = watch._taps, watch._clock
    organ._frequencies(tones((6000.0, 6100.0, 5500.0, 7500.0)), clock, taps, found)
    # Hz: samples are rounded to 16 bit, and what the filter lets by of the mirror at -6 kHz
    assert np.abs(found - [6000.0, 6100.0, 5500.0, 7500.0]).max() < 1.0


def test_a_reference_on_another_track_is_told(watch: Steadiest) -> None:
    assert watch.wrong(tones((6000.0,) * 4), 0.1) is None
    fault = watch.wrong(tones((6100.0, 6000.0, 6050.0, 5900.0)), 0.2)
    assert fault is not None and watch.track == 1 and not watch.is_reference
    # half of the moments at 100 Hz off: their root mean square
    assert str(fault).startswith("track 1 moves by 71 Hz and track 2 (X) stands at 0 Hz")


def test_a_reference_that_stands_while_others_move_is_right(watch: Steadiest) -> None:
    assert watch.wrong(tones((6000.0, 6100.0, 6050.0, 5900.0)), 0.1) is None
    assert watch.is_reference and watch.track == 0 and watch.doubtful(0.1) is None


def test_a_track_that_was_a_little_steadier_is_doubtful_at_the_end(watch: Steadiest) -> None:
    still = tones((6000.0,) * 4)
    watch.wrong(still, 0.1)
    assert watch.wrong(tones((6012.0, 6008.0, 6100.0, 6000.0 + 12.5)), 0.2) is None
    fault = watch.doubtful(0.2)
    assert fault is not None and "(--tracks 2,...)" in str(fault)


def test_blocks_too_short_for_moments_tell_nothing(watch: Steadiest) -> None:
    assert watch.wrong(tones((6100.0, 6000.0, 6050.0, 5900.0), 120), 0.1) is None
    assert watch.doubtful(0.1) is None
