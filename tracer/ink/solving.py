"""Solving: the junctions of a sheet, solved anew until all ink between them is a line's, or two lines'.

Signals: a sheet as it was felt in; its junctions out.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Hashable

from morfax.tracer.effort import ROUNDS
from morfax.tracer.ink.chains import Junctions
from morfax.tracer.ink.crossing import Crossing
from morfax.tracer.ink.doubled import BROADER
from morfax.tracer.ink.net import Net, net_of
from morfax.tracer.ink.stretches import FeltSheet

# of a line's width: two that go on from both its ends, so narrow and so straight on, run together in it; by
# trial on drawings of nets
NARROWER = 0.8


def solved(sheet: FeltSheet) -> Junctions:
    """The junctions of a sheet. A stretch within one along which no way goes is a line of its own, or two.

    A stretch that turns out to be two lines that run together lies within a junction, or is too long for
    that; then what meets it there is asked anew, for these two may be what goes along another stretch.
    """
    cut = sheet.doubled.cut
    parted, two, bare = set(cut), set(cut), set[int]()
    sheet.widths_mm[:] = [
        sheet.doubled.pen_mm if n in cut else width_mm
        for n, width_mm in enumerate(sheet.widths_mm)
    ]
    doubled = sheet.doubled.throughout(sheet.felt)
    known = dict[Hashable, Crossing]()
    for _ in range(ROUNDS):
        junctions = Junctions(net_of(sheet, two | bare), sheet.settings, known)
        lines = [line.stretch for line in junctions.net.lines]
        together = dict.fromkeys((doubled & set(lines)) - parted - bare, sheet.doubled.pen_mm)
        together |= {
            stretch: width_mm
            for n, stretch in enumerate(lines)
            if stretch not in parted | bare
            and (width_mm := junctions.single_mm(n, _narrower_mm(sheet, stretch))) is not None
        }
        sheet.together.update(n for n in together if n in doubled or sheet.is_broad(n))
        too_long = parted.intersection(lines) - two - bare
        if together or too_long:
            for stretch, width_mm in together.items():
                sheet.widths_mm[stretch] = width_mm
            parted |= set(together)
            two |= too_long
            bare -= _beside(junctions.net, too_long.union(together))
            continue
        more = {inner.stretch for inner in junctions.net.inner if not junctions.covers(inner)}
        if not more:
            return junctions
        two |= more & (doubled | sheet.together)
        bare |= more - two
    return Junctions(net_of(sheet, two | bare), sheet.settings, known)


def _beside(net: Net, stretches: set[int]) -> set[int]:
    """The stretches of lines that meet some."""
    met = {j for line in net.lines if line.stretch in stretches for j in line.junctions}
    return {line.stretch for line in net.lines if met.intersection(line.junctions)}


def _narrower_mm(sheet: FeltSheet, stretch: int) -> float:
    """Lines that go on from a stretch are narrower, if it is two lines: on a clean sheet by very little."""
    if sheet.is_broad(stretch):
        return sheet.measured[stretch].width_mm / BROADER
    return NARROWER * sheet.widths_mm[stretch]
