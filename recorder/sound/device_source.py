"""A sound device as a source: the tape comes in from a recorder as it is played.

Signals: frames (n, tracks), float32 of full scale 1, at the device's rate, out, as the device gives them.

    inputs 1, 2, … ─► PortAudio's callback ─► queue ─► player

An overrun is a fault, whoever finds it: PortAudio, which flags it, or the queue here.

Source: PortAudio V19 (stream callbacks and their flags), by way of sounddevice, the extra `morfax[sound]`.
Questions: a driver may lose samples without a flag; then the tape's check signal tells.
"""

from __future__ import annotations

import queue
from collections.abc import Iterator
from typing import Any

import numpy as np

from morfax.motion.faults import DeviceFault
from morfax.motion.usual import WAIT_S
from morfax.recorder.sound import device as portaudio
from morfax.recorder.sound.device import Device
from morfax.recorder.sound.device_sink import PIECE_FRAMES
from morfax.recorder.sound.programme import between_silences
from morfax.recorder.sound.source import BLOCK_FRAMES, Frames, Stored

LONGEST_BEHIND_S = 300.0  # of sound from a device that nobody has taken: 230 MB of four tracks
IN_LATENCY_S = 0.2  # of the device's own buffer; chosen by trial


class DeviceSource:
    """Sound that comes in from a device: the tape between two silences. It can be read once.

    `text`: what the tape's label says, as a text chunk would. Raises DeviceFault for an overrun, a device
    that stops, and where no carriers come within `wait_s`.
    """

    container = "device"
    sample = "FLOAT"

    def __init__(
        self, device: Device, rate_hz: int, tracks: int, text: str = "", wait_s: float = WAIT_S
    ) -> None:
        self.name, self.tracks, self.rate_hz = f"the device {device.name!r}", tracks, rate_hz
        self.text, self._device, self._wait_s = text, device, wait_s
        self.frames = 0  # that have come
        self._queue: queue.SimpleQueue[Frames | str] = queue.SimpleQueue()
        self._taken = 0  # frames that the callback has had
        self._stream: Any = None

    def close(self) -> None:
        """Stop the device."""
        if self._stream is not None:
            self._stream.abort()
            self._stream.close()
            self._stream = None

    def stored_blocks(self, frames: int = BLOCK_FRAMES, first: int = 0) -> Iterator[Stored]:
        """The tape in blocks of up to so many frames, from the moment at which its carriers have come."""
        skip = first
        tape = between_silences(self.all_blocks(), self.rate_hz, self._wait_s, self.name)
        for block in _gathered(tape, min(frames, PIECE_FRAMES)):
            self.frames += len(block)
            if skip < len(block):
                yield block[skip:]
            skip = max(skip - len(block), 0)

    def all_blocks(self) -> Iterator[Frames]:
        """All that comes in, as it comes; raises DeviceFault."""
        self._start()
        came = 0
        while True:
            try:
                piece = self._queue.get(timeout=portaudio.STOPPED_S)
            except queue.Empty:
                piece = f"{self.name} stopped; connect it and begin again"
            if isinstance(piece, str):
                self.close()
                time_s = came / self.rate_hz
                raise DeviceFault(piece, device=self._device.name, time_s=time_s)
            came += len(piece)
            if self._queue.qsize() * len(piece) > LONGEST_BEHIND_S * self.rate_hz:
                self._queue.put(_overrun(self._device.name, came / self.rate_hz))
            yield piece

    def _start(self) -> None:
        """Start the device."""
        with portaudio.as_faults(self._device):
            self._stream = portaudio.sounddevice().InputStream(
                device=self._device.number,
                channels=self.tracks,
                samplerate=self.rate_hz,
                dtype="float32",
                latency=IN_LATENCY_S,
                callback=self._take,
            )
            self._stream.start()

    def _take(self, frames: Any, count: int, time: Any, status: Any) -> None:
        """PortAudio's callback: keep the frames; what it has lost ends the tape."""
        if status.input_overflow and self._taken:
            self._queue.put(_overrun(self._device.name, self._taken / self.rate_hz))
            raise portaudio.sounddevice().CallbackAbort
        self._taken += count
        self._queue.put(np.array(frames, np.float32))


def _gathered(blocks: Iterator[Frames], least: int) -> Iterator[Frames]:
    """Blocks joined until each has so many frames; the last one is shorter."""
    held: list[Frames] = []
    for block in blocks:
        held.append(block)
        if sum(map(len, held)) >= least:
            yield np.concatenate(held)
            held = []
    if held:
        yield np.concatenate(held)


def _overrun(name: str, time_s: float) -> str:
    """The fault of samples that nobody took in time."""
    return (
        f"samples of the device {name!r} were lost {time_s:.2f} s after it began (an overrun); wind back and "
        "play it again, with less other work on this machine"
    )
