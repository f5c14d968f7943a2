"""What comes once and goes at once: tapes through pipes and sound devices, for the jobs that record and play.

    record ─► Sink ─► pipe, device                       device, pipe ─► Source ─► play

A device keeps time, so a recording takes as long as the tape. What a tape's text chunk would say has no place
on a device's tracks: the label says it, a file of JSON (`Label` of a reel of tape), or the operator.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import numpy as np

from morfax.jobs.wrong_use import WrongUse
from morfax.motion.usual import SAMPLE_RATE_HZ, TRACKS, WAIT_S

if TYPE_CHECKING:
    from morfax.motion.motion import Motion
    from morfax.recorder.sound.source import Sink, Source
    from morfax.recorder.tape.recording import LiveRecording
    from morfax.recorder.tape.tape import TapeFormat

PIPE = "-"  # instead of a file's name: standard input or output
STANDSTILL_S = 3.0  # at both ends of a tape for a device: time for both recorders to settle


@dataclass(frozen=True, slots=True)
class Intake:
    """The device that a tape is taken in from, and how long its carriers are waited for."""

    device: str | None = None  # number, name or part of a name; None: from a pipe
    wait_s: float = WAIT_S

    def source(self, text: str = "") -> Source:
        """Open the device, or standard input; raises DeviceFault, TapeFault. `text`: the label's."""
        from morfax.recorder.sound.pipe import PipeSource

        if self.device is None:
            pipe = PipeSource(sys.stdin.buffer)
            pipe.text = text or pipe.text
            return pipe
        from morfax.recorder.sound.device import found, rate_for
        from morfax.recorder.sound.device_source import DeviceSource
        from morfax.recorder.tape.format import TapeFormat, is_format_text

        tracks, rate_hz = TRACKS, SAMPLE_RATE_HZ
        if is_format_text(text):
            labelled = TapeFormat.from_json(text)
            tracks, rate_hz = labelled.tracks, labelled.sample_rate_hz
        device = found(self.device, tracks=tracks, is_input=True)
        warmed(TapeFormat(checked=True), plays=True)
        rate_hz = rate_for(device, rate_hz, tracks=tracks, is_input=True)
        return DeviceSource(device, rate_hz, tracks, text, self.wait_s)

    @property
    def called(self) -> str:
        """What it is called."""
        return "the pipe" if self.device is None else f"device {self.device}"


@dataclass(frozen=True, slots=True)
class Outlet:
    """Where a tape goes, if it is not one file: a device, or two stereo files; its label; its standstill."""

    device: str | None = None  # number, name or part of a name
    stereo: bool = False  # two files of two tracks each
    label: FilePath | None = None  # a file for what the tape's tracks do not say
    standstill_s: float | None = None  # at each end; None: 1 s, for a device 3 s

    def suited(self, fmt: TapeFormat) -> TapeFormat:
        """The format with this standstill, at a rate that the device has; raises DeviceFault, ValueError."""
        dwell_s = self.standstill_s
        if dwell_s is None:
            dwell_s = fmt.dwell_s if self.device is None else STANDSTILL_S
        fmt = replace(fmt, dwell_s=dwell_s)
        if self.device is None:
            return fmt
        from morfax.recorder.sound.device import found, rate_for

        device = found(self.device, tracks=fmt.tracks, is_input=False)
        rate_hz = rate_for(device, fmt.sample_rate_hz, tracks=fmt.tracks, is_input=False)
        return replace(fmt, sample_rate_hz=rate_hz)

    def record(self, stream: Iterable[Motion], fmt: TapeFormat) -> LiveRecording:
        """Record into the device, or into standard output; raises what the recorder and the sink raise."""
        from morfax.recorder.tape.recording import record_live

        if self.device is not None:
            warmed(fmt)
        return record_live(stream, self._opener(), fmt)

    def _opener(self) -> Callable[[TapeFormat], Sink]:
        """What opens the sink, once the format is known."""
        if self.device is None:
            from morfax.recorder.sound.pipe import PipeSink

            return lambda fmt: PipeSink(
                sys.stdout.buffer, fmt.sample_rate_hz, fmt.tracks, fmt.to_json()
            )
        from morfax.recorder.sound.device import found
        from morfax.recorder.sound.device_sink import DeviceSink

        name = self.device

        def open_device(fmt: TapeFormat) -> Sink:
            device = found(name, tracks=fmt.tracks, is_input=False)
            return DeviceSink(device, fmt.sample_rate_hz, fmt.tracks)

        return open_device

    def write_label(self, fmt: TapeFormat) -> None:
        """Write the label, where one is wanted."""
        if self.label is None:
            return
        from morfax.motion.files import written_beside

        with written_beside(self.label) as beside:
            beside.write_text(fmt.to_json() + "\n", encoding="utf-8")

    def check(self, output: FilePath | None) -> None:
        """Raise WrongUse for places that exclude each other."""
        if self.device is not None and output is not None:
            raise WrongUse(
                f"a tape goes to a device or to a file: leave out --device, or -o {output}"
            )
        if self.stereo and output is None:
            raise WrongUse("--stereo writes two files; give -o a name such as cam.wav")
        if self.stereo and (self.device is not None or str(output) == PIPE):
            raise WrongUse("--stereo is for files; give -o a name such as cam.wav")


def warmed(fmt: TapeFormat, *, plays: bool = False) -> None:
    """Have the kernels at hand that a device's tape needs: getting them beside it costs samples."""
    import io

    from morfax.motion.motion import Motion, thinned
    from morfax.player.tape.playback import play_pipe
    from morfax.recorder.sound.pipe import PipeSink
    from morfax.recorder.tape.recording import record_live

    pipe = io.BytesIO()
    standing = Motion(
        np.zeros((round(fmt.motion_rate_hz), len(fmt.axes))), fmt.motion_rate_hz, 0.0, fmt.axes
    )
    record_live(
        standing,
        lambda begun: PipeSink(pipe, begun.sample_rate_hz, begun.tracks, begun.to_json()),
        replace(fmt, dwell_s=1.0),
    )
    if plays:
        for _ in thinned(play_pipe(io.BytesIO(pipe.getvalue()))):
            pass
