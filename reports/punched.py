"""The punched tape as a picture: strips of tape in their true size, with their holes and feed holes.

Signals in: a step program. Out: strips of 100 rows side by side, read from the top down, the row's number at
the head of each; bit 1 is at the right-hand edge, as in the file.

Sizes are those of ISO 1154 (1975): rows and channels 2.54 mm apart, holes of 1.83 mm, feed holes of 1.17 mm
between channels 3 and 4, tape 25.4 mm wide for eight channels and 17.46 mm for five.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.motion.files import written_beside
from morfax.motion.units import MM_PER_INCH

if TYPE_CHECKING:
    from morfax.recorder.steps.file import StepProgram

SUFFIXES = (".png", ".svg")

PITCH_MM = 2.54
HOLE_MM, FEED_HOLE_MM = 1.83, 1.17  # diameters
WIDTHS_MM = {5: 17.46, 8: 25.4}
ROWS_PER_STRIP = 100
MOST_ROWS = 10_000  # 25 m of tape; the rest is not drawn
BETWEEN_MM = 6.0
PX_PER_MM = 6
PAPER, HOLE, INK = "#f3e3b3", "#30302c", "#30302c"


@dataclass(frozen=True, slots=True)
class PunchedHole:
    """A hole: its centre from the picture's upper left corner, and its diameter, mm."""

    x_mm: float
    y_mm: float
    diameter_mm: float


@dataclass(frozen=True, slots=True)
class TapeStrip:
    """A strip of tape: left edge, width and length, mm, and the number of its first row."""

    x_mm: float
    width_mm: float
    length_mm: float
    first_row: int


def draw_tape(program: StepProgram, file: FilePath) -> int:
    """Draw a program's tape as what the suffix says; the number of rows that are shown."""
    if file.suffix.lower() == ".svg":
        _write_svg(program, file)
    else:
        _write_png(program, file)
    return min(len(program.rows), MOST_ROWS)


def strips(program: StepProgram) -> list[TapeStrip]:
    """The strips that the tape is cut into; one at least."""
    rows = min(len(program.rows), MOST_ROWS)
    width_mm = WIDTHS_MM[program.format.channels]
    firsts = range(0, max(1, rows), ROWS_PER_STRIP)
    return [
        TapeStrip(
            BETWEEN_MM + number * (width_mm + BETWEEN_MM),
            width_mm,
            (min(ROWS_PER_STRIP, rows - first) + 1) * PITCH_MM,
            first,
        )
        for number, first in enumerate(firsts)
    ]


def holes(program: StepProgram) -> Iterator[PunchedHole]:
    """All holes that are shown, feed holes too."""
    channels = program.format.channels
    codes = program.rows[:MOST_ROWS].tolist()
    for strip in strips(program):
        right_mm = (
            strip.x_mm + (strip.width_mm + channels * PITCH_MM) / 2
        )  # channels and the feed track: centred
        for row, code in enumerate(
            codes[strip.first_row : strip.first_row + ROWS_PER_STRIP], 1
        ):
            y_mm = BETWEEN_MM + row * PITCH_MM
            yield PunchedHole(right_mm - 3 * PITCH_MM, y_mm, FEED_HOLE_MM)
            for bit in range(channels):
                if code >> bit & 1:
                    track = bit if bit < 3 else bit + 1
                    yield PunchedHole(right_mm - track * PITCH_MM, y_mm, HOLE_MM)


def _size_mm(parts: list[TapeStrip]) -> tuple[float, float]:
    """Width and height of the picture."""
    return parts[-1].x_mm + parts[-1].width_mm + BETWEEN_MM, BETWEEN_MM + parts[
        0
    ].length_mm + BETWEEN_MM


def _write_svg(program: StepProgram, file: FilePath) -> None:
    """Draw in true size: one unit is one mm."""
    parts = strips(program)
    width, height = _size_mm(parts)
    tape = "".join(
        f'  <rect x="{s.x_mm:.2f}" y="{BETWEEN_MM}" width="{s.width_mm}" height="{s.length_mm:.2f}"'
        f' fill="{PAPER}"/>\n'
        f'  <text x="{s.x_mm:.2f}" y="{BETWEEN_MM - 1.5}" font-size="3" fill="{INK}">'
        f"{s.first_row + 1}</text>\n"
        for s in parts
    )
    punched = "".join(
        f'   <circle cx="{h.x_mm:.2f}" cy="{h.y_mm:.2f}" r="{h.diameter_mm / 2:.3f}"/>\n'
        for h in holes(program)
    )
    with written_beside(file) as beside:
        beside.write_text(
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.2f}mm" height="{height:.2f}mm"'
            f' viewBox="0 0 {width:.2f} {height:.2f}">\n{tape}  <g fill="{HOLE}">\n{punched}  </g>\n</svg>\n',
            encoding="utf-8",
        )


def _write_png(program: StepProgram, file: FilePath) -> None:
    """Draw as an image that states its resolution."""
    from PIL import Image, ImageDraw

    parts = strips(program)
    width, height = (round(mm * PX_PER_MM) for mm in _size_mm(parts))
    image = Image.new("RGB", (width, height), "white")
    pen = ImageDraw.Draw(image)
    for s in parts:
        corners = (s.x_mm, BETWEEN_MM, s.x_mm + s.width_mm, BETWEEN_MM + s.length_mm)
        pen.rectangle([mm * PX_PER_MM for mm in corners], fill=PAPER)
        pen.text((s.x_mm * PX_PER_MM, 1.5 * PX_PER_MM), str(s.first_row + 1), fill=INK)
    for h in holes(program):
        r = h.diameter_mm / 2
        around = h.x_mm - r, h.y_mm - r, h.x_mm + r, h.y_mm + r
        pen.ellipse([mm * PX_PER_MM for mm in around], fill=HOLE)
    dpi = PX_PER_MM * MM_PER_INCH
    with written_beside(file) as beside:
        image.save(beside, dpi=(dpi, dpi))
