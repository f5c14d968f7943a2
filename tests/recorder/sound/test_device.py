"""Sound devices by a stand-in: what goes out comes in, and what a device loses is a fault."""

from __future__ import annotations

import builtins
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from morfax.motion.faults import DeviceFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.playback import play_live
from morfax.recorder.sound import device as devices
from morfax.recorder.sound import device_sink
from morfax.recorder.sound.device import found, rate_for
from morfax.recorder.sound.device_sink import DeviceSink
from morfax.recorder.sound.device_source import DeviceSource
from morfax.recorder.sound.programme import between_silences
from morfax.recorder.tape.recording import record_live
from morfax.recorder.tape.tape import TapeFormat
from tests.player.worn import program
from tests.recorder.sound.stand_in import Cable, Still

CHECKED = TapeFormat(checked=True)
BY_HAND = {"reference_hz": 6000.0, "cycles_per_mm": 20.0}
RATE_HZ = 48000


@pytest.fixture
def cable(monkeypatch: pytest.MonkeyPatch) -> Cable:
    """A cable in the place of sounddevice; it stops sooner than a device may."""
    made = Cable()
    monkeypatch.setattr(devices, "sounddevice", lambda: made)
    monkeypatch.setattr(devices, "STOPPED_S", 0.3)
    monkeypatch.setattr(device_sink, "LONGEST_START_S", 0.1)
    monkeypatch.setattr(device_sink, "LEAD_S", 0.2)
    monkeypatch.setattr(device_sink, "AHEAD_S", 60.0)  # the cable is faster than the recorder
    return made


def sink(tracks: int = 4) -> DeviceSink:
    """The sink of the first device."""
    return DeviceSink(found("Cable one", tracks=tracks, is_input=False), RATE_HZ, tracks)


def source(**how: Any) -> DeviceSource:
    """The source of the first device."""
    return DeviceSource(found("0", tracks=4, is_input=True), RATE_HZ, 4, **how)


def test_a_tape_goes_out_and_comes_in_and_is_the_motion(cable: Cable) -> None:
    motion = Motion(program(2.0))
    record_live(motion, lambda fmt: sink(), CHECKED)
    played = join(play_live(source(), **BY_HAND)).positions_mm
    # from where the tape begins: the silence before it, and 0.2 s, are left out
    assert np.ptp(played, axis=0) == pytest.approx(
        np.ptp(motion.positions_mm, axis=0), abs=2e-3
    )
    assert played[-1] == pytest.approx(
        motion.positions_mm[-1] - motion.positions_mm[0], abs=1e-3
    )


def test_every_frame_goes_out_once_and_in_order(cable: Cable) -> None:
    frames = np.random.default_rng(1).uniform(-1, 1, (30_011, 4)).astype(np.float32)
    with sink() as out:
        for first in range(0, len(frames), 7001):
            out.put(frames[first : first + 7001])
    heard = np.vstack(cable.heard)
    begin = np.flatnonzero(np.abs(heard).max(axis=1))[0]
    assert np.array_equal(heard[begin : begin + len(frames)], frames)
    assert not heard[:begin].any() and not heard[begin + len(frames) :].any()
    assert [stream.is_closed for stream in cable.streams] == [True]


def test_a_second_of_silence_goes_before_the_tape_and_one_behind_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    cable = Cable()
    monkeypatch.setattr(devices, "sounddevice", lambda: cable)
    monkeypatch.setattr(device_sink, "AHEAD_S", 60.0)
    with sink() as out:
        out.put(np.full((RATE_HZ, 4), 0.5, np.float32))
    heard = np.flatnonzero(np.vstack(cable.heard).any(axis=1))
    assert (heard[0], heard[-1]) == (RATE_HZ, 2 * RATE_HZ - 1)
    assert len(np.vstack(cable.heard)) >= 3 * RATE_HZ


def silence(seconds: float) -> np.ndarray:
    """Frames of nothing."""
    return np.zeros((round(seconds * RATE_HZ), 4), np.float32)


@pytest.mark.parametrize(
    ("trouble", "said"),
    [
        ({"underflow_at": 9}, "ran out of samples .* underrun"),
        ({"stops_at": 9}, "stopped; connect it"),
        ({"stops_at": 1}, "does not start"),
        ({"fails": True}, "Device unavailable"),
    ],
)
def test_what_a_device_does_not_play_is_a_fault(
    cable: Cable, trouble: dict[str, Any], said: str
) -> None:
    for name, value in trouble.items():
        setattr(cable, name, value)
    with pytest.raises(DeviceFault, match=said) as met, sink() as out:
        for _ in range(10):
            out.put(silence(1.0))
    assert met.value.exit_code == 10
    assert all(stream.is_closed for stream in cable.streams)  # the device is free for others


def test_a_device_that_runs_out_of_samples_says_after_how_many_seconds(cable: Cable) -> None:
    """Callbacks are of 0.1 s; the first two are the silence in front."""
    cable.underflow_at = 9
    with pytest.raises(DeviceFault, match=r" 0\.7") as met, sink() as out:
        out.put(silence(2.0))
    assert met.value.time_s == pytest.approx(0.7)


def test_an_underrun_as_a_device_starts_costs_nothing(cable: Cable) -> None:
    cable.underflow_at = 0
    with sink() as out:
        out.put(silence(0.5))


def test_a_recorder_that_is_too_slow_is_a_fault(
    cable: Cable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(device_sink, "AHEAD_S", 0.1)
    with pytest.raises(DeviceFault, match="underrun"), sink() as out:
        out.put(silence(0.2))
        out._done.wait(0.2)  # the device plays on meanwhile
        out.put(silence(0.2))


def test_samples_that_come_in_and_are_lost_are_a_fault(cable: Cable) -> None:
    cable.overflow_at = 5
    with pytest.raises(DeviceFault, match=r"lost .* \(an overrun\)"):
        list(source().all_blocks())


def test_a_device_that_falls_silent_for_good_is_a_fault(cable: Cable) -> None:
    cable.stops_at = 3
    with pytest.raises(DeviceFault, match="stopped"):
        list(source().all_blocks())


def test_a_tape_that_does_not_come_is_a_fault_with_its_levels(cable: Cable) -> None:
    with pytest.raises(DeviceFault, match=r"no tape came .* -100, -100, -100, -100 dB"):
        list(source(wait_s=0.4).stored_blocks())


def test_a_device_is_found_by_its_number_its_name_or_a_part(cable: Cable) -> None:
    assert found("1", tracks=4, is_input=True).name == "Cable two"
    assert found("two", tracks=4, is_input=False).number == 1
    with pytest.raises(
        DeviceFault, match="may be 0 'Cable one', 1 'Cable two'; give the number"
    ):
        found("cable", tracks=2, is_input=True)
    with pytest.raises(DeviceFault, match="no sound device 'x'"):
        found("x", tracks=2, is_input=True)
    cable.inputs = 2
    with pytest.raises(DeviceFault, match="has 2 inputs; this tape has 4 tracks"):
        found("0", tracks=4, is_input=True)


def test_a_rate_that_the_device_does_not_have_is_its_own(cable: Cable) -> None:
    cable.rates = (44100,)
    one = found("0", tracks=4, is_input=True)
    assert rate_for(one, 48000, tracks=4, is_input=True) == 44100
    assert rate_for(one, 44100, tracks=4, is_input=False) == 44100
    # what goes out is asked of the outputs, and what comes in of the inputs
    cable.rates, cable.inputs = (44100, 48000), 2
    assert rate_for(one, 48000, tracks=4, is_input=False) == 48000
    assert rate_for(one, 48000, tracks=4, is_input=True) == 44100


def test_without_sounddevice_a_line_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    real = builtins.__import__

    def without(name: str, *args: Any) -> Any:
        if name == "sounddevice":
            raise ImportError(name)
        return real(name, *args)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(DeviceFault, match=r'pip install "morfax\[sound\]"'):
        devices.devices()


@pytest.mark.parametrize(("still_s", "has_stopped"), [(4.0, False), (6.0, True)])
def test_a_device_that_does_not_call_for_5_s_has_stopped(
    monkeypatch: pytest.MonkeyPatch, still_s: float, has_stopped: bool
) -> None:
    monkeypatch.setattr(devices, "sounddevice", lambda: Cable())
    out, still = sink(), Still(still_s)
    out._done = still  # type: ignore[assignment]
    if has_stopped:
        with pytest.raises(DeviceFault, match="stopped"):
            out._wait(lambda: still.left_s <= 0)
    else:
        out._wait(lambda: still.left_s <= 0)


def carriers(seconds: float) -> np.ndarray:
    """Four tracks of carriers."""
    t_s = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    return np.tile(0.5 * np.sin(2 * np.pi * 6000 * t_s)[:, None], (1, 4)).astype(np.float32)


def heard(*pieces: np.ndarray, size: int = 1000) -> float:
    """Length of the programme between the silences of some pieces, s."""

    def blocks() -> Iterator[np.ndarray]:
        whole = np.vstack(pieces)
        for first in range(0, len(whole), size):
            yield whole[first : first + size]

    got = np.vstack(list(between_silences(blocks(), RATE_HZ, 9.0, "it")))
    assert np.abs(got[-960:]).max() > 0.4, "the silence behind the tape came along"
    return len(got) / RATE_HZ


@pytest.mark.parametrize("size", [480, 1000, 96_000])
def test_the_programme_is_what_stands_between_two_silences(size: int) -> None:
    hiss = np.random.default_rng(2).normal(0, 1e-3, (RATE_HZ, 4)).astype(np.float32)
    # s: 0.2 at its start, and 0.04 with a window's rounding at its end, are left out
    assert heard(hiss, carriers(3.0), hiss, carriers(1.0), size=size) == pytest.approx(
        2.77, abs=0.04
    )


def test_a_dropout_of_all_tracks_is_part_of_the_programme() -> None:
    gap = silence(0.3)
    assert heard(
        silence(0.1), carriers(2.0), gap, carriers(1.0), silence(0.6)
    ) == pytest.approx(3.07, abs=0.04)
