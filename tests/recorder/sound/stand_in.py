"""A stand-in for sounddevice: one loop of cable from its outputs to its inputs, in no time."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from morfax.recorder.sound import device, device_sink

COUNT = 4800  # frames to a callback


class CallbackStop(Exception):
    """As sounddevice has it."""


class CallbackAbort(Exception):
    """As sounddevice has it."""


class PortAudioError(Exception):
    """As sounddevice has it."""


@dataclass
class Cable:
    """The module `sounddevice`, as far as it is used; what goes out comes in again.

    `outputs`, `inputs`: tracks of the device; `rates`: that it has; `underflow_at`, `overflow_at`: the
    callback at which it flags lost samples; `stops_at`: the one after which it calls no more.
    """

    outputs: int = 4
    inputs: int = 4
    rates: tuple[int, ...] = (48000,)
    underflow_at: int | None = None
    overflow_at: int | None = None
    stops_at: int | None = None
    fails: bool = False
    cable: queue.Queue[Any] = field(default_factory=queue.Queue)
    heard: list[Any] = field(default_factory=list)
    streams: list[_Stream] = field(default_factory=list)

    CallbackStop = CallbackStop
    CallbackAbort = CallbackAbort
    PortAudioError = PortAudioError

    def query_hostapis(self) -> list[dict[str, Any]]:
        """The host interfaces."""
        return [{"name": "Loop"}]

    def query_devices(self) -> list[dict[str, Any]]:
        """The devices."""
        return [
            {
                "name": name,
                "hostapi": 0,
                "max_input_channels": self.inputs,
                "max_output_channels": self.outputs,
                "default_samplerate": float(self.rates[0]),
            }
            for name in ("Cable one", "Cable two")
        ]

    def check_output_settings(self, *, samplerate: int, channels: int, **_: Any) -> None:
        """Refuse a rate, or tracks, that the device does not have."""
        self._check(samplerate, channels <= self.outputs)

    def check_input_settings(self, *, samplerate: int, channels: int, **_: Any) -> None:
        """The same for what comes in."""
        self._check(samplerate, channels <= self.inputs)

    def _check(self, samplerate: int, has_tracks: bool) -> None:
        if samplerate not in self.rates or not has_tracks:
            raise PortAudioError("Invalid sample rate")

    def OutputStream(  # noqa: N802
        self,
        *,
        callback: Callable[..., None],
        finished_callback: Callable[[], None],
        **how: Any,
    ) -> _Stream:
        """A stream that takes frames from its callback."""
        if self.fails:
            raise PortAudioError("Device unavailable")

        def step(number: int) -> None:
            out = np.zeros((COUNT, how["channels"]), np.float32)
            status = SimpleNamespace(output_underflow=number == self.underflow_at)
            try:
                callback(out, COUNT, None, status)
            finally:
                self.heard.append(out)
                self.cable.put(out)

        self.streams.append(_Stream(step, self.stops_at, finished_callback))
        return self.streams[-1]

    def InputStream(self, *, callback: Callable[..., None], **how: Any) -> _Stream:  # noqa: N802
        """A stream that hands frames to its callback: those of the cable, then silence."""

        def step(number: int) -> None:
            try:
                frames = self.cable.get(timeout=0.05)
            except queue.Empty:
                frames = np.zeros((COUNT, how["channels"]), np.float32)
            status = SimpleNamespace(input_overflow=number == self.overflow_at)
            callback(frames, len(frames), None, status)

        self.streams.append(_Stream(step, self.stops_at, lambda: None))
        return self.streams[-1]


class _Stream:
    """A stream that calls back as fast as it can, from a thread of its own."""

    def __init__(
        self, step: Callable[[int], None], stops_at: int | None, finished: Callable[[], None]
    ) -> None:
        self._step, self._stops_at, self._finished = step, stops_at, finished
        self._ended = threading.Event()
        self.is_closed = False
        self._thread = threading.Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """Begin to call back."""
        self._thread.start()

    def _run(self) -> None:
        number = 0
        while not self._ended.is_set():
            if number == self._stops_at:
                return  # without a word, as a device does whose plug is pulled
            try:
                self._step(number)
            except (CallbackStop, CallbackAbort):
                break
            number += 1
        self._finished()

    def stop(self) -> None:
        """End."""
        self._ended.set()

    abort = stop

    def close(self) -> None:
        """Wait for the thread."""
        self._thread.join(timeout=1)
        self.is_closed = True


class Still:
    """A device that calls back after so long, by the waits counted; none of it takes time."""

    def __init__(self, still_s: float) -> None:
        self.left_s = still_s

    def wait(self, seconds: float) -> bool:
        """One wait is over, without a call."""
        self.left_s -= seconds
        return False

    def is_set(self) -> bool:
        """It goes on."""
        return False


def plugged_in(monkeypatch: pytest.MonkeyPatch) -> Cable:
    """A cable in sounddevice's place; it is faster than the recorder, so all is made before it starts."""
    made = Cable()
    monkeypatch.setattr(device, "sounddevice", lambda: made)
    monkeypatch.setattr(device, "STOPPED_S", 2.0)
    monkeypatch.setattr(device_sink, "AHEAD_S", 60.0)
    return made
