"""The common time base 14: one oscillator of fast pulses, and the dividers that all else is timed by.

Signals: fast pulses in; words of the registers, readings of the scales, steps of the interpolator, cubic
steps and blocks of the tape out, each a division of the one before.

    54 ─► 56 ÷n ─► words ─► 57 ÷k ─► readings ─► 58 ÷p ─► steps ─► 60 ÷r ─► blocks of the tape
                                        └─► 62 ÷2 ─► carrier of the resolvers     └─► 59 ÷q ─► cubic steps

A period of the carrier holds 2 k n fast pulses: the counts in a pitch of the fine scale.

Source: patent US 3062995, figure 3, columns 9 and 10. Questions: the divider 59 is said to make a ratio p +
q; two dividers in a row make p·q. The usual control takes the pulses that its program's points ask for, and
one reading to a step; `--historic` has figure 3's own numbers, with the program's r (its points) and q.
"""

from __future__ import annotations

from dataclasses import dataclass

from morfax.recorder.cubics.file import CubicFormat


@dataclass(frozen=True, slots=True)
class TimeBase:
    """Fast pulses and their dividers (figure 3's own figures)."""

    fast_hz: float = 3500.0
    word_digits: int = 16  # divider 56, n
    words_per_reading: int = 2  # divider 57, k
    readings_per_step: int = 16  # divider 58, p
    steps_per_cubic: int = 4  # divider 59, q
    steps_per_block: int = 32  # divider 60, r

    @classmethod
    def historic(cls, fmt: CubicFormat) -> TimeBase:
        """Figure 3's oscillator and dividers; the program gives the steps of a block, and of a cubic step."""
        return cls(steps_per_block=fmt.points, steps_per_cubic=fmt.linear)

    @classmethod
    def of(cls, fmt: CubicFormat, pitch_counts: int) -> TimeBase:
        """The time base that takes a program at its own points per second, one reading to a step."""
        base = cls(1.0, pitch_counts // 4 or 1, 2, 1, fmt.linear, fmt.points)
        per_step = base.fast_hz / base.step_hz
        return cls(fmt.point_rate_hz * per_step, base.word_digits, 2, 1, fmt.linear, fmt.points)

    @property
    def word_hz(self) -> float:
        """Words of the registers, Hz."""
        return self.fast_hz / self.word_digits

    @property
    def reading_hz(self) -> float:
        """Readings of the position, Hz."""
        return self.word_hz / self.words_per_reading

    @property
    def carrier_hz(self) -> float:
        """Supply of the resolvers, after the flip-flop 62, Hz."""
        return self.reading_hz / 2

    @property
    def counts_per_period(self) -> int:
        """Fast pulses in a period of the carrier: counts in a pitch of the scale."""
        return 2 * self.words_per_reading * self.word_digits

    @property
    def step_hz(self) -> float:
        """Steps of the interpolator, Hz."""
        return self.reading_hz / self.readings_per_step

    @property
    def cubic_hz(self) -> float:
        """Steps that are cubic while the switch 61 is open, Hz."""
        return self.step_hz / self.steps_per_cubic

    @property
    def block_s(self) -> float:
        """Time between two blocks of the tape, s."""
        return self.steps_per_block / self.step_hz
