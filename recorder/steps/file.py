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
    end crc32 8f3a09c1     check sum of all lines before (see textfile.py)

`rates` are the pulses of an interval for each count from the middle; `vectors` the vector commands in one row
(1 as in figure 6, 2 as in figure 11; 0: the orders are the counts themselves, in 13 channels, claim 8);
`rows` counts repeated rows each time. Blank lines and lines that begin with # are passed over.

Source: patent ES 443122, figures 3, 6 and 11; page 23 (a succession of like commands may be stored shorter,
further bits may command a tool). Questions: the patent has five channels, for two axes. Bits 7 and 6 are the
Z counter's here, in the code of figure 3, and bit 8 says that the tool is in the work. Of 13 channels the
first four hold the count of X, the next those of Y and Z, and the last the tool. What a program starts
from and how large its steps are was set at the machine; here the file says it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from morfax.motion.units import LONGEST_MM
from morfax.recorder.textfile import Lines, demand, write_lines

VERSION = 1
KIND = "steps"
STEP_MM = 0.01  # chosen here; the patent gives no size of a step
TICKS = 64  # oscillator pulses in an interval
STANDSTILL, LOWEST, HIGHEST = 8, 1, 15  # counts of an axis
MOST_ROWS = 2_000_000  # three and a half hours at 160 rows/s

Rows = NDArray[np.uint16]
_ROW = re.compile(r"([o.]+)(?:\s+x\s*(\d{1,9}))?")


@dataclass(frozen=True, slots=True)
class StepFormat:
    """Format of a step program; raises ValueError for a value out of its range."""

    step_mm: float = STEP_MM
    oscillator_hz: float = 10240.0
    rates: tuple[int, ...] = (1, 2, 3, 4, 5, 6, 7)
    vectors: int = 2
    channels: int = 8
    start_mm: tuple[float, ...] = (0.0, 0.0, 0.0)
    end_mm: tuple[float, ...] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        demand(0 < self.step_mm <= 1, "step_mm", self.step_mm, "above 0 and at most 1 mm")
        demand(
            1 <= self.oscillator_hz <= 1e9,
            "oscillator_hz",
            self.oscillator_hz,
            "from 1 Hz to 1e9 Hz",
        )
        good = len(self.rates) == 7 and all(0 < n <= TICKS for n in self.rates)
        demand(good, "rates", self.rates, f"7 whole numbers of pulses from 1 to {TICKS}")
        demand(
            self.vectors in (0, 1, 2),
            "vectors",
            self.vectors,
            "1 (figure 6) or 2 (figure 11), or 0 (counts)",
        )
        allowed = (5, 8) if self.vectors else (13,)
        said = "5 or 8" if self.vectors else "13 for counts"
        demand(self.channels in allowed, "channels", self.channels, said)
        for name in ("start_mm", "end_mm"):
            place = getattr(self, name)
            demand(
                len(place) == 3 and all(abs(mm) < LONGEST_MM for mm in place),
                name,
                place,
                "three numbers of mm",
            )

    @property
    def holds_counts(self) -> bool:
        """Whether an order is the count itself, and not the difference from the one before."""
        return self.vectors == 0

    @property
    def tool_bit(self) -> int:
        """The hole that says that the tool is in the work: the last channel; none of five channels."""
        return 1 << self.channels - 1 if self.channels > 5 else 0

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
        """The largest change of the pulse rate that a tape of this format can ask for, steps/s²."""
        return (
            max(abs(b - a) for a, b in zip((0, *self.rates), self.rates, strict=False))
            * self.rate_hz**2
        )


@dataclass(frozen=True, slots=True)
class StepProgram:
    """A step program: format, rows as words (bit 1 the lowest), the line of the file of each row.

    `summed` says whether the file has a check sum.
    """

    format: StepFormat
    rows: Rows
    lines: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))
    summed: bool = True


def write_program(program: StepProgram, file: str | os.PathLike[str]) -> None:
    """Write a program; equal rows that follow each other stand in one line."""
    write_lines(file, _lines(program))


def read_program(file: str | os.PathLike[str]) -> StepProgram:
    """Read a program; raises ProgramFault with the line that is wrong, FileFault for an unreadable file."""
    lines = Lines(file, KIND, VERSION)
    fmt, count = _read_header(lines)
    return _read_rows(lines, fmt, count)


def holes(code: int, channels: int) -> str:
    """A row as it is written: bits from the highest to the lowest, o a hole."""
    return "".join("o" if code >> bit & 1 else "." for bit in range(channels - 1, -1, -1))


def _lines(program: StepProgram) -> Iterator[str]:
    """The lines of a program but the last."""
    yield f"morfax {KIND} {VERSION}"
    for entry in fields(StepFormat):
        yield f"{entry.name} {_told(getattr(program.format, entry.name))}"
    yield f"rows {len(program.rows)}"
    yield ""
    for code, alike in groupby(program.rows.tolist()):
        times = sum(1 for _ in alike)
        yield holes(code, program.format.channels) + (f"  x{times}" if times > 1 else "")


def _told(value: object) -> str:
    """A value as the header states it."""
    return " ".join(map(_told, value)) if isinstance(value, tuple) else f"{value:.12g}"


def _read_header(lines: Lines) -> tuple[StepFormat, int]:
    """The format, and the number of rows; all entries must be there, in their order."""
    names = [*(entry.name for entry in fields(StepFormat)), "rows"]
    values = {name: lines.numbers(name) for name in names}
    try:
        return _format(values), int(_single(values, "rows", 0, MOST_ROWS))
    except ValueError as error:
        raise lines.header_fault(error) from None


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
    good = len(got) == 1 and least <= got[0] <= most
    demand(good, name, " ".join(map(str, got)), f"from {least:g} to {most:g}")
    return got[0]


def _read_rows(lines: Lines, fmt: StepFormat, count: int) -> StepProgram:
    """The rows up to the last line, as many as the header states."""
    codes: list[int] = []
    times: list[int] = []
    places: list[int] = []
    total = 0
    for line in lines:
        found = _ROW.fullmatch(line)
        if found is None or len(found[1]) != fmt.channels:
            raise lines.fault(
                f"{line[:40]!r} is no row; it must be {fmt.channels} of o and ., or end"
            )
        codes.append(int(found[1].replace("o", "1").replace(".", "0"), 2))
        times.append(int(found[2] or 1))
        places.append(lines.number)
        total += times[-1]
        if total > count:
            raise lines.fault(f"more than the {count} rows stated")
    lines.check_whole(total, count, "rows")
    rows = np.repeat(np.array(codes, np.uint16), times)
    return StepProgram(fmt, rows, np.repeat(np.array(places, np.int64), times), lines.summed)
