"""The cubic program as a file: one line of words for each interval, as the reader takes them off the tape.

    morfax cubic 1
    interval_s 0.064
    points 64
    linear 1
    counts_per_mm 2000
    modulus_per_s 200
    axes x y z
    intervals 361

    at 90173 53256 4000             a position to start from, or to check the interpolator against, counts
    0 0 0  0 0 0  -11206656 …       A A² A³ of X, of Y, of Z, in counts / points³
    …
    at 90173 53256 4000
    end crc32 8f3a09c1              check sum of all lines before (see textfile.py)

The first `at` loads register I; each other is a check of what the interpolator has come to there, and the
last stands at the end. Blank lines and lines that begin with # are passed over.

Source: patent US 3062995, columns 3, 7 and 8 (the words of the tape, their tags, and positions to be
checked). Questions: the patent's tape is punched, in a code that it does not tell; here the words are
decimal. `points` is p, `linear` q (1: all steps cubic), `modulus_per_s` the speed modulus: mm/s of demand for
each mm of difference.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from morfax.motion.faults import ProgramFault
from morfax.recorder.textfile import AGAIN, Lines, demand, write_lines

VERSION = 1
KIND = "cubic"
AXES_LINE = "axes x y z"
MOST_POINTS = 4096  # of an interval: their cube with the places of a machine fits a register
MOST_INTERVALS = 10_000_000  # 11 hours of the shortest intervals
STEPS_PER_CONSTANT = 4.0  # points in a time constant of the servo; with fewer the servo swings
WORD_BITS = 63  # of a register, sign apart

Words = NDArray[np.int64]
Place = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class CubicFormat:
    """Format of a cubic program; raises ValueError for a value out of its range."""

    interval_s: float = 0.064
    points: int = 64
    linear: int = 1
    counts_per_mm: float = 2000.0
    modulus_per_s: float = 200.0

    def __post_init__(self) -> None:
        demand(
            1e-4 <= self.interval_s <= 3600,
            "interval_s",
            self.interval_s,
            "from 0.0001 s to 3600 s",
        )
        power = 2 <= self.points <= MOST_POINTS and self.points & (self.points - 1) == 0
        demand(power, "points", self.points, f"a power of two from 2 to {MOST_POINTS}")
        divides = 1 <= self.linear <= self.points and self.points % max(1, self.linear) == 0
        demand(divides, "linear", self.linear, f"a divisor of the {self.points} points")
        demand(
            1 <= self.counts_per_mm <= 1e6, "counts_per_mm", self.counts_per_mm, "from 1 to 1e6"
        )
        demand(
            0 < self.modulus_per_s <= 1e5,
            "modulus_per_s",
            self.modulus_per_s,
            "above 0 and at most 1e5",
        )

    @property
    def digits(self) -> int:
        """Binary digits behind the point that make the differences exact: 3 log2 p."""
        return 3 * (self.points.bit_length() - 1)

    @property
    def point_rate_hz(self) -> float:
        """Interpolated points per second, Hz."""
        return self.points / self.interval_s


@dataclass(frozen=True, slots=True)
class CubicProgram:
    """A cubic program: format, words (k, axes, 3), and checked positions in counts by their interval.

    `checks[0]` is the start; `lines` holds the line in the file of each interval; `summed` says whether the
    file has a check sum.
    """

    format: CubicFormat
    words: Words
    checks: dict[int, Place]
    lines: list[int] = field(default_factory=list)
    summed: bool = True


def write_program(program: CubicProgram, file: str | os.PathLike[str]) -> None:
    """Write a program."""
    write_lines(file, _lines(program))


def read_program(file: str | os.PathLike[str]) -> CubicProgram:
    """Read a program; raises ProgramFault with the line that is wrong, FileFault for an unreadable file."""
    lines = Lines(file, KIND, VERSION)
    fmt, intervals = _read_header(lines)
    return _read_words(lines, fmt, intervals)


def _lines(program: CubicProgram) -> Iterator[str]:
    """The lines of a program but the last."""
    fmt, words = program.format, program.words
    yield f"morfax {KIND} {VERSION}"
    yield f"interval_s {fmt.interval_s:.12g}"
    yield f"points {fmt.points}"
    yield f"linear {fmt.linear}"
    yield f"counts_per_mm {fmt.counts_per_mm:.12g}"
    yield f"modulus_per_s {fmt.modulus_per_s:.12g}"
    yield AXES_LINE
    yield f"intervals {len(words)}"
    yield ""
    for k in range(len(words) + 1):
        if k in program.checks:
            yield "at " + " ".join(map(str, program.checks[k]))
        if k < len(words):
            yield "  ".join(" ".join(map(str, axis)) for axis in words[k].tolist())


def _read_header(lines: Lines) -> tuple[CubicFormat, int]:
    """The format and the number of intervals."""
    values: dict[str, float] = {}
    for name in ("interval_s", "points", "linear", "counts_per_mm", "modulus_per_s"):
        values[name] = _single(lines, name)
    if ["axes", *lines.entry("axes")] != AXES_LINE.split():
        raise lines.fault(f"the axes instead of {AXES_LINE}")
    intervals = _single(lines, "intervals")
    try:
        points = _whole("points", values.pop("points"), MOST_POINTS)
        linear = _whole("linear", values.pop("linear"), MOST_POINTS)
        count = _whole("intervals", intervals, MOST_INTERVALS)
        return CubicFormat(points=points, linear=linear, **values), count
    except ValueError as error:
        raise lines.header_fault(error) from None


def _single(lines: Lines, name: str) -> float:
    """The one number of an entry."""
    found = lines.numbers(name)
    if len(found) != 1:
        raise lines.fault(f"{name} has {len(found)} numbers; it must have one")
    return found[0]


def _whole(name: str, value: float, most: int) -> int:
    """A whole number of the header; raises ValueError."""
    demand(
        0 <= value <= most and value == int(value), name, value, f"a whole number up to {most}"
    )
    return int(value)


def _read_words(lines: Lines, fmt: CubicFormat, intervals: int) -> CubicProgram:
    """The words up to the last line, as many intervals as the header states."""
    words: list[list[int]] = []
    checks: dict[int, Place] = {}
    places: list[int] = []
    for line in lines:
        if line.startswith("at "):
            checks[len(words)] = tuple(_words(lines, line[3:], 3))
        else:
            words.append(_words(lines, line, 9))
            places.append(lines.number)
        if 0 not in checks:
            raise lines.fault("no 'at' with a start before the words")
        if len(words) > intervals:
            raise lines.fault(f"more than the {intervals} intervals stated")
    lines.check_whole(len(words), intervals, "intervals")
    if intervals not in checks:
        raise ProgramFault(f"{lines.file}: 'at' must stand behind the last interval; {AGAIN}")
    found = np.array(words, np.int64).reshape(-1, 3, 3)
    return CubicProgram(fmt, found, checks, places, lines.summed)


def _words(lines: Lines, text: str, count: int) -> list[int]:
    """The whole numbers of a line; raises ProgramFault for a wrong count, or a number beyond a register."""
    try:
        found = [int(word) for word in text.split()]
        if len(found) == count and all(abs(word) < 2**WORD_BITS for word in found):
            return found
    except ValueError:
        pass
    raise lines.fault(
        f"{text[:40]!r} is no line of words; it must be {count} whole numbers below 2^{WORD_BITS}, "
        "'at' with 3, or end"
    )
