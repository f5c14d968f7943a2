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
    end

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
from pathlib import Path as FilePath

import numpy as np
from numpy.typing import NDArray

from morfax.motion.faults import FileFault, ProgramFault
from morfax.motion.files import written_beside

VERSION = 1
HEADER = "morfax cubic"
AXES_LINE = "axes x y z"
MOST_POINTS = 4096
MOST_INTERVALS = 10_000_000
STEPS_PER_CONSTANT = 4.0  # points in a time constant of the servo, below which it would swing
WORD_BITS = 63  # of the registers, sign apart
_AGAIN = "record it again"

Words = NDArray[np.int64]
Place = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class CubicFormat:
    """Format of a cubic program; raises ValueError if it cannot be."""

    interval_s: float = 0.064
    points: int = 64
    linear: int = 1
    counts_per_mm: float = 2000.0
    modulus_per_s: float = 200.0

    def __post_init__(self) -> None:
        _demand(
            1e-4 <= self.interval_s <= 3600,
            "interval_s",
            self.interval_s,
            "from 0.0001 s to 3600 s",
        )
        power = 2 <= self.points <= MOST_POINTS and self.points & (self.points - 1) == 0
        _demand(power, "points", self.points, f"a power of two from 2 to {MOST_POINTS}")
        divides = 1 <= self.linear <= self.points and self.points % max(1, self.linear) == 0
        _demand(divides, "linear", self.linear, f"a divisor of the {self.points} points")
        _demand(
            1 <= self.counts_per_mm <= 1e6, "counts_per_mm", self.counts_per_mm, "from 1 to 1e6"
        )
        _demand(
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
    """A cubic program: format, words (k, axes, 3), positions in counts by the interval before which they
    stand.

    `checks[0]` is the start; `lines` holds the line in the file of each interval.
    """

    format: CubicFormat
    words: Words
    checks: dict[int, Place]
    lines: list[int] = field(default_factory=list)


def write_program(program: CubicProgram, file: str | os.PathLike[str]) -> None:
    """Write a program."""
    fmt = program.format
    with (
        written_beside(file) as beside,
        beside.open("w", encoding="ascii", newline="\n") as out,
    ):
        out.write(
            f"{HEADER} {VERSION}\ninterval_s {fmt.interval_s:.12g}\npoints {fmt.points}\nlinear {fmt.linear}\n"
        )
        out.write(
            f"counts_per_mm {fmt.counts_per_mm:.12g}\nmodulus_per_s {fmt.modulus_per_s:.12g}\n{AXES_LINE}\n"
        )
        out.write(f"intervals {len(program.words)}\n\n")
        for k in range(len(program.words) + 1):
            if k in program.checks:
                out.write("at " + " ".join(map(str, program.checks[k])) + "\n")
            if k < len(program.words):
                out.write(
                    "  ".join(" ".join(map(str, axis)) for axis in program.words[k].tolist())
                    + "\n"
                )
        out.write("end\n")


def read_program(file: str | os.PathLike[str]) -> CubicProgram:
    """Read a program; raises ProgramFault with the line where it is none, FileFault if it cannot be read."""
    lines = _numbered(FilePath(file))
    _, version = next(lines, (1, ""))
    if version.split()[:2] != HEADER.split():
        raise ProgramFault(
            f"{file} is no cubic program: it must begin with '{HEADER} {VERSION}'; give another",
            line=1,
        )
    if version != f"{HEADER} {VERSION}":
        found = version.split()[-1][:20]
        raise ProgramFault(
            f"{file}: the format is version {found}; this program reads {VERSION}: use a later one",
            line=1,
        )
    fmt, intervals = _read_header(file, lines)
    return _read_words(file, lines, fmt, intervals)


def _numbered(file: FilePath) -> Iterator[tuple[int, str]]:
    """The lines that count, with their numbers."""
    try:
        text = file.read_bytes().decode("ascii")
    except UnicodeDecodeError as error:
        raise ProgramFault(
            f"{file} is no cubic program: byte {error.start} is no ASCII text; give another"
        ) from None
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from error
    for number, line in enumerate(text.splitlines(), 1):
        if line.strip() and not line.startswith("#"):
            yield number, line.strip()


def _read_header(
    file: str | os.PathLike[str], lines: Iterator[tuple[int, str]]
) -> tuple[CubicFormat, int]:
    """The format and the number of intervals."""
    values: dict[str, float] = {}
    number = 1
    for name in (
        "interval_s",
        "points",
        "linear",
        "counts_per_mm",
        "modulus_per_s",
        "axes",
        "intervals",
    ):
        number, line = next(lines, (number, ""))
        words = line.split()
        if len(words) < 2 or words[0] != name or (name == "axes" and line != AXES_LINE):
            wanted = AXES_LINE if name == "axes" else name
            raise ProgramFault(
                f"{file}, line {number}: {line[:40]!r} instead of {wanted}; {_AGAIN}",
                line=number,
            )
        if name != "axes":
            values[name] = _number(file, number, words)
    try:
        for name, most in (
            ("points", MOST_POINTS),
            ("linear", MOST_POINTS),
            ("intervals", MOST_INTERVALS),
        ):
            whole = 0 <= values[name] <= most and values[name] == int(values[name])
            _demand(whole, name, values[name], f"a whole number up to {most}")
        intervals, points, linear = (
            int(values.pop(name)) for name in ("intervals", "points", "linear")
        )
        return CubicFormat(points=points, linear=linear, **values), intervals
    except ValueError as error:
        raise ProgramFault(f"{file}, header: {error}; {_AGAIN}") from None


def _number(file: str | os.PathLike[str], number: int, words: list[str]) -> float:
    """The one number of an entry."""
    try:
        (value,) = (float(word) for word in words[1:])
    except ValueError:
        got = " ".join(words)[:40]
        raise ProgramFault(
            f"{file}, line {number}: {got!r} is not one number; {_AGAIN}", line=number
        ) from None
    return value


def _read_words(
    file: str | os.PathLike[str],
    lines: Iterator[tuple[int, str]],
    fmt: CubicFormat,
    intervals: int,
) -> CubicProgram:
    """The words up to `end`, as many intervals as the header says."""
    words: list[list[int]] = []
    checks: dict[int, Place] = {}
    places: list[int] = []
    for number, line in lines:
        if line == "end":
            break
        if line.startswith("at "):
            checks[len(words)] = tuple(_whole(file, number, line[3:], 3))
        else:
            words.append(_whole(file, number, line, 9))
            places.append(number)
        if len(words) > intervals or 0 not in checks:
            what = (
                f"more than the {intervals} intervals stated"
                if checks
                else "no 'at' with a start before the words"
            )
            raise ProgramFault(f"{file}, line {number}: {what}; {_AGAIN}", line=number)
    else:
        raise ProgramFault(
            f"{file} is cut short: {len(words)} of {intervals} intervals and no end; copy it again"
        )
    if len(words) != intervals or intervals not in checks:
        raise ProgramFault(
            f"{file}: {len(words)} intervals where {intervals} and 'at' must stand; copy it again"
        )
    return CubicProgram(fmt, np.array(words, np.int64).reshape(-1, 3, 3), checks, places)


def _whole(file: str | os.PathLike[str], number: int, text: str, count: int) -> list[int]:
    """So many whole numbers that fit a register."""
    try:
        found = [int(word) for word in text.split()]
        if len(found) == count and all(abs(word) < 2**WORD_BITS for word in found):
            return found
    except ValueError:
        pass
    raise ProgramFault(
        f"{file}, line {number}: {text[:40]!r} is no line of words; it must be {count} whole numbers below "
        f"2^{WORD_BITS}, 'at' with 3, or end; {_AGAIN}",
        line=number,
    )


def _demand(good: bool, name: str, value: object, allowed: str) -> None:
    """Raise ValueError with the entry, the value got and the values allowed."""
    if not good:
        raise ValueError(f"{name} is {str(value)[:60]}; it must be {allowed}")
