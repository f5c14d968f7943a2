"""Cut lines as chords: places in mm, for media without arcs, and how far they reach.

Signals in: cut lines, and how far a chord may be from its arc, mm. Signals out: places in mm.
"""

from __future__ import annotations

import math

from morfax.recorder.drawings.cut_lines import CutLine, Place, radius_mm

WITHIN_MM = 0.0125  # half of HP-GL's plotter unit


def chords(line: CutLine, within_mm: float = WITHIN_MM) -> list[Place]:
    """Places of a line after its first, arcs as chords that stay within a distance of them."""
    places, begin = list[Place](), line.begin_mm
    for piece in line.pieces:
        if piece.turned_rad:
            radius = radius_mm(begin, piece)
            widest_rad = 2 * math.acos(max(0.0, 1 - within_mm / radius))
            count = math.ceil(abs(piece.turned_rad) / widest_rad)
            places += [
                _along(begin, piece.end_mm, piece.turned_rad, k / count)
                for k in range(1, count)
            ]
        places.append(piece.end_mm)
        begin = piece.end_mm
    return places


def _along(begin_mm: Place, end_mm: Place, turned_rad: float, share: float) -> Place:
    """The place on an arc after a share of its angle: a chord from its beginning, turned out of the whole
    chord.
    """
    chord = complex(*end_mm) - complex(*begin_mm)
    part = math.sin(share * turned_rad / 2) / math.sin(turned_rad / 2)
    out_rad = -(1 - share) * turned_rad / 2
    place = complex(*begin_mm) + chord * part * complex(math.cos(out_rad), math.sin(out_rad))
    return place.real, place.imag


def box(lines: list[CutLine]) -> tuple[Place, Place]:
    """Lower left and upper right corner of all that is cut, mm."""
    places = [place for line in lines for place in (line.begin_mm, *chords(line))]
    x_mm, y_mm = zip(*places, strict=True)
    return (min(x_mm), min(y_mm)), (max(x_mm), max(y_mm))
