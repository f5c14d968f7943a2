"""The drawing recorders: what a motion cuts, as a file of DXF or SVG.

    .dxf            one LWPOLYLINE for each line (arcs as bulges), one POINT for each hole; units mm
    .svg            one path for each line (arcs as A), in true size: width and height in mm, one unit is 1 mm

Signals: a stream of Motion or a Path in, the file and a report out. X and Y are those of the path; an SVG has
Y down and begins at the upper left corner of what is cut.

Source: Autodesk's DXF reference (LWPOLYLINE, bulge = tan of a quarter of the angle); SVG 1.1, paths.
Questions: an SVG says nothing of where its corner lies on the sheet; a margin keeps its lines whole.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

from morfax.motion.files import written_beside
from morfax.motion.segments import Source
from morfax.recorder.drawings.chords import box
from morfax.recorder.drawings.cut_lines import CutLine, CutPiece, Place, cut_lines_of, radius_mm
from morfax.recorder.drawings.drawn_units import ZERO
from morfax.recorder.gcode.machine import TOLERANCE_MM
from morfax.recorder.gcode.plan import Writing
from morfax.recorder.gcode.program_text import digits
from morfax.recorder.report import Written

MARGIN_MM = 1.0  # round an SVG, so that its lines are not cut off by half
LINE_MM = 0.1  # width of an SVG's lines
# of an SVG: at half a turn a digit of 0.1 um in its radius moves the centre by 1 um
WIDEST_ARC_RAD = 2.5


@dataclass(frozen=True, slots=True)
class DrawingReport(Written):
    """What was written: lines, how many are closed, time of the motion, largest distance from it."""

    lines: int
    closed: int
    duration_s: float
    deviation_mm: float

    @property
    def figures(self) -> dict[str, Any]:
        """Further figures for the report."""
        return {"lines": self.lines, "closed": self.closed, "deviation_mm": self.deviation_mm}


def record_dxf(
    stream: Source,
    file: str | os.PathLike[str],
    *,
    tolerance_mm: float = TOLERANCE_MM,
    arcs: bool = True,
) -> DrawingReport:
    """Draw what a motion cuts as DXF, with or without arcs; raises MotionFault, FileFault."""
    return _record(stream, file, Writing(tolerance_mm, arcs=arcs), _dxf)


def record_svg(
    stream: Source,
    file: str | os.PathLike[str],
    *,
    tolerance_mm: float = TOLERANCE_MM,
    arcs: bool = True,
) -> DrawingReport:
    """Draw what a motion cuts as SVG, with or without arcs; raises MotionFault, FileFault."""
    return _record(stream, file, Writing(tolerance_mm, arcs=arcs), _svg)


def _record(
    stream: Source,
    file: str | os.PathLike[str],
    writing: Writing,
    text_of: Callable[[list[CutLine]], str],
) -> DrawingReport:
    """Write what is cut."""
    lines, planned = cut_lines_of(stream, writing)
    text = text_of(lines)
    with written_beside(file) as beside:
        beside.write_text(text, encoding="ascii")
    closed = sum(line.closed for line in lines)
    return DrawingReport(
        FilePath(file), len(lines), closed, planned.duration_s, planned.deviation_mm
    )


def _dxf(lines: list[CutLine]) -> str:
    """The text of a DXF."""
    import io

    import ezdxf
    from ezdxf import units

    # no time, no random name in the file: the same motion gives the same bytes
    ezdxf.options.write_fixed_meta_data_for_testing = True
    document = ezdxf.new("R2010", units=units.MM)
    space = document.modelspace()
    for line in lines:
        if not line.pieces:
            space.add_point(line.begin_mm)
            continue
        bulges = [math.tan(piece.turned_rad / 4) for piece in line.pieces]
        places = [line.begin_mm, *(piece.end_mm for piece in line.pieces)]
        if line.closed:
            places.pop()
        else:
            bulges.append(0.0)
        corners = [(x, y, bulge) for (x, y), bulge in zip(places, bulges, strict=True)]
        space.add_lwpolyline(corners, format="xyb", close=line.closed)
    for kind in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(kind)  # ezdxf would list them in the order of a set
    text = io.StringIO()
    document.write(text)
    return text.getvalue()


def _svg(lines: list[CutLine]) -> str:
    """The text of an SVG."""
    (left, low), (right, high) = box(lines)
    left, low, right, high = (
        left - MARGIN_MM,
        low - MARGIN_MM,
        right + MARGIN_MM,
        high + MARGIN_MM,
    )

    def place(x_mm: float, y_mm: float) -> str:
        return f"{digits(x_mm - left, 4)} {digits(high - y_mm, 4)}"

    paths = [f'  <path d="{_path(line, place)}"/>' for line in lines]
    width = digits(right - left, 4)
    height = digits(high - low, 4)
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" '
            f'viewBox="0 0 {width} {height}" {ZERO}="{digits(left, 4)} {digits(low, 4)}">',
            f'<g fill="none" stroke="black" stroke-width="{LINE_MM:g}" stroke-linecap="round">',
            *paths,
            "</g>",
            "</svg>",
            "",
        ]
    )


def _path(line: CutLine, place: Callable[[float, float], str]) -> str:
    """The words of a line's path; `place` writes a place on the SVG's sheet."""
    words = ["M " + place(*line.begin_mm)]
    begin = line.begin_mm
    for piece in _narrow(line):
        if piece.turned_rad:
            radius = digits(radius_mm(begin, piece), 4)
            large = int(abs(piece.turned_rad) > math.pi)
            turns_left = int(piece.turned_rad < 0)  # Y down: the other way round
            words.append(f"A {radius} {radius} 0 {large} {turns_left} {place(*piece.end_mm)}")
        else:
            words.append("L " + place(*piece.end_mm))
        begin = piece.end_mm
    words.append("Z" if line.closed else "" if line.pieces else "h 0")
    return " ".join(words).rstrip()


def _narrow(line: CutLine) -> list[CutPiece]:
    """The pieces of a line, wide arcs in two."""
    begins = [line.begin_mm, *(piece.end_mm for piece in line.pieces)]
    return [part for k, piece in enumerate(line.pieces) for part in _halves(begins[k], piece)]


def _halves(begin_mm: Place, piece: CutPiece) -> list[CutPiece]:
    """An arc in two where it turns so far that its ends and its radius say little about its centre."""
    if abs(piece.turned_rad) < WIDEST_ARC_RAD:
        return [piece]
    chord = complex(*piece.end_mm) - complex(*begin_mm)
    half = chord / 2 * complex(1, -math.tan(piece.turned_rad / 4))
    middle = complex(*begin_mm) + half
    turned_rad = piece.turned_rad / 2
    return [
        CutPiece((middle.real, middle.imag), turned_rad),
        CutPiece(piece.end_mm, turned_rad),
    ]
