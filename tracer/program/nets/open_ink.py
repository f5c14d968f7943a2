"""Open ink: the strokes of a patch of ink of which no line comes round.

Signals: a set-up and a patch in; lines out, the longest first.

    ├──    ╲ ╱      a letter, an arrow, a tree: from any place the head goes straight on to an end, or into
    │       │       what it has followed; no other place, and no other turn at a junction, brings it round

Nothing is tried on such ink. Its junctions are solved once, and the head runs each of its strokes once, as
where all the ink is asked for (see `tracer.ink`).

Source: our own. Questions: a line with gaps may come round though no patch of it goes round an area; so ink
that ends at a gap is not taken for open.
"""

from __future__ import annotations

from dataclasses import replace

from morfax.tracer.drawing.strokes import Stroke
from morfax.tracer.following.line import Line
from morfax.tracer.following.open_ends import stances_at
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.following.start import ENDS, ends_of
from morfax.tracer.program.nets.net_outline import (
    chain_mm,
    goes_round_none,
    junctions_of,
    line_along,
    may_solve,
)
from morfax.tracer.program.setup import Setup

ENDS_OF_ONE = 2  # of a single stroke: where there are more, strokes meet


def is_open(setup: Setup, stroke: Stroke) -> bool:
    """Whether no line of a patch comes round: it goes round no area, and none of its ends is at a gap."""
    if not may_solve(setup) or not goes_round_none(setup.sheet, stroke.patch):
        return False
    return _is_apart(setup, stroke, _ends(setup, stroke, setup.settings.gap_mm))


def is_of_several(setup: Setup, stroke: Stroke) -> bool:
    """Whether a patch is open and several strokes meet in it, none of which comes from a reference point."""
    if not may_solve(setup) or not goes_round_none(setup.sheet, stroke.patch):
        return False
    ends = ends_of(setup.sheet, stroke, setup.settings, setup.operator.reference_mm)
    is_lead = any(stance.reference_mm is not None for stance, _ in ends)
    if len(ends) <= ENDS_OF_ONE or is_lead:
        return False
    count = len(ends) if len(ends) < ENDS else _ends(setup, stroke, setup.settings.gap_mm)
    return _is_apart(setup, stroke, count)


def strokes_of(setup: Setup, patch: int, number: int) -> list[Line]:
    """The longest stroke of a patch, and those others that are lines, the longest first, all with the patch's
    number; none if nothing is felt.
    """
    from morfax.tracer.ink.outlines import is_free

    junctions, ink_mm = junctions_of(setup, patch), float(setup.sheet.lengths_mm[patch])
    chains = sorted(junctions.chains(), key=lambda chain: -chain_mm(chain, junctions))
    return [
        replace(line_along(setup, chain, junctions), number=number, ink_mm=ink_mm)
        for n, chain in enumerate(chains)
        if n == 0 or chain.closed or is_free(chain, junctions)
    ]


def _is_apart(setup: Setup, stroke: Stroke, ends: int) -> bool:
    """Whether a patch has no more ends where the head goes on across no gap: no line leads on from it."""
    return ends == _ends(setup, stroke, 0.0)


def _ends(setup: Setup, stroke: Stroke, gap_mm: float) -> int:
    """How many open ends a patch has, if the head goes on across gaps no wider than this."""
    sheet, settings = setup.sheet, setup.settings
    view = view_of(sheet, settings.aperture_mm, settings.line_width_mm or stroke.width_mm)
    return sum(1 for _ in stances_at(view, stroke.ends_mm(), gap_mm))
