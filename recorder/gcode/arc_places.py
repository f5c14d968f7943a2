"""Places along the blocks of a program: lines, and arcs by their centres.

Signals in: blocks with their places in mm. Signals out: angles turned in rad, lengths in mm, places along.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from morfax.motion.arrays import Array
from morfax.recorder.gcode.program_text import ARCS, WORDS, Block

CHORD_MM = 0.2  # between the places on an arc: finer than any line drawn with a pen is wide
STEP = 1e-3  # of a block's way, between the two places that give its direction at an end

Place = tuple[float, float, float]


def turned_rad(begin_mm: Place, block: Block) -> float:
    """The angle that an arc turns from a place, + left; 0 for a line."""
    if block.code not in ARCS:
        return 0.0
    i, j = block.centre_mm
    centre = begin_mm[0] + i, begin_mm[1] + j
    first = math.atan2(-j, -i)
    last = math.atan2(block.place_mm[1] - centre[1], block.place_mm[0] - centre[0])
    sense = 1 if block.code == "G3" else -1
    turned = sense * (last - first) % math.tau
    return sense * (turned or math.tau)


def length_mm(begin_mm: Place, block: Block) -> float:
    """The length of a block from a place, mm."""
    turned = turned_rad(begin_mm, block)
    if turned:
        return abs(turned) * math.hypot(*block.centre_mm)
    return math.dist(begin_mm, block.place_mm)


def place_at(begin_mm: Place, block: Block, share: float) -> tuple[float, float]:
    """The place at a share of a block's way."""
    turned = turned_rad(begin_mm, block) * share
    if not turned:
        dx = block.place_mm[0] - begin_mm[0]
        dy = block.place_mm[1] - begin_mm[1]
        return begin_mm[0] + share * dx, begin_mm[1] + share * dy
    return _turned_to(begin_mm, block.centre_mm, turned)


def step_at(begin_mm: Place, block: Block, at: int) -> tuple[float, float]:
    """A short step along a block at its begin (0) or end (1): its direction there."""
    from_, to = (0.0, STEP) if at == 0 else (1 - STEP, 1.0)
    x0, y0 = place_at(begin_mm, block, from_)
    x1, y1 = place_at(begin_mm, block, to)
    return x1 - x0, y1 - y0


def _turned_to(
    begin_mm: Place, centre_mm: tuple[float, float], turned: float
) -> tuple[float, float]:
    """The place of an arc that has turned so far, rad."""
    i, j = centre_mm
    cos, sin = math.cos(turned), math.sin(turned)
    x_mm = begin_mm[0] + i - cos * i + sin * j
    y_mm = begin_mm[1] + j - sin * i - cos * j
    return x_mm, y_mm


def places_along(blocks: Sequence[Block]) -> Array:
    """Places (n, 2) along some blocks, from that of the first on; arcs as chords."""
    places = [blocks[0].place_mm[:2]]
    begin = blocks[0].place_mm
    for block in blocks[1:]:
        if block.code == WORDS:
            continue
        if block.code in ARCS:
            turned, centre_mm = turned_rad(begin, block), block.centre_mm
            parts = max(8, math.ceil(abs(turned) * math.hypot(*centre_mm) / CHORD_MM))
            places += [
                _turned_to(begin, centre_mm, turned * (k / parts)) for k in range(1, parts)
            ]
        places.append(block.place_mm[:2])
        begin = block.place_mm
    return np.array(places)


def part_of(
    begin_mm: Place, block: Block, longest_mm: float, decimals: int
) -> tuple[Block, float]:
    """A block, or so much of it as a length allows, and its length, mm."""
    whole_mm = length_mm(begin_mm, block)
    if whole_mm <= longest_mm:
        return block, whole_mm
    x, y = place_at(begin_mm, block, longest_mm / whole_mm)
    place = round(x, decimals), round(y, decimals), block.place_mm[2]
    return block._replace(place_mm=place), longest_mm
