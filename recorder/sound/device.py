"""Sound devices: the tape goes out to a recorder as it is made, and comes in from one as it is played.

    recorder ─► queue of 2 s ─► PortAudio's callback ─► outputs 1, 2, … of a device
    inputs 1, 2, … ─► PortAudio's callback ─► queue ─► player

Signals: frames (n, tracks), float32 of full scale 1, at the device's rate. The device keeps time: a sink
takes frames as fast as they are heard, and a source gives them as they come.

A sample that is left out or put in would be a wrong place on the work, so an underrun, an overrun and a
device that stops are faults, whoever finds them: PortAudio, which flags them, or the queues here.

Source: PortAudio V19 (stream callbacks and their flags), by way of sounddevice, the extra `morfax[sound]`.
Questions: a driver may lose samples without a flag; then the tape's check signal tells.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from types import ModuleType, TracebackType
from typing import Any

import numpy as np

from morfax.motion.faults import DeviceFault
from morfax.recorder.sound.programme import between_silences
from morfax.recorder.sound.source import BLOCK_FRAMES, Frames, Stored

AHEAD_S = 2.0  # of sound held for a device, and made before it starts: a stall of the machine is shorter
LONGEST_BEHIND_S = 300.0  # of sound from a device that nobody has taken: 230 MB of four tracks
# of the device's own buffer; chosen by trial: beside other work 0.2 ran out of samples on the way out
OUT_LATENCY_S, IN_LATENCY_S = 0.5, 0.2
LEAD_S = 1.0  # of silence before the tape: some drivers report an underrun as they start, or stop again
LONGEST_START_S = 2.0
STARTS = 5  # tried in all
POLL_S = 0.02
TAIL_S = 1.0  # of silence behind the tape: some drivers lose the end, and a player waits for half a second
STOPPED_S = 5.0  # without a callback: the device has stopped
PIECE_FRAMES = 8192  # of frames put in one piece into the queue, 0.17 s

_INSTALL = 'sound devices need sounddevice; install it with: pip install "morfax[sound]"'
_NO_PORTAUDIO = (
    "sound devices need the PortAudio library, which is not there; install it (Debian: apt install "
    "libportaudio2)"
)


@dataclass(frozen=True, slots=True)
class Device:
    """A sound device as PortAudio lists it: number, name, host interface, tracks in and out, usual rate."""

    number: int
    name: str
    host: str
    inputs: int
    outputs: int
    rate_hz: int


def devices() -> list[Device]:
    """All sound devices of this machine; raises DeviceFault where sounddevice or PortAudio is missing."""
    sounddevice = _sounddevice()
    hosts = [host["name"] for host in sounddevice.query_hostapis()]
    return [
        Device(
            number,
            str(each["name"]),
            str(hosts[each["hostapi"]]),
            int(each["max_input_channels"]),
            int(each["max_output_channels"]),
            round(each["default_samplerate"]),
        )
        for number, each in enumerate(sounddevice.query_devices())
    ]


def found(name: str, *, tracks: int, is_input: bool) -> Device:
    """The device of a number, a name or a part of one, with enough tracks; raises DeviceFault."""
    every = devices()
    fitting = [each for each in every if name in (str(each.number), each.name)] or [
        each for each in every if name.casefold() in f"{each.name}, {each.host}".casefold()
    ]
    if not fitting:
        raise DeviceFault(
            f"there is no sound device {name!r}; morfax devices lists those that are there",
            device=name,
        )
    way = "inputs" if is_input else "outputs"
    wide = [each for each in fitting if getattr(each, way) >= tracks]
    if not wide:
        has = getattr(fitting[0], way)
        raise DeviceFault(
            f"the device {fitting[0].name!r} has {has} {way}; this tape has {tracks} tracks: take a device "
            "with as many, or two stereo files (--stereo)",
            device=name,
        )
    if len(wide) > 1:
        names = ", ".join(f"{each.number} {each.name!r}" for each in wide)
        raise DeviceFault(f"{name!r} may be {names}; give the number", device=name)
    return wide[0]


def rate_for(device: Device, wanted_hz: int, *, tracks: int, is_input: bool) -> int:
    """The wanted rate if the device has it, else the device's own, Hz."""
    sounddevice = _sounddevice()
    check = sounddevice.check_input_settings if is_input else sounddevice.check_output_settings
    try:
        check(device=device.number, channels=tracks, dtype="float32", samplerate=wanted_hz)
    except sounddevice.PortAudioError:
        return device.rate_hz
    return wanted_hz


class DeviceSink:
    """Frames put out to a device; a context manager. Raises DeviceFault for an underrun or a lost device."""

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

    def __enter__(self) -> DeviceSink:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
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

    def put(self, frames: Frames) -> None:
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
            with _as_faults(self._device):
                self._stream = _sounddevice().OutputStream(
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
            f"the device {self._device.name!r} does not start; try another",
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
            if still > STOPPED_S or (self._done.is_set() and not ready()):
                self._fault = (
                    f"the device {self._device.name!r} stopped; connect it and begin again"
                )

    def _fill(self, out: Any, count: int, time: Any, status: Any) -> None:
        """PortAudio's callback: hand it the next frames; what is missing ends the tape."""
        sounddevice = _sounddevice()
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


class DeviceSource:
    """Sound that comes in from a device: the tape between two silences. It can be read once.

    `text`: what the tape's label says, as a text chunk would. Raises DeviceFault for an overrun, a device
    that stops, and where no carriers come within `wait_s`.
    """

    container = "device"
    sample = "FLOAT"

    def __init__(
        self, device: Device, rate_hz: int, tracks: int, text: str = "", wait_s: float = 60.0
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
                piece = self._queue.get(timeout=STOPPED_S)
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
        with _as_faults(self._device):
            self._stream = _sounddevice().InputStream(
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
            raise _sounddevice().CallbackAbort
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


class _as_faults:  # noqa: N801 - reads as a statement
    """Turn an error of PortAudio into a DeviceFault."""

    def __init__(self, device: Device) -> None:
        self._device = device

    def __enter__(self) -> None:
        return None

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        if error is not None and isinstance(error, _sounddevice().PortAudioError):
            name = self._device.name
            raise DeviceFault(
                f"the device {name!r} cannot be used: {error}; morfax devices lists the others",
                device=name,
            ) from error


def _underrun(name: str, time_s: float) -> str:
    """The fault of samples that were not there in time."""
    return (
        f"the device {name!r} ran out of samples {time_s:.2f} s into the tape (an underrun): what is on the "
        "tape has a hole; wind back and record it again, with less other work on this machine"
    )


def _overrun(name: str, time_s: float) -> str:
    """The fault of samples that nobody took in time."""
    return (
        f"samples of the device {name!r} were lost {time_s:.2f} s after it began (an overrun); wind back and "
        "play it again, with less other work on this machine"
    )


def _sounddevice() -> ModuleType:
    """sounddevice; raises DeviceFault that says what to install."""
    try:
        import sounddevice
    except ImportError:
        raise DeviceFault(_INSTALL) from None
    except OSError:
        raise DeviceFault(_NO_PORTAUDIO) from None
    module: ModuleType = sounddevice
    return module
