"""A sound device as a sink: the tape goes out to a recorder as it is made.

Signals: frames (n, tracks), float32 of full scale 1, at the device's rate, in; the device takes them as fast
as they are heard.

    recorder ─► queue of 2 s ─► PortAudio's callback ─► outputs 1, 2, … of a device

An underrun is a fault, whoever finds it: PortAudio, which flags it, or the queue here.

Source: PortAudio V19 (stream callbacks and their flags), by way of sounddevice, the extra `morfax[sound]`.
"""

from __future__ import annotations

import queue
import threading
from typing import Any

import numpy as np

from morfax.motion.ending import Ending
from morfax.motion.faults import DeviceFault
from morfax.recorder.sound import device as portaudio
from morfax.recorder.sound.device import Device
from morfax.recorder.sound.source import Frames, SampleType, Stored

AHEAD_S = 2.0  # of sound held for a device, and made before it starts: a stall of the machine is shorter
# of the device's own buffer; chosen by trial: beside other work 0.2 ran out of samples on the way out
OUT_LATENCY_S = 0.5
LEAD_S = 1.0  # of silence before the tape: some drivers report an underrun as they start, or stop again
LONGEST_START_S = 2.0
STARTS = 5  # tried in all
POLL_S = 0.02
TAIL_S = 1.0  # of silence behind the tape: some drivers lose the end, and a player waits for half a second
PIECE_FRAMES = 8192  # of frames put in one piece into the queue, 0.17 s


class DeviceSink(Ending):
    """Frames put out to a device; a context manager. Raises DeviceFault for an underrun or a lost device."""

    takes: SampleType = np.float32

    def __init__(self, device: Device, rate_hz: int, tracks: int) -> None:
        self._device, self._rate_hz, self._tracks = device, rate_hz, tracks
        self._queue: queue.Queue[Frames | None] = queue.Queue()
        self._ahead = 0  # frames in the queue
        self._begun: Frames | None = np.zeros((0, tracks), np.float32)  # None: all is played
        self._played, self._fault = 0, ""
        self._lead = 0  # frames of silence that are still to go out
        self._done = threading.Event()
        self._lock = threading.Lock()
        self._stream: Any = None

    def end(self, error: BaseException | None) -> None:
        """Play what is still to come, and give the device back; at once after an error."""
        try:
            if error is None:
                self._queue.put(
                    np.zeros((round(TAIL_S * self._rate_hz), self._tracks), np.float32)
                )
                self._queue.put(None)
                self._start()
                self._wait(lambda: self._done.is_set())
        finally:
            if self._stream is not None:
                self._stream.abort() if error is not None or self._fault else self._stream.stop()
                self._stream.close()

    def put(self, frames: Stored) -> None:
        """Take the next frames; waits while the device has enough of them."""
        for first in range(0, len(frames), PIECE_FRAMES):
            piece = np.ascontiguousarray(frames[first : first + PIECE_FRAMES], np.float32)
            with self._lock:
                self._ahead += len(piece)
            self._queue.put(piece)
            if self._ahead >= AHEAD_S * self._rate_hz:
                self._start()
                self._wait(lambda: self._ahead < AHEAD_S * self._rate_hz)

    def _start(self) -> None:
        """Start the device, once there is enough to play; the silence in front shows that it runs."""
        if self._stream is not None:
            return
        for _ in range(STARTS):
            self._lead = round(LEAD_S * self._rate_hz)
            with portaudio.as_faults(self._device):
                self._stream = portaudio.sounddevice().OutputStream(
                    device=self._device.number,
                    channels=self._tracks,
                    samplerate=self._rate_hz,
                    dtype="float32",
                    latency=OUT_LATENCY_S,
                    callback=self._fill,
                    finished_callback=self._done.set,
                )
                self._stream.start()
                if self._has_led():
                    return
                self._stream.abort()
                self._stream.close()
                self._done.clear()
        raise DeviceFault(
            f"the device {self._device.name!r} does not start; morfax devices lists the others",
            device=self._device.name,
        )

    def _has_led(self) -> bool:
        """Whether the silence in front has gone out, soon enough for a device that runs."""
        for _ in range(round((LEAD_S + LONGEST_START_S) / POLL_S)):
            if not self._lead or self._done.wait(POLL_S):
                break
        return not self._lead

    def _wait(self, ready: Any) -> None:
        """Wait for the device; raises DeviceFault for its fault, or if it has stopped."""
        still, played = 0.0, self._played
        while not ready() or self._fault:
            if self._fault:
                raise DeviceFault(
                    self._fault, device=self._device.name, time_s=self._played / self._rate_hz
                )
            self._done.wait(POLL_S)
            still = 0.0 if self._played != played else still + POLL_S
            played = self._played
            if still > portaudio.STOPPED_S or (self._done.is_set() and not ready()):
                self._fault = (
                    f"the device {self._device.name!r} stopped; connect it and begin again"
                )

    def _fill(self, out: Any, count: int, time: Any, status: Any) -> None:
        """PortAudio's callback: hand it the next frames; what is missing ends the tape."""
        sounddevice = portaudio.sounddevice()
        if self._lead:
            out[:] = 0
            self._lead = max(self._lead - count, 0)
            return
        if status.output_underflow:
            self._fault = _underrun(self._device.name, self._played / self._rate_hz)
            raise sounddevice.CallbackAbort
        filled = 0
        while filled < count and self._begun is not None:
            if not len(self._begun):
                try:
                    self._begun = self._queue.get_nowait()
                except queue.Empty:
                    self._fault = _underrun(self._device.name, self._played / self._rate_hz)
                    raise sounddevice.CallbackAbort from None
                continue
            piece = self._begun[: count - filled]
            out[filled : filled + len(piece)] = piece
            self._begun = self._begun[len(piece) :]
            filled += len(piece)
            with self._lock:
                self._ahead -= len(piece)
        out[filled:] = 0
        self._played += filled
        if self._begun is None:
            raise sounddevice.CallbackStop


def _underrun(name: str, time_s: float) -> str:
    """The fault of samples that were not there in time."""
    return (
        f"the device {name!r} ran out of samples {time_s:.2f} s into the tape (an underrun): what is on the "
        "tape has a hole; wind back and record it again, with less other work on this machine"
    )
