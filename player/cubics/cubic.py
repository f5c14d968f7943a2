"""The cubic control: interpolator, two-scale measurement, and a servo whose speed modulus is in the program.

Signals: a `.cubic` file in; the machine's own motion out, one sample for each interpolated point.

    tape ─► interpolator 32 ─► predicted ─┐
                                          ├─► difference 29 ─► register 34 ─► decoder 35 ─► servo 36, motor 9
    scales ─► counters 18, 19 ─► present ─┘        counts  │   limited           × modulus    mm/s
        time base 14: one reading and one step of all      └─► monitor

The difference carries the speed and the correction both: at a constant speed v the machine lags by v /
modulus, on all axes alike, so that straight lines stay straight and a circle of radius r shrinks by about v²
/ (2 r modulus²). A larger modulus makes a faster machine of the same program (rough), a smaller one a
smoother (fine). Dropping the lowest digits of the difference makes a rough pass. The monitor allows the lag
that the speed explains, and no more.

Source: patent US 3062995, figures 1 and 3, claims 1 to 10. Questions: the patent gives no modulus; 200 mm/s
for each mm here, and in the historic control as much as its 6.8 points per s allow. That control has figure
3's time base, so that a program takes hundreds of times as long, 64 counts in a pitch, and stores whose
digits come round one by one. At the end the last place is held until the lag is run off, 15 / modulus. A
start at speed and a corner are refused when the program is read.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.axis import TRAVEL_MM
from morfax.motion.drive import SOUND, as_rows
from morfax.motion.faults import LockFault, ProgramFault
from morfax.motion.motion import AXES, Motion
from morfax.player.cubics.interpolator import CubicInterpolator, ends, slopes
from morfax.player.cubics.scales import Scales
from morfax.player.cubics.servo import Servo, run_servos
from morfax.player.cubics.stores import too_long
from morfax.player.cubics.time_base import TimeBase
from morfax.player.monitor.monitor import Supervised
from morfax.recorder.cubics.file import STEPS_PER_CONSTANT, CubicProgram, read_program
from morfax.recorder.textfile import note_of_no_sum

_SETTLING = 15.0  # time constants of the servo: the lag falls to 3e-7 of itself
_BLOCK_INTERVALS = 256  # of the program in memory at a time
_LARGEST_WORD = 2**62  # of register I with its digits


HISTORIC = Servo(scales=Scales(pitch_counts=TimeBase().counts_per_period))


def play_cubic(
    file: str | os.PathLike[str],
    *,
    servo: Servo | None = None,
    travel_mm: float = TRAVEL_MM,
    historic: bool = False,
) -> CubicPlayback:
    """Put a cubic program in the machine; raises ProgramFault and FileFault before anything moves.

    `historic`: with the stores, the scales (unless a servo is given) and the time base of the patent.
    """
    servo = servo or (HISTORIC if historic else Servo())
    return CubicPlayback(read_program(file), servo, travel_mm, str(file), historic)


class CubicPlayback(Supervised):
    """A cubic program in the machine: iterate for the machine's motion, as often as wanted.

    Known beforehand: `format`, `duration_s`, `start_mm`. Figures of the last time through, one per axis:
    `following_error_mm` (the largest difference), `end_mm`, `end_error_mm`. `conditions`: what is wrong with
    the drives.
    """

    def __init__(
        self,
        program: CubicProgram,
        servo: Servo,
        travel_mm: float,
        name: str,
        historic: bool = False,
    ) -> None:
        self.program = program
        self.servo = servo
        self._name = name
        self.format = program.format
        self.notes = () if program.summed else (note_of_no_sum(name),)
        self.historic = historic
        self.base = (
            TimeBase.historic(self.format)
            if historic
            else TimeBase.of(self.format, servo.scales.pitch_counts)
        )
        most_per_s = self.base.step_hz / STEPS_PER_CONSTANT
        told_per_s = program.format.modulus_per_s
        self._modulus_per_s = servo.modulus_per_s or (
            min(told_per_s, most_per_s) if historic else told_per_s
        )
        self.start_mm: Array = np.array(program.checks[0]) / self.format.counts_per_mm
        self.end_mm: Array = self.start_mm.copy()
        self.end_error_mm: Array | None = None
        self.conditions = [SOUND] * len(AXES)
        if self._modulus_per_s > most_per_s:
            raise ProgramFault(
                f"{name}: a speed modulus of {self._modulus_per_s:g} per s is too much for "
                f"{self.base.step_hz:g} points per s; give at most {most_per_s:g}, or record more points"
            )
        self._check(travel_mm)
        self.limit = servo.limit(
            self._modulus_per_s, self.format.counts_per_mm, self.base.step_hz
        )
        self.supervise(AXES, self.base.step_hz)

    @property
    def duration_s(self) -> float:
        """Running time of the machine, s: the program, and the time in which the lag runs off."""
        return (
            len(self.program.words) * self.base.block_s
            + self._settling_points / self.base.step_hz
        )

    @property
    def _settling_points(self) -> int:
        return math.ceil(_SETTLING / self._modulus_per_s * self.base.step_hz)

    def __iter__(self) -> Iterator[Motion]:
        """Play: the motion in blocks; raises LockFault or FollowingFault after the last good sample."""
        fmt = self.format
        start = np.array(self.program.checks[0], np.int64)
        rate_hz = self.base.step_hz
        state = np.zeros((len(AXES), 2))
        state[:, 0] = self.start_mm
        self.supervise(AXES, rate_hz)
        self.end_error_mm = None
        noise = np.random.default_rng(self.servo.seed)
        yield Motion(self.start_mm[None], rate_hz, 0.0)
        done = 0
        for predicted in self._predicted(start):
            moved, present = self._follow(predicted, state, noise)
            demand_mm = predicted[: len(moved)] / fmt.counts_per_mm
            actual_mm = present / fmt.counts_per_mm
            yield from self.followed(demand_mm, actual_mm, moved, (done + 1) / rate_hz)
            done += len(moved)
            if len(moved) < len(predicted):
                raise self._out_of_range(predicted[len(moved)], done)
        self.end_error_mm = (
            self.end_mm
            - np.array(self.program.checks[len(self.program.words)]) / fmt.counts_per_mm
        )

    def _predicted(self, start: NDArray[np.int64]) -> Iterator[NDArray[np.int64]]:
        """The interpolated places in counts, in blocks, and the last one held."""
        fmt = self.format
        interpolator = CubicInterpolator(start, fmt.points, fmt.linear, historic=self.historic)
        for first in range(0, len(self.program.words), _BLOCK_INTERVALS):
            yield interpolator.counts(
                interpolator.run(self.program.words[first : first + _BLOCK_INTERVALS])
            )
        yield np.repeat(interpolator.at[None], self._settling_points, axis=0)

    def _follow(
        self, predicted: NDArray[np.int64], state: Array, noise: np.random.Generator
    ) -> tuple[Array, Array]:
        """Places in mm after each point, and the places in counts that the scales gave before it.

        Fewer rows where a difference was too large for its register.
        """
        servo, fmt = self.servo, self.format
        dt_s = 1 / self.base.step_hz
        moved, present = np.empty(predicted.shape), np.empty(predicted.shape)
        jitter = (
            noise.uniform(-1, 1, (*predicted.shape, 2))
            if self._noisy
            else np.zeros((1, len(AXES), 2))
        )
        register = np.array(
            [fmt.counts_per_mm, 2.0**servo.register_digits, 2.0**servo.dropped_digits]
        )
        gain, most = servo.drive.gain(dt_s), servo.drive.acceleration_mm_s2 * dt_s
        drive = np.array([self._modulus_per_s, gain, most, dt_s])
        wrong = as_rows(self.conditions)
        rows = run_servos(
            predicted,
            jitter,
            servo.scales.table(self.base),
            register,
            drive,
            wrong,
            state,
            present,
            moved,
        )
        return moved[:rows], present[:rows]

    @property
    def _noisy(self) -> bool:
        return (
            self.servo.scales.fine_noise_counts > 0 or self.servo.scales.coarse_noise_digits > 0
        )

    def _out_of_range(self, predicted: NDArray[np.int64], row: int) -> LockFault:
        """The fault of a difference beyond register 34."""
        error_mm = predicted / self.format.counts_per_mm - self.end_mm
        axis = int(np.argmax(np.abs(error_mm)))
        allowed_mm = 2**self.servo.register_digits / self.format.counts_per_mm
        time_s, position_mm = row / self.base.step_hz, float(self.end_mm[axis])
        return LockFault(
            f"the drive of {AXES[axis].upper()} lags {error_mm[axis]:+.3f} mm at {time_s:.3f} s, position "
            f"{position_mm:.3f} mm; allowed ±{allowed_mm:g} mm: take a larger speed modulus, or "
            "record it slower",
            axis=AXES[axis],
            time_s=time_s,
            error_cycles=float(error_mm[axis]) * self.format.counts_per_mm,
            position_mm=position_mm,
        )

    def _check(self, travel_mm: float) -> None:
        """Raise ProgramFault for words that leave the travel, miss a checked place, or turn a corner."""
        fmt, words = self.format, self.program.words
        digits = fmt.digits
        reach = np.abs(words.astype(np.float64)) @ float(fmt.points) ** np.arange(1, 4)
        if reach.sum(axis=0).max(initial=0) > _LARGEST_WORD:
            raise self._fault(
                int(np.argmax(reach.max(axis=1))), "its words are too large for the registers"
            )
        start = np.array(self.program.checks[0], np.int64) << digits
        if self.historic:
            self._check_stores(start)
        places = np.vstack(
            [start[None], start + np.cumsum(ends(words, fmt.points, fmt.linear), axis=0)]
        )
        self._check_travel(places, travel_mm)
        for k, place in self.program.checks.items():
            if (places[k] != np.array(place) << digits).any():
                got = [f"{count / 2**digits:g}" for count in places[k].tolist()]
                stated = " ".join(map(str, place))
                raise self._fault(
                    k - 1,
                    f"the interpolator comes to {', '.join(got)}; the program states {stated}",
                )
        self._check_slopes(*slopes(words, fmt.points, fmt.linear))

    def _check_stores(self, start: NDArray[np.int64]) -> None:
        """Raise ProgramFault for words that a store has too few digits for; the stores are the patent's."""
        n, size = self.format.points, np.abs(self.program.words)
        third = (
            size[..., 1] + n * size[..., 2]
        )  # the most that III and II come to in an interval
        second = size[..., 0] + n * third
        for store, held in enumerate((start[None], second, third, size[..., 2])):
            if too_long(held, store):
                raise self._fault(
                    int(np.argmax(held.max(axis=1))),
                    f"its words have more digits than store {['I', 'II', 'III', 'IV'][store]}",
                )

    def _check_travel(self, places: NDArray[np.int64], travel_mm: float) -> None:
        """Raise ProgramFault for a sample outside the travel."""
        places_mm = np.abs(places / 2.0**self.format.digits / self.format.counts_per_mm)
        out = np.flatnonzero((places_mm > travel_mm).any(axis=1))
        if len(out):
            axis = int(np.argmax(places_mm[out[0]]))
            gone = f"{AXES[axis].upper()} goes to {places_mm[out[0], axis]:.2f} mm either way"
            raise self._fault(int(out[0]) - 1, f"{gone}; the machine has ±{travel_mm:g} mm")

    def _check_slopes(self, start: NDArray[np.int64], end: NDArray[np.int64]) -> None:
        """Raise ProgramFault for a jump of the slope: between intervals, at the start, or at the end."""
        stop = np.zeros((1, start.shape[1]), np.int64)
        bad = np.flatnonzero((np.vstack([stop, end]) != np.vstack([start, stop])).any(axis=1))
        if len(bad):
            raise self._fault(
                int(bad[0]),
                "the curve has a corner there; a corner must be a stop, with speed zero",
            )

    def _fault(self, interval: int, what: str) -> ProgramFault:
        """A fault at an interval, with the line of the file if there is one."""
        lines = self.program.lines
        line = lines[min(max(interval, 0), len(lines) - 1)] if lines else None
        place = "" if line is None else f", line {line}"
        return ProgramFault(
            f"{self._name}{place}: {what}; copy it again or record it again", line=line
        )
