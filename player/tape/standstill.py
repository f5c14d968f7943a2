"""Bearings: what the standstill at the start of a tape tells the machine, and the watch kept over its tracks.

Signals in: the first frames of the tape (n, tracks) and the first rows of the discriminator; later all its
rows. Out: level of each track (amplitude, full scale 1), frequency of the reference (Hz), zero of each axis
(cycles); later the first row that cannot be trusted, with its fault.

    zero of an axis = mean of its phase over the first 50 ms   (phase changer 155, until the drive stands)

A track that starts at another phase, by another head or by constant skew, only has another zero. A tape is
refused when a track is silent or has no carrier, or when the strongest tone of track 1 is not the reference.
A row cannot be trusted when a phase lies a quarter of a cycle or more from where its motion was taking it
(beyond half a cycle it would be counted as another turn). What a lost level means is in dropouts.py.

Source: patent ES 361967, figure 5 (phase changer 155, triggers 152 and 154, fault circuit 162). Questions:
the patent sets the zero by hand and says nothing of levels. A tape that moves from its very first row has no
standstill: its first row is then the zero. A splice that is a whole number of cycles out has no mark upon it
here; the end position tells it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO
from morfax.motion.faults import LockFault, TapeFault
from morfax.motion.median import TWO_BELOW
from morfax.player.tape.phases import Phases, Uncertain
from morfax.recorder.tape.check_signal import CYCLES_PER_SUBCARRIER
from morfax.recorder.tape.format import SURE_CYCLES, TapeFormat
from morfax.recorder.tape.pickups import DEFAULT_PICK_UP, PICK_UPS

# the patent has no figure; 300 rows at 6 kHz average noise of 40 dB to 6e-5 cycle
STANDSTILL_S = 0.05
SILENT_LEVEL = 1e-3  # -60 dB of full scale
# of a track's power; 20 dB of noise leave 0.99, clipping to a square 0.81, white noise has 0.2
CARRIER_SHARE = 0.9
# of the level: with a fifth of it from another signal the phase turns by 0.03 cycle
LEVEL_STEADY = 0.8
# of the first 50 ms that may be a fifth and more below the level: 2.5 ms with any phase, up to half a cycle
# off, turn the zero by half of what is allowed
WEAK_SHARE = 0.05
LEVEL_LOST = 0.5  # of the level: a dropout
FEWEST_STEADY_ROWS = 48  # 8 ms at 6 kHz: a carrier with a dropout, and not a track without one
ALLOWED_CYCLES = 0.05  # that any cause may turn a phase: 2.5 um at 20 cycles per mm
# 1.31 and more of a sine with eight samples, 1.20 where two thirds of it are cut off
LEAST_CREST = 1.24
# RMS at standstill: five times as much is a twentieth of a cycle; 20 dB of noise make 0.0079
UNSTEADY_CYCLES = 0.009
# median surprise at standstill: 24.2 dB of noise (26 dB shake by 0.0028 to 0.003). With 23.1 dB a drive came
# 0.0506 cycle off, at the limit of its acceleration where the speed jumps
CALM_CYCLES = 0.0035
REFERENCE_BAND = 0.1  # a tape's speed may be this much off
FEWEST_FRAMES = 8  # of which a spectrum has a peak between two other lines
SPECTRUM_FRAMES = 16384  # 0.34 s at 48 kHz: lines of 2.9 Hz

Float32s = NDArray[np.float32]
Float64s = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Bearings:
    """The tracks at standstill; `names` are those of the axes."""

    levels: Float64s
    zero_cycles: Float64s
    reference_hz: float
    names: Sequence[str]

    def first_fault(
        self, phases: Phases, rate_hz: float, positions_mm: Sequence[float]
    ) -> Uncertain | None:
        """The first row that no motion explains, and its fault; the screws stood at `positions_mm`."""
        sizes = np.abs(phases.surprise)
        if sizes.max(initial=0.0) < SURE_CYCLES:
            return None
        jumped = ~(sizes < SURE_CYCLES)
        row = int(np.argmax(jumped.any(axis=1)))
        time_s, axis = (phases.first_row + row) / rate_hz, int(np.argmax(jumped[row]))
        surprise = float(phases.surprise[row, axis])
        return Uncertain(row, self._jump(axis, surprise, time_s, positions_mm[axis]))

    def _jump(self, axis: int, surprise: float, time_s: float, position_mm: float) -> LockFault:
        """The fault of a phase that no motion explains."""
        return LockFault(
            f"the phase of {self.names[axis].upper()} jumps by {surprise:+.2f} cycle at {time_s:.3f} s, "
            f"position {position_mm:.3f} mm; {SURE_CYCLES:g} is allowed; look for a splice, dropout or "
            "sudden stop there",
            axis=self.names[axis],
            time_s=time_s,
            error_cycles=surprise,
            position_mm=position_mm,
        )


def take_bearings(frames: Float32s, phases: Phases, fmt: TapeFormat) -> Bearings:
    """Bearings from the first frames and rows; raises TapeFault if a track or the reference is missing."""
    names, reference_hz = fmt.axes, fmt.reference_hz
    still = frames[: round(STANDSTILL_S * fmt.sample_rate_hz)]
    power = np.var(still, axis=0, dtype=np.float64)  # without a DC offset
    for track, mean_square in enumerate(power):
        _demand_signal(track, float(mean_square), names)
    found_hz = strongest_hz(frames[:, 0], fmt.sample_rate_hz)
    _demand_reference(found_hz, fmt)
    rows = max(round(STANDSTILL_S * fmt.motion_rate_hz), 1)
    levels = phases.levels[:rows].astype(np.float64).mean(axis=0)
    for track in range(len(levels)):
        # the reference comes from its source, a sine
        sensor = PICK_UPS[DEFAULT_PICK_UP] if track == 0 else fmt.sensor
        share = CARRIER_SHARE * sensor.fundamental_share(reference_hz, fmt.sample_rate_hz)
        _demand_no_dropout(track, phases.levels[:rows, track], still[:, track], share, fmt)
        if not sensor.flat:
            _demand_round(track, still[:, track], names)
        _demand_carrier(track, float(levels[track]), float(power[track]), share, names)
    zero = _zero(phases.cycles[:rows])
    if fmt.dwell_s >= STANDSTILL_S and not phases.first_row:
        _demand_standstill(phases.cycles[:rows], names)
    standing = phases.cycles[: _standing(phases.cycles, zero, fmt, rows)]
    if len(standing) > rows:
        # a dropout may have cost whole cycles by now
        off = standing - zero - np.round(standing - zero)
        _demand_steady(off, names)
        _demand_calm(phases.surprise[: len(standing)], names)
        zero = zero + np.median(off, axis=0)
    return Bearings(levels, zero, found_hz, names)


def _standing(cycles: Float64s, zero: Float64s, fmt: TapeFormat, least: int) -> int:
    """Rows of the standstill at the start, as long as all axes stay near their zero."""
    stated = min(round((1 - REFERENCE_BAND) * fmt.dwell_s * fmt.motion_rate_hz), len(cycles))
    if stated < least:
        return 0
    # one that starts in the last of these rows is known by those behind them
    moved = (np.abs(cycles[: stated + least] - zero) > SURE_CYCLES).any(axis=1)
    # longer than a dropout
    steps = np.flatnonzero(np.convolve(moved, np.ones(least), "valid") == least)
    # an axis may have crept before it was seen
    return min(max(int(steps[0]) - least, 0), stated) if len(steps) else stated


def _demand_standstill(cycles: Float64s, names: Sequence[str]) -> None:
    """Raise TapeFault for a tape that states a standstill and starts under way."""
    moved = np.ptp(cycles, axis=0)
    axis = int(np.argmax(moved))
    if moved[axis] >= SURE_CYCLES:
        raise TapeFault(
            f"the tape starts while {names[axis].upper()} moves, and should stand: its start is missing, "
            "so where it starts is not known; get the whole tape, or go on from a place (--resume-at 0.1s"
            " --from X,Y,Z)"
        )


def _demand_steady(standing: Float64s, names: Sequence[str]) -> None:
    """Raise TapeFault for phases that swing too far at standstill for a certain position."""
    # without dropouts
    low, high = np.percentile(standing, [TWO_BELOW, 100 - TWO_BELOW], axis=0)
    swing = (high - low) / 4
    axis = int(np.argmax(swing))
    if not swing[axis] <= UNSTEADY_CYCLES:
        raise TapeFault(
            f"the phase of {names[axis].upper()} swings by {swing[axis]:.3f} cycle (RMS) at standstill, at "
            f"most {UNSTEADY_CYCLES:g} is allowed: noise, crosstalk or tape that weaves; copy the tape on a "
            "better machine"
        )


def _demand_calm(surprise: Float32s, names: Sequence[str]) -> None:
    """Raise TapeFault for phases that shake at standstill by more than a drive can follow later."""
    shakes = np.median(np.abs(surprise), axis=0)
    axis = int(np.argmax(shakes))
    if not shakes[axis] <= CALM_CYCLES:
        raise TapeFault(
            f"the phase of {names[axis].upper()} shakes by {shakes[axis]:.4f} cycle (median) at standstill, "
            f"at most {CALM_CYCLES:g} is allowed: noise, crosstalk or print-through, which the motors cannot "
            "follow; copy the tape on a better machine"
        )


def evened(phases: Phases, fmt: TapeFormat) -> Phases:
    """The rows with levels as at standstill: a coil's level grows with the frequency of its track."""
    if not fmt.sensor.by_speed or len(phases) < 2:
        return phases
    speed = np.gradient(phases.cycles, axis=0) * fmt.motion_rate_hz
    most = fmt.largest_deviation_hz  # what the phase does in a dropout is no speed
    levels = phases.levels.copy()
    levels[:, 1:] /= 1 + np.clip(speed, -most, most) / fmt.reference_hz
    return replace(phases, levels=levels, room=0)


def strongest_hz(samples: Float32s, sample_rate_hz: float) -> float:
    """Frequency of the strongest tone in the first samples, true to a tenth of a spectral line, Hz."""
    samples = samples[:SPECTRUM_FRAMES]
    if len(samples) < FEWEST_FRAMES or not np.isfinite(samples).all():
        return 0.0
    spectrum = np.abs(np.fft.rfft((samples - samples.mean()) * np.hanning(len(samples))))
    peak = min(max(int(np.argmax(spectrum)), 1), len(spectrum) - 2)
    left, middle, right = np.log(spectrum[peak - 1 : peak + 2] + NOT_ZERO)
    bend = left - 2 * middle + right
    shift = 0.5 * (left - right) / bend if bend < 0 else 0.0
    return float((peak + shift) * sample_rate_hz / len(samples))


def track_name(track: int, names: Sequence[str]) -> str:
    """The name of a track's signal."""
    return "reference" if track == 0 else names[track - 1].upper()


def decibels(level: float) -> str:
    """A level in dB of full scale, as text."""
    return f"{20 * math.log10(level):.0f} dB" if level > 0 else "none"


def _zero(cycles: Float64s) -> Float64s:
    """Phase at standstill, cycles; for an axis that moves already, the phase of its first row."""
    stands = np.ptp(cycles, axis=0) < SURE_CYCLES
    return np.where(stands, cycles.mean(axis=0), cycles[0])


def _demand_reference(found_hz: float, fmt: TapeFormat) -> None:
    """Raise TapeFault if the strongest frequency of track 1 is not that of the reference."""
    reference_hz = fmt.reference_hz
    if abs(found_hz * CYCLES_PER_SUBCARRIER / reference_hz - 1) <= REFERENCE_BAND:
        raise TapeFault(
            f"track 1 carries the check signal of {found_hz:.0f} Hz and not the carrier of {reference_hz:g} "
            f"Hz: the band of its recorder ends below; take one that passes {2 / 3 * reference_hz:.0f} to "
            f"{4 / 3 * reference_hz:.0f} Hz"
        )
    if not abs(found_hz / reference_hz - 1) <= REFERENCE_BAND:
        own = f"the tape's own (--reference-frequency {found_hz:.0f}Hz)"
        if 8 * found_hz > 3 * fmt.sample_rate_hz:  # a third more is to be on the tape too
            own = "the tape without the hiss before it"
        raise TapeFault(
            f"track 1 carries {found_hz:.0f} Hz where the reference of {reference_hz:g} Hz should be, within "
            f"{REFERENCE_BAND:.0%}; give {own}, or its tracks in order"
        )


def _demand_signal(track: int, mean_square: float, names: Sequence[str]) -> None:
    """Raise TapeFault for a silent track."""
    level = math.sqrt(2 * mean_square)
    if not level >= SILENT_LEVEL:
        raise TapeFault(
            f"track {track + 1} ({track_name(track, names)}) is silent: level {decibels(level)}, at least "
            f"{decibels(SILENT_LEVEL)} of full scale is needed; "
            f"{'without the reference no place can be known: ' * (not track)}give a copy that has it, or say "
            f"which tracks are reference, {', '.join(name.upper() for name in names)} (--tracks)"
        )


def _demand_round(track: int, samples: Float32s, names: Sequence[str]) -> None:
    """Raise TapeFault for a track so clipped that its harmonics fold back upon the carrier."""
    swing = samples - np.median(samples)
    crest = float(np.percentile(np.abs(swing), 98) / np.std(swing))
    if not crest >= LEAST_CREST:
        raise TapeFault(
            f"track {track + 1} ({track_name(track, names)}) is clipped: its peak is {crest:.2f} of its "
            f"root mean square, at least {LEAST_CREST:g} is needed; copy the tape again at a lower level"
        )


def _demand_no_dropout(
    track: int, levels: Float32s, samples: Float32s, share: float, fmt: TapeFormat
) -> None:
    """Raise TapeFault for a track whose carrier drops out within the first 50 ms."""
    steady = levels > LEVEL_STEADY * np.percentile(levels, 90)
    edges = np.flatnonzero(np.diff(np.r_[False, steady, False]))
    enough = float(levels.mean()) ** 2 / 2 >= share * float(np.var(samples, dtype=np.float64))
    if not len(edges) or (enough and float((~steady).mean()) < WEAK_SHARE):
        return  # nothing to be heard, or enough of it
    runs = zip(edges[::2], edges[1::2], strict=True)
    first, last = max(runs, key=lambda run: run[1] - run[0])
    heard = samples[first * fmt.samples_per_motion : last * fmt.samples_per_motion]
    level, power = float(levels[first:last].mean()), float(np.var(heard, dtype=np.float64))
    weak = levels < LEVEL_LOST * level
    if last - first < FEWEST_STEADY_ROWS or level**2 / 2 < share * power or not weak.any():
        return
    raise TapeFault(
        f"track {track + 1} ({track_name(track, fmt.axes)}) has a dropout at "
        f"{np.argmax(weak) / fmt.motion_rate_hz:.3f} s, within the first {STANDSTILL_S * 1e3:g} ms, from "
        "which its level and zero are told; copy the tape again, or go on behind it (--resume-at 0.1s "
        "--from X,Y,Z)"
    )


def _demand_carrier(
    track: int, level: float, mean_square: float, least: float, names: Sequence[str]
) -> None:
    """Raise TapeFault for a track with a signal but no carrier in it."""
    share = level**2 / 2 / mean_square
    if not share >= least:
        raise TapeFault(
            f"track {track + 1} ({track_name(track, names)}) has no carrier: {share:.1%} of its power "
            f"lies round the reference, at least {least:.0%} is needed; this is no tape for it, or its "
            "reference is another"
        )
