"""Tooling: the blocks of a plan as a machine without a Z axis runs them.

Signals in: where the program starts, its blocks (places in mm), and the Machine. Signals out: blocks without
moves of Z, and the machine's own words for the tool between them:

    Z    \\______________/      \\/\\/              plan: a line, and a hole in two pecks
      down  line        up   hole_down hole_up   out: tool_down, the line, tool_up; the hole is one dot

A line that is run several times without the tool coming up stays several passes. Holes of the part, closed
lines inside another one no wider than the machine's `hole_mm`, get words of their own: a torch cuts them
slower, and runs on along the line for `overcut_mm` after it is off, which leaves no notch where the hole
closes.

Source: QtPlasmaC's user manual (velocity reduction M67 E3, torch off M62 P3, arcs up to 32 mm, 4 mm of
overcut at 60 %). Questions: QtPlasmaC's own filter (`#<holes>=4`) finds a hole only where it is one whole
arc, and a drawn one is several; so the words stand in the program. Only a hole that ends on its own line is
overcut.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.motion import IN_WORK_BELOW_MM
from morfax.motion.nesting import nested
from morfax.recorder.gcode.arc_places import part_of, places_along
from morfax.recorder.gcode.closing import loop
from morfax.recorder.gcode.machine import Machine
from morfax.recorder.gcode.program_text import CUTS, RAPID, WORDS, Block

Place = tuple[float, float, float]


def without_z(start_mm: Array, blocks: Sequence[Block], machine: Machine) -> list[Block]:
    """The blocks of a machine whose tool is only up or down, its words included."""
    parts = _parts(start_mm, blocks)
    holes = _holes([part for is_down, part in parts if is_down], machine)
    out = list[Block]()
    number = -1
    for is_down, part in parts:
        if not is_down:
            out += part
            continue
        number += 1
        out += _worked(part, machine, is_hole=number in holes)
    return out


def _parts(start_mm: Array, blocks: Sequence[Block]) -> list[tuple[bool, list[Block]]]:
    """The blocks without Z: by turns those with the tool up and down; the first is the place of the start.

    Where Z goes up and nothing follows but Z down again, as between two pecks, the tool stays down.
    """
    x, y, z_mm = (float(mm) for mm in start_mm)
    place: Place = (x, y, 0.0)
    is_down = z_mm <= IN_WORK_BELOW_MM
    parts = [(is_down, [Block("", place)])]
    for block in blocks:
        in_work = block.place_mm[2] <= IN_WORK_BELOW_MM
        flat = block._replace(place_mm=(block.place_mm[0], block.place_mm[1], 0.0))
        across = flat.place_mm != place
        if across:
            in_work = in_work or z_mm <= IN_WORK_BELOW_MM
            flat = flat._replace(code=_code_across(flat, in_work))
        is_told = across or block.code == "G4"
        if in_work != is_down and (in_work or is_told):
            is_down = in_work
            parts.append((is_down, [Block("", place)]))
        if is_told:
            parts[-1][1].append(flat)
        place, z_mm = flat.place_mm, block.place_mm[2]
    return parts


def _code_across(block: Block, in_work: bool) -> str:
    """The G word of a way across: a rapid outside of the work; a cut in it, straight if it was a rapid."""
    if not in_work:
        return RAPID
    return block.code if block.code in CUTS else "G1"


def _worked(part: list[Block], machine: Machine, *, is_hole: bool) -> list[Block]:
    """What is cut with the tool down once, between the words that put it down and up."""
    begin, end = part[0], part[-1]
    stands = all(block.place_mm == begin.place_mm for block in part)
    down = machine.dot_down if stands and machine.dot_down else machine.tool_down
    up = machine.dot_up if stands and machine.dot_up else machine.tool_up
    out = [begin, Block(WORDS, begin.place_mm, words=down)]
    if is_hole:
        out.append(Block(WORDS, begin.place_mm, words=machine.hole_begin))
    out += part[1:]
    if is_hole:
        out += _overcut(part, machine)
        end = out[-1]
    out.append(Block(WORDS, end.place_mm, words=up))
    if is_hole:
        out.append(Block(WORDS, end.place_mm, words=machine.hole_end))
    return [block for block in out if block.code != WORDS or block.words]


def _holes(parts: list[list[Block]], machine: Machine) -> set[int]:
    """Numbers of the parts that are holes: closed, inside a closed one, no wider than `hole_mm`."""
    widest_mm = machine.values.get("hole_mm", 0.0)
    if not machine.hole_begin or widest_mm <= 0:
        return set()
    lines = [places_along(part) for part in parts]
    closed = [loop(part) is not None for part in parts]
    inside = [bool(row.any()) for row in nested(lines, closed)]
    return {
        number
        for number, line in enumerate(lines)
        if closed[number] and inside[number] and float(np.ptp(line, axis=0).max()) <= widest_mm
    }


def _overcut(part: list[Block], machine: Machine) -> list[Block]:
    """The words that put the torch off, and the way on along the line from where it closes."""
    left_mm = machine.values.get("overcut_mm", 0.0)
    closes = loop(part)
    if closes is None or closes[1] < len(part) - 1 or left_mm <= 0 or not machine.hole_overcut:
        return []
    at, end = closes[0], part[-1].place_mm
    out = [Block(WORDS, end, words=machine.hole_overcut)]
    place = part[at].place_mm
    if place != end:
        out.append(Block("G1", place, feed_mm_s=part[-1].feed_mm_s))
    for block in part[at + 1 :]:
        if left_mm <= 0 or block.code not in CUTS:
            break
        piece, length_mm = part_of(place, block, left_mm, machine.decimals)
        out.append(piece)
        left_mm -= length_mm
        place = block.place_mm
    return out
