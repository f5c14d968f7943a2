"""Closed ways: the lines of a net that come round, told by its junctions.

Signals: the junctions of a net in; closed chains of its lines out, those that go straight on first.

    ╭───╮ ╱      the partners of all junctions make closed chains. Where other lines touch a line, a wrong
    │   │╱       partner breaks its chain: so along each line that is left the closed way is looked for that
    ╰───╯        leaves partners least (see `way_round`). The silhouette goes before the figures of which it
                 is made. Last come the ways round what only bars join to the rest

A way counts if most of it is along no other before it, and it goes along no line that stands aside: dimension
lines, hatching, and what leads nowhere (see `aside`).

A way round what bars join counts, whatever it costs, if it goes round nearly all of a net: its silhouette. It
goes before others if it never leaves a line that goes on for another that goes on. A way round the two rims
of one line's ink, as of the bold arm of a cross, is none.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

from morfax.motion.arrays import NOT_ZERO
from morfax.tracer.ink.aside import lines_aside
from morfax.tracer.ink.chains import Chain, Junctions, Side
from morfax.tracer.ink.onward import Onward
from morfax.tracer.ink.outlines import (
    Outline,
    goes_round,
    goes_round_paper,
    parts,
    straight_chains,
    turned_by,
)
from morfax.tracer.ink.way_round import FoundWay, Search
from morfax.tracer.sensing.leg import FACING

NEW_BY_END = 0.9  # of a way with an end is along no other; by trial on synthetic nets

Judge = Callable[[Outline], bool]


def closed_ways(junctions: Junctions, taken: set[int], share: float) -> Iterator[Outline]:
    """The closed ways of a net of which more than a share is beside all others, and beside lines of the net
    that are taken.
    """
    taken, aside = set(taken), lines_aside(junctions)
    search = Search(junctions, Onward(junctions, aside), Onward(junctions))

    def is_new(way: Outline, least: float = share, may_be: Judge | None = None) -> bool:
        if share_beside(way.chain, taken, junctions) <= least:
            return False
        if may_be is not None and not may_be(way):
            return False
        if not goes_round_paper(way.chain, junctions):
            return False
        taken.update(link.line for link in way.chain.links)
        return True

    def goes_on_or_round(way: Outline) -> bool:
        return search.cost(way.chain) < math.inf or goes_round(way.chain, junctions, aside)

    # 1. straight on
    straight = (way for way in straight_chains(junctions) if search.cost(way.chain) == 0.0)
    yield from filter(is_new, straight)
    # 2. leaving partners, the least first; the silhouette goes before the figures of which it is made
    some = set(range(len(junctions.net.lines))) - taken - aside
    found = filter(None, map(search.way, sorted(some)))
    by_cost = sorted(found, key=lambda it: (it.cost, -it.way.length_mm))
    ways = _silhouette(by_cost, search) + by_cost
    yield from (it.way for it in ways if is_new(it.way, NEW_BY_END if it.ends else share))
    # 3. round what hangs together, and round what does without all these
    for without in (aside, taken | aside):
        rest = parts(junctions, without)
        yield from (way for way in rest if is_new(way, may_be=goes_on_or_round))


def only_cross(ways: Sequence[Outline], junctions: Junctions) -> bool:
    """Whether some closed ways share no line, and turn off at junctions only beside one other line that goes
    straight on there: their corners lie on lines that they cross.
    """
    links = [link for way in ways for link in way.chain.links]
    if len({link.line for link in links}) < len(links):
        return False
    return all(
        _goes_past(Side(link.line, not link.back), Side(onto.line, onto.back), junctions)
        for way in ways
        for link, onto in zip(
            way.chain.links, [*way.chain.links[1:], way.chain.links[0]], strict=True
        )
    )


def _goes_past(far: Side, near: Side, junctions: Junctions) -> bool:
    """Whether a way goes straight on at a junction, or at a corner there passes by a line that does."""
    there = junctions.at(far)
    others = [side for side in there.sides if side not in (far, near)]
    pairs = [(far, near)]
    if len(others) == len(pairs[0]):
        pairs.append((others[0], others[1]))
    return not others or any(
        turned_by(there.leg(one), there.leg(other).turned_round()) < FACING
        for one, other in pairs
    )


def _silhouette(by_cost: list[FoundWay], search: Search) -> list[FoundWay]:
    """The closed way round nearly all of a net that costs least, or the way round its outside, whatever that
    costs, if it keeps to its lines.
    """
    junctions, aside = search.junctions, search.onward.aside
    seen = set[frozenset[int]]()
    for found in by_cost:
        along = frozenset(link.line for link in found.way.chain.links)
        if along not in seen and goes_round(found.way.chain, junctions, aside):
            return [found]
        seen.add(along)
    for way in parts(junctions, aside):
        if search.keeps_to_lines(way.chain) and goes_round(way.chain, junctions, aside):
            return [FoundWay(math.inf, 0, way)]
    return []


def share_beside(chain: Chain, taken: set[int], junctions: Junctions) -> float:
    """The share of a chain that is along none of some lines."""
    lengths = {link.line: junctions.net.lines[link.line].length_mm for link in chain.links}
    beside_mm = sum(mm for line, mm in lengths.items() if line not in taken)
    return beside_mm / max(sum(lengths.values()), NOT_ZERO)
