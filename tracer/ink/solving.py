"""Solving: the junctions of a sheet, solved anew until all ink between them is a line's, or two lines'.

Signals: a sheet as it was felt in; its junctions out; on the way how far it has come, a share.

How many rounds it takes is not known. In each less is left to solve, so each counts for half of what is left:

    0 ├──────── 1st ────────┤───── 2nd ─────┤── 3rd ──┤ … 1      of each, first how lines go on, then what is
                                                                 left between them

Source: our own.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence
from typing import TypeVar

from morfax.tracer.effort import ROUNDS
from morfax.tracer.ink.chains import Junctions, Side
from morfax.tracer.ink.crossing import Crossing
from morfax.tracer.ink.doubled import BROADER, LEAST_WIDTHS
from morfax.tracer.ink.net import Net, net_of, shows_two_lines
from morfax.tracer.ink.stretches import FeltSheet

# of a line's width: two that go on from both its ends, so narrow and so straight on, run together in it; by
# trial on drawings of nets
NARROWER = 0.8

Told = Callable[[float], None]
Item = TypeVar("Item")


def solved(sheet: FeltSheet, told: Told | None = None) -> Junctions:
    """The junctions of a sheet. A stretch within one along which no way goes is a line of its own, or two.

    A stretch that turns out to be two lines that run together lies within a junction, or is too long for
    that; then what meets it there is asked anew, for these two may be what goes along another stretch. `told`
    hears how much is done, a share.
    """
    cut = sheet.doubled.cut
    parted, two, bare = set(cut), set(cut), set[int]()
    sheet.widths_mm[:] = [
        sheet.doubled.pen_mm if n in cut else width_mm
        for n, width_mm in enumerate(sheet.widths_mm)
    ]
    doubled = sheet.doubled.throughout(sheet.felt)
    known = dict[Hashable, Crossing]()
    for number in range(ROUNDS):
        done, quarter = 1 - 0.5**number, 0.25 * 0.5**number
        junctions = Junctions(net_of(sheet, two | bare), sheet.settings, known)
        lines = [line.stretch for line in junctions.net.lines]
        together = dict.fromkeys((doubled & set(lines)) - parted - bare, sheet.doubled.pen_mm)
        together |= {
            stretch: width_mm
            for n, stretch in enumerate(_heard(lines, told, done, quarter))
            if stretch not in parted | bare
            and not sheet.doubled.is_second(sheet.felt[stretch])
            and (width_mm := junctions.single_mm(n, _narrower_mm(sheet, stretch))) is not None
        }
        too_long = parted.intersection(lines) - two - bare
        if together or too_long:
            bare -= _beside(junctions.net, too_long.union(together))
        else:
            too_long = _unexplained(junctions, sheet, two | bare)
            together = dict.fromkeys(too_long, sheet.doubled.pen_mm)
        if together or too_long:
            sheet.together.update(n for n in together if n in doubled or sheet.is_broad(n))
            for stretch, width_mm in together.items():
                sheet.widths_mm[stretch] = width_mm
            parted |= set(together)
            two |= too_long
            continue
        inner = _heard(junctions.net.inner, told, done + quarter, quarter)
        more = {it.stretch for it in inner if not junctions.covers(it)}
        if not more:
            return junctions
        two |= more & (doubled | sheet.together)
        bare |= more - two
    return _without_bare(sheet, two | bare, known)


def _without_bare(
    sheet: FeltSheet, own: set[int], known: dict[Hashable, Crossing]
) -> Junctions:
    """The junctions of a sheet, of which some stretches are lines of their own, and all others along which no
    way goes: ways across a junction that is as long as these would lead over bare paper.
    """
    while True:
        junctions = Junctions(net_of(sheet, own), sheet.settings, known)
        more = {it.stretch for it in junctions.net.inner if not junctions.covers(it)}
        if not more:
            return junctions
        own = own | more


def _unexplained(junctions: Junctions, sheet: FeltSheet, known: set[int]) -> set[int]:
    """The stretches along which two lines explain ink that nothing else does; some are known to be two."""
    for some in (_left_over, _far):
        stretches = some(junctions, sheet, known)
        if found := {n for n in stretches if shows_two_lines(sheet, n)}:
            return found
    return set()


def _left_over(junctions: Junctions, sheet: FeltSheet, known: set[int]) -> set[int]:
    """The broad lines that leave another without a partner at both their ends, where ink is not explained.

    An odd number of lines meets at either end: each is two.
    """
    found = set[int]()
    for n, line in enumerate(junctions.net.lines):
        if line.stretch in known or not sheet.is_broad(line.stretch):
            continue
        ends = [junctions.at(Side(n, last)) for last in (False, True)]
        are_odd = all(len(there.legs) % 2 and len(there.legs) > 1 for there in ends)
        if are_odd and not any(there.crossing.is_explained for there in ends):
            found.add(line.stretch)
    return found


def _far(junctions: Junctions, sheet: FeltSheet, known: set[int]) -> set[int]:
    """The long stretches within junctions whose ink is not explained, if they may be those of two lines.

    The rims of their ink tell more of the two than their lines beyond it do.
    """
    pen_mm = sheet.doubled.pen_mm
    return {
        inner.stretch
        for inner in junctions.net.inner
        if inner.stretch not in known
        and sheet.is_broad(inner.stretch)
        and inner.run.length_mm > LEAST_WIDTHS * pen_mm
        and sheet.measured[inner.stretch].width_mm < 2 * pen_mm
        and (there := junctions.by_number.get(inner.junction)) is not None
        and not there.crossing.is_explained
    }


def _heard(
    items: Sequence[Item], told: Told | None, done: float, part: float
) -> Iterator[Item]:
    """The items; `told` hears before each how much is done: so much before all, and a part more behind."""
    for k, item in enumerate(items):
        if told is not None:
            told(done + part * k / len(items))
        yield item


def _beside(net: Net, stretches: set[int]) -> set[int]:
    """The stretches of lines that meet some."""
    met = {j for line in net.lines if line.stretch in stretches for j in line.junctions}
    return {line.stretch for line in net.lines if met.intersection(line.junctions)}


def _narrower_mm(sheet: FeltSheet, stretch: int) -> float:
    """Lines that go on from a stretch are narrower, if it is two lines: on a clean sheet by very little."""
    if sheet.is_broad(stretch):
        return sheet.measured[stretch].width_mm / BROADER
    return NARROWER * sheet.widths_mm[stretch]
