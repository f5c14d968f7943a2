"""The net: the lines of a sheet as they were felt, and the junctions at which they hang together.

Signals: a drawing in; out lines, each with its clean runs, and for both its ends the junction there.

    ────╮         ╭────      a stretch on which nothing can be felt clean lies within a junction: where two
        ├─────────┤          lines share their ink for a while the graph has two forks; they are one
    ────╯         ╰────      junction, from which four lines leave

Ends of lines that face each other across a gap are a junction of two lines.

Source: our own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from morfax.motion.neighbours import pairs_within
from morfax.tracer.following.faint_corner import TipPose, faint_corner
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.both_lines import strands
from morfax.tracer.ink.doubled import LEAST_WIDTHS, SWELLS, spread
from morfax.tracer.ink.felt import Parted, whole
from morfax.tracer.ink.felt_lines import FeltLine, end_leg
from morfax.tracer.ink.graph import RING
from morfax.tracer.ink.run import LEAST_PLACES, Run
from morfax.tracer.ink.stretches import FeltSheet, with_width
from morfax.tracer.sensing.leg import FACING, Leg, turn
from morfax.tracer.sensing.view import View

# All limits below were chosen by trial on drawings of nets.
INNER_WIDTHS = 40.0  # a stretch between forks that is no longer may lie within a junction
CLEAN_SHARE = 0.5  # of its length: more of it is clean line of its own
# of a stretch: two lines run together along more of it (0.24 and more, of a letter's 0.15 and less); by trial
STILL_SHARE = 0.2
# of a line's width: two lines in narrower ink run within a quarter of it from each other, and are one
APART = 1.25
MET_WIDTHS = 0.5  # at the ends of a line that is clean nowhere: the ink of what it meets
OWN_WIDTHS = 1.2  # a shorter one has no ink that is not the junction's
COVERED = 0.6  # widths: ink nearer to a way is that way's
# the middle of a line that hangs together with nothing: a shorter one is a speck or a dot; the larger
LEAST_MM, SPECK_WIDTHS = 0.7, 1.0
ASIDE = 0.6  # widths: and miss each other by no more


class Inner(NamedTuple):
    """A stretch within a junction: its number, the junction's, and what was felt along it."""

    stretch: int
    junction: int
    run: Run


@dataclass(slots=True)
class Net:
    """Lines, which junctions are ends of the ink (there the pen was lifted), and stretches within one."""

    lines: list[FeltLine]
    free_ends: set[int] = field(default_factory=set)
    inner: list[Inner] = field(default_factory=list)
    left_mm: float = 0.0  # length of stretches that are too short to be lines


def net_of(sheet: FeltSheet, own: set[int]) -> Net:
    """The net of felt stretches; some are lines of their own in any case."""
    graph, widths = sheet.graph, sheet.widths_mm
    at, net, kept = graph.at_nodes(), Net([]), list[tuple[int, Parted]]()
    same, inner, beside = _Same(), list[int](), list[int]()
    for n, stretch in enumerate(graph.stretches):
        taken, length_mm = sheet.taken(n), sheet.measured[n].length_mm
        ends = [len(at.get(node, ())) for node in stretch.nodes]
        is_ring = stretch.nodes[0] == RING
        short = length_mm < max(LEAST_MM, SPECK_WIDTHS * widths[n])
        if n in sheet.beside:
            beside.append(n)
            continue
        # 1. specks, and stretches within a junction: they make one of the nodes at their ends
        if not is_ring and ends == [1, 1] and short:
            net.left_mm += length_mm
        elif n not in own and not is_ring and _is_inner(sheet, n, min(ends)):
            same.join(*stretch.nodes)
            inner.append(n)
        elif n in own and (two := _two_lines(sheet, n)):
            kept += [(n, ([strand], [])) for strand in two]
        elif _is_unclear(sheet, n, n in own):
            kept.append((n, ([_all_felt(sheet, n, ends)], [])))
        else:
            kept.append((n, taken.parted))
    # 2. the others are lines
    net.lines += [_line_of(sheet, n, parted, same) for n, parted in kept]
    for n in beside:
        _add_beside(net, sheet, n, same)
    free = {node for node, numbers in at.items() if len(numbers) == 1}
    net.free_ends = {node for node in free if not same.has_joined(node)}
    net.inner += [
        Inner(n, same.of(graph.stretches[n].nodes[0]), sheet.felt[n])
        for n in inner
        if sheet.measured[n].length_mm > OWN_WIDTHS * widths[n]
    ]
    _bridge_gaps(net, sheet.settings)
    return net


def _line_of(sheet: FeltSheet, n: int, parted: Parted, same: _Same) -> FeltLine:
    """A stretch, or a strand of one, as a line between the junctions that its ends have become."""
    ends, felt_mm = _junctions(sheet, n, same), sheet.felt[n].widths_mm
    return FeltLine(*parted, ends, sheet.widths_mm[n], sheet.measured[n].length_mm, n, felt_mm)


def _junctions(sheet: FeltSheet, n: int, same: _Same) -> tuple[int, int]:
    """The junctions that the ends of a stretch have become."""
    nodes = sheet.graph.stretches[n].nodes
    return (-1 - n, -1 - n) if nodes[0] == RING else (same.of(nodes[0]), same.of(nodes[1]))


def _add_beside(net: Net, sheet: FeltSheet, n: int, same: _Same) -> None:
    """Add the lines of a stretch in part of which two run beside each other; where one ends no other does."""
    at, felt_mm = _junctions(sheet, n, same), sheet.felt[n].widths_mm
    for line in sheet.beside[n]:
        # no node has such a number, and no ring
        alone = -1 - len(sheet.felt) - 2 * len(net.lines)
        first = at[0] if line.ends_mm[0] is None else alone
        last = at[1] if line.ends_mm[1] is None else alone - 1
        width_mm, long_mm = line.runs[0].view.width_mm, sum(run.length_mm for run in line.runs)
        felt = FeltLine(line.runs, line.parted, (first, last), width_mm, long_mm, n, felt_mm)
        net.lines.append(replace(felt, ends_mm=line.ends_mm))


def _is_inner(sheet: FeltSheet, number: int, fewest: int) -> bool:
    """Whether a stretch lies within a junction; `fewest` stretches meet at one of its ends."""
    length_mm, width_mm = sheet.measured[number].length_mm, sheet.widths_mm[number]
    if length_mm > INNER_WIDTHS * width_mm:
        return False
    clean_mm = sheet.taken(number).clean_mm
    # a short stretch of two lines tells too little of either
    is_two = number in sheet.together and length_mm < LEAST_WIDTHS * width_mm
    if not is_two and clean_mm > CLEAN_SHARE * length_mm:
        return False
    # one that ends in no other is the tip of two lines that run together, or a stub
    shared = sheet.is_shared(number)
    return shared if fewest == 1 else shared or length_mm < 3 * width_mm


def _two_lines(sheet: FeltSheet, number: int) -> list[Run]:
    """The two lines that share a stretch of its own; none if it is one line's.

    Of ink that is not known to be that of two lines less lies still where a single line swells, and two lines
    would run nearly on each other where it is hardly broader than one.
    """
    measured, width_mm = sheet.measured[number], sheet.widths_mm[number]
    is_known = number in sheet.together or number in sheet.doubled.stations
    if not sheet.is_shared(number) or not (is_known or measured.width_mm > APART * width_mm):
        return []
    two = strands(sheet.taken(number).stations, width_mm, sheet.ends[number])
    least_mm = 0.0 if is_known else STILL_SHARE * measured.length_mm
    return two if two and two[0].length_mm > least_mm else []


def shows_two_lines(sheet: FeltSheet, number: int) -> bool:
    """Whether the rims along a stretch are for a while those of two lines of a clean sheet's pen, and swell:
    even ink is a line of a broader pen.
    """
    pen_mm = sheet.doubled.pen_mm
    if spread(sheet.felt[number].widths_mm) < SWELLS:
        return False
    two = strands(with_width(sheet.felt[number], pen_mm), pen_mm, sheet.ends[number])
    return bool(two) and two[0].length_mm > STILL_SHARE * sheet.measured[number].length_mm


def _is_unclear(sheet: FeltSheet, number: int, is_own: bool) -> bool:
    """Whether most of a line is not as wide as it is taken to be, and yet is no ink that others share.

    No way goes along a stretch of its own, and narrower ink is one line's: a letter's strokes swell.
    """
    measured = sheet.measured[number]
    is_one = is_own or measured.width_mm < sheet.widths_mm[number]
    is_felt = measured.known > CLEAN_SHARE
    return (
        is_one and is_felt and sheet.taken(number).clean_mm < CLEAN_SHARE * measured.length_mm
    )


def _all_felt(sheet: FeltSheet, number: int, meeting: list[int]) -> Run:
    """What was felt along a stretch, clean or not, but for the ink of what it meets at its ends."""
    felt = sheet.felt[number]
    off = round(MET_WIDTHS * sheet.measured[number].width_mm / felt.view.step_mm)
    first, last = (off if count > 1 else 0 for count in meeting)
    if len(felt) - first - last < LEAST_PLACES:
        first = last = 0
    return whole(sheet.taken(number).stations.part(first, len(felt) - last))


class _Same:
    """Which nodes are one junction."""

    def __init__(self) -> None:
        self._first: dict[int, int] = {}

    def of(self, node: int) -> int:
        """The node by which a junction is known."""
        while self._first.get(node, node) != node:
            node = self._first[node]
        return node

    def join(self, one: int, other: int) -> None:
        """Make one junction of those of two nodes."""
        a, b = self.of(one), self.of(other)
        self._first[max(a, b)] = min(a, b)
        self._first.setdefault(min(a, b), min(a, b))

    def has_joined(self, node: int) -> bool:
        """Whether a node is one with another."""
        return node in self._first


def _bridge_gaps(net: Net, settings: Settings) -> None:
    """Make one junction of two free ends that face each other across a gap, or about a faint corner."""
    ends = [
        (n, last) for n, line in enumerate(net.lines) for last in (False, True)
        if line.junctions[last] in net.free_ends
    ]  # fmt: skip
    if len(ends) < 2:
        return
    legs = [end_leg(net.lines[n], last) for n, last in ends]
    pitch_mm = legs[0].width_mm if not net.lines else net.lines[0].runs[0].view.pitch_mm
    reach_mm = max(settings.gap_mm, 2.5 * pitch_mm) + 4 * max(leg.width_mm for leg in legs)
    near = pairs_within([leg.end_mm for leg in legs], reach_mm).tolist()
    views = [_view_at(net, end) for end in ends]
    tips = [TipPose.of(view, leg) for view, leg in zip(views, legs, strict=True)]
    found = sorted(
        (math.dist(tips[a].place_mm, tips[b].place_mm), a, b)
        for a, b in near
        if _faces(legs[a], legs[b]) or faint_corner(views[a], tips[a], tips[b]) is not None
    )
    taken = set[int]()
    for apart_mm, a, b in found:
        width_mm = 0.5 * (legs[a].width_mm + legs[b].width_mm)
        blank_mm = apart_mm - width_mm
        if blank_mm > settings.gap_mm or taken & {a, b}:
            continue
        taken |= {a, b}
        (one, last), (other, other_last) = ends[a], ends[b]
        old = net.lines[other].junctions[other_last]
        new = net.lines[one].junctions[last]
        net.free_ends -= {old, new}
        joined = list(net.lines[other].junctions)
        joined[other_last] = new
        net.lines[other].junctions = (joined[0], joined[1])


def _view_at(net: Net, end: tuple[int, bool]) -> View:
    """How the head sees a line at an end of it."""
    return net.lines[end[0]].runs[-1 if end[1] else 0].view


def _faces(one: Leg, other: Leg) -> bool:
    """Whether two legs run towards each other on about one line."""
    way = other.end_mm - one.end_mm
    along = math.atan2(way[1], way[0])
    aside = abs(way[1] * math.cos(one.heading_rad) - way[0] * math.sin(one.heading_rad))
    turned = (turn(one.heading_rad, along), turn(along, other.heading_rad + math.pi))
    return max(map(abs, turned)) < FACING and aside < ASIDE * one.width_mm
