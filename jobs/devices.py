"""The job `devices`: the sound devices; a test tone for a recorder, and the levels of its tracks.

    test tone ─► device ─► the recorder's inputs          the recorder's outputs ─► device ─► levels

The tone is a tape at standstill: the reference on every track, at the level of a tape. Levels are told four
times a second, as makers do it, in dB of full scale; of a sine its amplitude counts.

Questions: how loud a recorder may be driven is its own affair; said is where a tape clips here, and where it
is so soft that noise of the sound device counts.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.media.live import Outlet
from morfax.motion.usual import REFERENCE_HZ, SAMPLE_RATE_HZ, TRACKS

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.motion.arrays import Array
    from morfax.motion.motion import Motion
    from morfax.recorder.sound.source import Frames
    from morfax.tracer.operator.operator import Panel

READING_S = 0.25  # from one reading of the meters to the next
LOUDEST_DB, SOFTEST_DB = -1.0, -30.0  # of full scale: beyond, a level is worth a word; chosen
CLIPPED = 0.999  # of full scale
SETTLING_S = 1.0  # that a tone sounds longer than its levels are read
LONGEST_TONE_S = 3600.0

Show = Callable[["Levels"], None]


@dataclass(frozen=True, slots=True)
class Levels:
    """The levels of the tracks at one moment, dB of full scale: peaks, and as of a sine of the same power."""

    peak_db: tuple[float, ...]
    level_db: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class DevicesResult:
    """The figures."""

    figures: Figures


@dataclass(frozen=True, slots=True)
class DevicesJob:
    """List the devices; or play a test tone out of one and show the levels of one, for so many seconds."""

    tone: str | None = None  # the device that the tone goes to
    meters: str | None = None  # the device whose levels are shown
    lasts_s: float = 30.0
    tracks: int = TRACKS
    reference_hz: float = REFERENCE_HZ
    show: Show | None = None  # hears every reading

    def run(self, listener: Listener = SILENT, panel: Panel | None = None) -> DevicesResult:
        """List, or sound and measure; raises DeviceFault."""
        if self.tone is None and self.meters is None:
            return DevicesResult({"devices": _listed()})
        if self.meters is None:
            self._sound(listener)
            return DevicesResult({"tone": self.tone, "duration_s": self.lasts_s})
        sounding, met = self._in_background(listener)
        figures = self._measured(listener)
        if sounding is not None:
            sounding.join()
        if met:
            raise met[0]
        return DevicesResult({"tone": self.tone, "meters": self.meters, **figures})

    def _in_background(
        self, listener: Listener
    ) -> tuple[threading.Thread | None, list[BaseException]]:
        """Begin the test tone beside the meters, and the list for what goes wrong with it."""
        met: list[BaseException] = []
        if self.tone is None:
            return None, met

        def sound() -> None:
            try:
                self._sound(listener)
            except BaseException as error:
                met.append(error)

        thread = threading.Thread(target=sound, daemon=True)
        thread.start()
        return thread, met

    def _sound(self, listener: Listener) -> None:
        """Play the test tone to its end."""
        from morfax.recorder.tape.tape import TapeFormat

        axes = ("x", "y", "z", "a", "b", "c", "u", "v", "w")[: self.tracks - 1]
        bare = TapeFormat(reference_hz=self.reference_hz, axes=axes, dwell_s=0.0)
        outlet = Outlet(self.tone, standstill_s=0.0)
        fmt = outlet.suited(replace(bare, checked=bare.can_be_checked))
        listener.compiling("the recorder", ("motion", "recorder"))
        lasts_s = self.lasts_s + (0.0 if self.meters is None else SETTLING_S)
        outlet.record(_standing(lasts_s, fmt.motion_rate_hz, fmt.axes), fmt)

    def _measured(self, listener: Listener) -> Figures:
        """Read the meters until the time is over; what they showed in the middle, track by track."""
        from morfax.jobs.readings.carriers import measured
        from morfax.recorder.sound.device import found, rate_for
        from morfax.recorder.sound.device_source import DeviceSource

        name = str(self.meters)
        device = found(name, tracks=self.tracks, is_input=True)
        rate_hz = rate_for(device, SAMPLE_RATE_HZ, tracks=self.tracks, is_input=True)
        source = DeviceSource(device, rate_hz, self.tracks)
        kept: list[Frames] = []
        # a tone of our own is waited for
        blocks = source.all_blocks() if self.tone is None else source.stored_blocks()
        try:
            for frames in _read(blocks, rate_hz, self.lasts_s):
                kept.append(frames)
                if self.show is not None:
                    self.show(_levels(frames))
        finally:
            source.close()
        whole = np.concatenate(kept)
        peak = np.abs(whole).max(axis=0)
        for track, (carrier, most) in enumerate(
            zip(carriers := measured(whole, rate_hz), peak, strict=True), 1
        ):
            _remark(listener, track, float(np.median(carrier.level_db)), float(most))
        tracks = {
            f"track_{track}": {
                "level_db": float(np.median(carrier.level_db)),
                "peak_db": _db(most),
                "frequency_hz": _middle(carrier.frequency_hz),
            }
            for track, (carrier, most) in enumerate(zip(carriers, peak, strict=True), 1)
        }
        return {"duration_s": len(whole) / rate_hz, "sample_rate_hz": rate_hz, **tracks}


def _listed() -> list[dict[str, Any]]:
    """The devices, as figures."""
    from morfax.recorder.sound.device import devices

    return [
        {
            "number": each.number,
            "name": each.name,
            "interface": each.host,
            "inputs": each.inputs,
            "outputs": each.outputs,
            "rate_hz": each.rate_hz,
        }
        for each in devices()
    ]


def _standing(lasts_s: float, rate_hz: float, axes: tuple[str, ...]) -> Iterator[Motion]:
    """A motion that stands, in blocks of a second."""
    from morfax.motion.motion import Motion

    done, rows = 0, round(lasts_s * rate_hz)
    while done < rows:
        count = min(round(rate_hz), rows - done)
        yield Motion(np.zeros((count, len(axes))), rate_hz, done / rate_hz, axes)
        done += count


def _read(blocks: Iterator[Any], rate_hz: int, lasts_s: float) -> Iterator[Frames]:
    """Pieces of the length of a reading, until the time is over."""
    held: list[Frames] = []
    wanted, done = round(READING_S * rate_hz), 0
    for block in blocks:
        held.append(block)
        if sum(map(len, held)) < wanted:
            continue
        piece, held = np.concatenate(held), []
        done += len(piece)
        yield piece
        if done >= lasts_s * rate_hz:
            return


def _levels(frames: Frames) -> Levels:
    """The levels of a piece."""
    power: Array = (frames.astype(np.float64) ** 2).mean(axis=0)
    peaks = np.abs(frames).max(axis=0)
    return Levels(
        tuple(_db(peak) for peak in peaks), tuple(_db(np.sqrt(2 * each)) for each in power)
    )


def _db(share: float) -> float:
    """A share of full scale in dB; -100 for silence."""
    return float(20 * np.log10(max(float(share), 1e-5)))


def _middle(frequency_hz: Array) -> float | None:
    """The usual frequency of a carrier; None where there is none."""
    heard = frequency_hz[np.isfinite(frequency_hz)]
    return float(np.median(heard)) if len(heard) else None


def _remark(listener: Listener, track: int, level_db: float, peak: float) -> None:
    """Say what is wrong with the level of a track."""
    if peak >= CLIPPED:
        listener.warning(f"track {track} clips: turn it down by 6 dB")
    elif level_db > LOUDEST_DB:
        listener.warning(f"track {track} is at {level_db:.1f} dB: turn it down to about -6 dB")
    elif level_db < SOFTEST_DB:
        listener.warning(f"track {track} is at {level_db:.1f} dB: turn it up to about -6 dB")
