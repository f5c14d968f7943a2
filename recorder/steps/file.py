"""The punched tape as a file: rows of holes that a text editor shows as they would be punched.

    morfax steps 1
    step_mm 0.01
    oscillator_hz 10240
    rates 1 2 3 4 5 6 7
    vectors 2
    channels 8
    start_mm 45.09 26.63 2.0
    end_mm 45.09 26.63 2.0
    rows 3622

    ...o...o         bits 8 … 1 from left to right, o a hole
    ...o....  x12    the same row twelve times
    end

`rates` are the pulses of an interval for each count from the middle; `vectors` the vector commands in one row
(1 as in figure 6, 2 as in figure 11); `rows` counts repeated rows each time. Blank lines and lines that begin
with # are passed over.

Source: patent ES 443122, figures 3, 6 and 11; page 23 (a succession of like commands may be stored shorter,
further bits may command a tool). Questions: the patent has five channels, for two axes. Bits 7 and 6 are the
Z counter's here, in the code of figure 3, and bit 8 says that the tool is in the work. What a program starts
from and how large its steps are was set at the machine; here the file says it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from itertools import groupby
from pathlib import Path as FilePath

import numpy as np
from numpy.typing import NDArray

from morfax.motion.faults import FileFault, ProgramFault
from morfax.motion.files import written_beside

VERSION = 1
STEP_MM = 0.01
HEADER = "morfax steps"
TICKS = 64  # oscillator pulses in an interval
MOST_ROWS = 2_000_000  # three and a half hours at 160 rows/s
_MOST_MM = 1e6

Rows = NDArray[np.uint8]
_ROW = re.compile(r"([o.]+)(?:\s+x\s*(\d{1,9}))?")
_AGAIN = "record it again"


@dataclass(frozen=True, slots=True)
class StepFormat:
    """Format of a step program; raises ValueError if it cannot be."""

    step_mm: float = STEP_MM
    oscillator_hz: float = 10240.0
    rates: tuple[int, ...] = (1, 2, 3, 4, 5, 6, 7)
    vectors: int = 2
    channels: int = 8
    start_mm: tuple[float, ...] = (0.0, 0.0, 0.0)
    end_mm: tuple[float, ...] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        _demand(0 < self.step_mm <= 1, "step_mm", self.step_mm, "above 0 and at most 1 mm")
        _demand(
            1 <= self.oscillator_hz <= 1e9,
            "oscillator_hz",
            self.oscillator_hz,
            "from 1 Hz to 1e9 Hz",
        )
        good = len(self.rates) == 7 and all(0 < n <= TICKS for n in self.rates)
        _demand(good, "rates", self.rates, f"7 whole numbers of pulses from 1 to {TICKS}")
        _demand(
            self.vectors in (1, 2), "vectors", self.vectors, "1 (figure 6) or 2 (figure 11)"
        )
        _demand(self.channels in (5, 8), "channels", self.channels, "5 or 8")
        for name in ("start_mm", "end_mm"):
            place = getattr(self, name)
            _demand(
                len(place) == 3 and all(abs(mm) < _MOST_MM for mm in place),
                name,
                place,
                "three numbers of mm",
            )

    @property
    def interval_s(self) -> float:
        """Length of an interval, s."""
        return TICKS / self.oscillator_hz

    @property
    def rate_hz(self) -> float:
        """The lowest rate of pulses K, one in an interval, Hz."""
        return self.oscillator_hz / TICKS

    @property
    def acceleration_steps_s2(self) -> float:
        """The largest change of the rate of pulses that any tape of this format can ask for, steps/s²."""
        return (
            max(abs(b - a) for a, b in zip((0, *self.rates), self.rates, strict=False))
            * self.rate_hz**2
        )


@dataclass(frozen=True, slots=True)
class Program:
    """A step program: its format, its rows as bytes (bit 1 the lowest), and the line of the file of each row."""

    format: StepFormat
    rows: Rows
    lines: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))


def write_program(program: Program, file: str | os.PathLike[str]) -> None:
    """Write a program; equal rows that follow each other stand in one line."""
    with (
        written_beside(file) as beside,
        beside.open("w", encoding="ascii", newline="\n") as out,
    ):
        out.write(f"{HEADER} {VERSION}\n")
        for entry in fields(StepFormat):
            out.write(f"{entry.name} {_told(getattr(program.format, entry.name))}\n")
        out.write(f"rows {len(program.rows)}\n\n")
        out.writelines(_lines(program))
        out.write("end\n")


def read_program(file: str | os.PathLike[str]) -> Program:
    """Read a program; raises ProgramFault with the line where it is none, FileFault if it cannot be read."""
    lines = _numbered(FilePath(file))
    version_line, version = next(lines, (1, ""))
    if version.split()[:2] != HEADER.split():
        raise ProgramFault(
            f"{file} is no step program: it must begin with '{HEADER} {VERSION}'; give another",
            line=1,
        )
    if version != f"{HEADER} {VERSION}":
        raise ProgramFault(
            f"{file}, line {version_line}: the format is version {version.split()[-1][:20]}; this program reads "
            f"{VERSION}: use a later one",
            line=version_line,
        )
    fmt, count = _read_header(file, lines)
    return _read_rows(file, lines, fmt, count)


def holes(code: int, channels: int) -> str:
    """A row as it is written: bits from the highest to the lowest, o a hole."""
    return "".join("o" if code >> bit & 1 else "." for bit in range(channels - 1, -1, -1))


def _lines(program: Program) -> Iterator[str]:
    """The lines of the rows."""
    for code, alike in groupby(program.rows.tolist()):
        times = sum(1 for _ in alike)
        yield holes(code, program.format.channels) + (f"  x{times}\n" if times > 1 else "\n")


def _told(value: object) -> str:
    """A value as it stands in the header."""
    return " ".join(map(_told, value)) if isinstance(value, tuple) else f"{value:.12g}"


def _numbered(file: FilePath) -> Iterator[tuple[int, str]]:
    """The lines that count, with their numbers."""
    try:
        text = file.read_bytes().decode("ascii")
    except UnicodeDecodeError as error:
        raise ProgramFault(
            f"{file} is no step program: byte {error.start} is no ASCII text; give another"
        ) from None
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from error
    for number, line in enumerate(text.splitlines(), 1):
        if line.strip() and not line.startswith("#"):
            yield number, line.strip()


def _read_header(
    file: str | os.PathLike[str], lines: Iterator[tuple[int, str]]
) -> tuple[StepFormat, int]:
    """The format, and the number of rows; all entries must be there, in their order."""
    values: dict[str, tuple[float, ...]] = {}
    number = 1
    for name in [*(entry.name for entry in fields(StepFormat)), "rows"]:
        number, line = next(lines, (number, ""))
        words = line.split()
        if not words or words[0] != name:
            raise ProgramFault(
                f"{file}, line {number}: {line[:40]!r} instead of {name}; {_AGAIN}", line=number
            )
        try:
            values[name] = tuple(float(word) for word in words[1:])
        except ValueError:
            raise ProgramFault(
                f"{file}, line {number}: {line[:40]!r} is no number; {_AGAIN}", line=number
            ) from None
    try:
        return _format(values), int(_single(values, "rows", 0, MOST_ROWS))
    except ValueError as error:
        raise ProgramFault(f"{file}, header: {error}; {_AGAIN}") from None


def _format(values: dict[str, tuple[float, ...]]) -> StepFormat:
    """The format of the header's numbers; raises ValueError."""
    whole = {name: int(_single(values, name, 0, TICKS)) for name in ("vectors", "channels")}
    rates = tuple(int(n) if n == round(n) else 0 for n in values["rates"] if abs(n) <= TICKS)
    step, oscillator = (
        _single(values, "step_mm", 0, 1),
        _single(values, "oscillator_hz", 1, 1e9),
    )
    return StepFormat(
        step, oscillator, rates, **whole, start_mm=values["start_mm"], end_mm=values["end_mm"]
    )


def _single(
    values: dict[str, tuple[float, ...]], name: str, least: float, most: float
) -> float:
    """The one number of an entry; raises ValueError."""
    got = values[name]
    _demand(
        len(got) == 1 and least <= got[0] <= most,
        name,
        " ".join(map(str, got)),
        f"from {least:g} to {most:g}",
    )
    return got[0]


def _read_rows(
    file: str | os.PathLike[str], lines: Iterator[tuple[int, str]], fmt: StepFormat, count: int
) -> Program:
    """The rows up to `end`, as many as the header says."""
    codes: list[int] = []
    times: list[int] = []
    places: list[int] = []
    total = 0
    for number, line in lines:
        if line == "end":
            break
        found = _ROW.fullmatch(line)
        if found is None or len(found[1]) != fmt.channels:
            allowed = f"{fmt.channels} of o and ., or end"
            raise ProgramFault(
                f"{file}, line {number}: {line[:40]!r} is no row; it must be {allowed}",
                line=number,
            )
        codes.append(int(found[1].replace("o", "1").replace(".", "0"), 2))
        times.append(int(found[2] or 1))
        places.append(number)
        total += times[-1]
        if total > count:
            raise ProgramFault(
                f"{file}, line {number}: more than the {count} rows stated; {_AGAIN}",
                line=number,
            )
    else:
        raise ProgramFault(
            f"{file} is cut short: {total} of {count} rows and no end; copy it again or {_AGAIN}"
        )
    if total != count:
        raise ProgramFault(
            f"{file} has {total} rows, but states {count}; copy it again or {_AGAIN}"
        )
    return Program(
        fmt,
        np.repeat(np.array(codes, np.uint8), times),
        np.repeat(np.array(places, np.int64), times),
    )


def _demand(good: bool, name: str, value: object, allowed: str) -> None:
    """Raise ValueError with the entry, the value got and the values allowed."""
    if not good:
        raise ValueError(f"{name} is {str(value)[:60]}; it must be {allowed}")
