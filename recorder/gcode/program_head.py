"""The head of a program: what a person at the machine wants to know before pressing start.

Signals in: the plan, the blocks as the machine runs them, and what the program is made from. Signals out: the
comments at its head, and the figures in them: size in mm, length in mm, time in s, the smallest inner radius.

An inner bend is one that turns towards the inside of what stays: the tool's round shape must fit into it. Of
a closed line that is the outside of a part, it turns the other way than the line as a whole; of a hole, the
same way. Two blocks that meet at more than `CORNER_RAD` make a sharp inner corner, which no round tool cuts.

Source: our own. Questions: the radii are those of the written path; with a cutter beside the line they are
smaller by the cutter's radius than those of the part.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice, pairwise

import numpy as np

from morfax.motion.motion import IN_WORK_BELOW_MM
from morfax.motion.nesting import nested
from morfax.motion.plane import CORNER_RAD
from morfax.motion.polyline import area_mm2
from morfax.recorder.gcode.arc_places import (
    Place,
    length_mm,
    places_along,
    step_at,
    turned_rad,
)
from morfax.recorder.gcode.closing import loop
from morfax.recorder.gcode.machine import Machine
from morfax.recorder.gcode.made import Made
from morfax.recorder.gcode.plan import BlockPlan
from morfax.recorder.gcode.program_text import CUTS, RAPID, WORDS, Block, digits

HEAD_LINES = 10  # among which a program says for which machine it is, and where the zero is
SAME_MM = 0.02  # of two sizes that are told in hundredths
ZERO_LINE = re.compile(r"^[(;] ?zero at (-?[\d.]+),(-?[\d.]+) mm of the sheet")

Place2 = tuple[float, float]


def head(
    planned: BlockPlan, blocks: Sequence[Block], seconds: float, machine: Machine, made: Made
) -> list[str]:
    """The comments at the head of a program."""
    lines = cut_lines(planned, blocks, machine)
    told = [f"for {machine.name}: {machine.what}"]
    told += [f"from {made.source}"] if made.source else []
    told += [f"tool: {made.tool}"] if made.tool else []
    told += [zero_line(*made.zero_mm)] if made.zero_mm else []
    if not lines:
        return [*told, f"about {seconds:.0f} s, nothing is cut"]
    told += _sizes(planned, lines, machine, made)
    way_mm = sum(
        length_mm(before.place_mm, block) for line in lines for before, block in pairwise(line)
    )
    panel = f" at {machine.panel_feed_mm_s * 60:.0f} mm/min from the panel, without piercing"
    told.append(
        f"length {way_mm:.1f} mm, about {_time(seconds)}{'' if machine.feeds else panel}"
    )
    inner_mm = smallest_inner_radius_mm(lines)
    if inner_mm is not None:
        told.append(
            f"smallest inner radius {inner_mm:.2f} mm" if inner_mm else "sharp inner corners"
        )
    return [*told, f"within {planned.deviation_mm:.4f} mm of the traced path"]


def _sizes(
    planned: BlockPlan, lines: list[list[Block]], machine: Machine, made: Made
) -> list[str]:
    """The comments that say how large the part is, and how much is cut."""
    told = list[str]()
    places = np.vstack([places_along(line) for line in lines])
    x_mm, y_mm = np.ptp(places, axis=0)
    deepest_mm = min(block.place_mm[2] for line in lines for block in line)
    if made.part_mm is not None and not _same(made.part_mm, (x_mm, y_mm)):
        told.append(f"part {made.part_mm[0]:.2f} x {made.part_mm[1]:.2f} mm")
    down = f", Z down to {deepest_mm:.2f} mm" if machine.z else ""
    many = _many(len(lines), "line")
    if holes := drilled_mm(planned):
        many += f", {_many(len(holes), 'drilled hole')}"
    return [*told, f"cut {x_mm:.2f} x {y_mm:.2f} mm, {many}{down}"]


def zero_line(x_mm: float, y_mm: float) -> str:
    """The line of the head that says where on the sheet the program's zero is."""
    return f"zero at {digits(x_mm, 4)},{digits(y_mm, 4)} mm of the sheet"


def zero_on_sheet_mm(lines: Iterable[str]) -> Place2 | None:
    """Where the head of a program says that its zero is on the sheet, mm; None if it does not."""
    found = (ZERO_LINE.match(line) for line in islice(lines, HEAD_LINES))
    said = next(filter(None, found), None)
    return None if said is None else (float(said[1]), float(said[2]))


def _same(size_mm: tuple[float, float], other_mm: tuple[float, float]) -> bool:
    """Whether two sizes are one as they are told."""
    return all(abs(a - b) < SAME_MM for a, b in zip(size_mm, other_mm, strict=True))


def _many(number: int, what: str) -> str:
    """So many of something."""
    return f"{number} {what}" if number == 1 else f"{number} {what}s"


def _time(seconds: float) -> str:
    """A time as one says it."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{int(seconds + 0.5) // 60} min {int(seconds + 0.5) % 60:02d} s"


def _cuts(before: Block, block: Block) -> bool:
    """Whether a block goes across with the tool in the work."""
    lowest_mm = min(before.place_mm[2], block.place_mm[2])
    across = before.place_mm[:2] != block.place_mm[:2]
    return block.code in CUTS and across and lowest_mm <= IN_WORK_BELOW_MM


def cut_lines(
    planned: BlockPlan, blocks: Sequence[Block], machine: Machine
) -> list[list[Block]]:
    """What is cut each time the tool is down: a place, and the blocks from there on."""
    x, y, z = (float(mm) for mm in planned.start_mm)
    before = Block("", (x, y, z if machine.z else 0.0))
    lines, is_open = list[list[Block]](), False
    for block, is_over in _with_overcuts(blocks, machine):
        cuts = _cuts(before, block)
        if cuts and not is_over:
            if not is_open:
                lines.append([before])
            lines[-1].append(block)
        is_open = (is_open or cuts) and block.code != RAPID
        before = block if block.code else before
    return lines


def _with_overcuts(blocks: Sequence[Block], machine: Machine) -> Iterator[tuple[Block, bool]]:
    """The blocks but for words, and whether each runs on after a hole has closed: no part of its line."""
    is_over = False
    for block in blocks:
        if block.code == WORDS:
            goes_on = is_over and block.words != machine.tool_up
            is_over = goes_on or block.words == machine.hole_overcut
        else:
            yield block, is_over


def drilled_mm(planned: BlockPlan) -> set[tuple[float, float]]:
    """The places where the tool goes into the work and comes out again without moving across."""
    x, y, _ = (float(mm) for mm in planned.start_mm)
    begun: tuple[float, float] | None = None
    found = set[tuple[float, float]]()
    place = (x, y)
    for block in planned.blocks:
        across = block.place_mm[:2] != place
        if block.code in CUTS and not across and block.place_mm[2] <= IN_WORK_BELOW_MM:
            begun = begun or place
        if across:
            if begun is not None and block.code == RAPID:
                found.add(begun)
            begun = None
        place = block.place_mm[:2]
    return found | ({begun} if begun is not None else set())


def smallest_inner_radius_mm(lines: Sequence[list[Block]]) -> float | None:
    """The smallest radius of the inner bends of closed lines, 0 for a sharp corner; None without any."""
    rounds = [loop(line) for line in lines]
    rings = [
        line[at[0] : at[1] + 1] if at else line for line, at in zip(lines, rounds, strict=True)
    ]
    places = [places_along(ring) for ring in rings]
    closed = [at is not None for at in rounds]
    depth = nested(places, closed).sum(axis=1)
    found = list[float]()
    for number, line in enumerate(rings):
        if closed[number]:
            sense = 1 if area_mm2(places[number]) > 0 else -1
            inner = -sense if depth[number] % 2 == 0 else sense
            found += _bends_mm(line, inner)
    return min(found, default=None)


def _bends_mm(line: list[Block], sense: int) -> list[float]:
    """Radii of the arcs of a closed line that turn to one side, and 0 for each corner to that side."""
    blocks = list(pairwise(line))
    found = list[float]()
    for (before, block), (_, after) in zip(blocks, [*blocks[1:], blocks[0]], strict=True):
        if sense * turned_rad(before.place_mm, block) > 0:
            found.append(math.hypot(*block.centre_mm))
        arrives = _heading_rad(before.place_mm, block, 1)
        leaves = _heading_rad(block.place_mm, after, 0)
        turn = math.remainder(leaves - arrives, math.tau)
        if sense * turn > CORNER_RAD:
            found.append(0.0)
    return found


def _heading_rad(begin: Place, block: Block, at: int) -> float:
    """The heading of a block at its begin (0) or end (1)."""
    x_mm, y_mm = step_at(begin, block, at)
    return math.atan2(y_mm, x_mm)
