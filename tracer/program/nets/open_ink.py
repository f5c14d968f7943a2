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
from typing import TYPE_CHECKING

from morfax.tracer.drawing.strokes import Stroke
from morfax.tracer.following.faint_corner import TipPose, faint_corner
from morfax.tracer.following.line import Line
from morfax.tracer.following.open_ends import stances_at
from morfax.tracer.following.plain_places import stands_near, view_of
from morfax.tracer.following.start import ENDS, ends_of
from morfax.tracer.junctions.line_ahead import straight_on
from morfax.tracer.program.lines.selection import LETTER_MM, SHORT, Contour
from morfax.tracer.program.nets.net_outline import (
    NEARLY_ALL,
    chain_mm,
    goes_round,
    junctions_of,
    line_along,
    may_solve,
)
from morfax.tracer.program.setup import Setup

if TYPE_CHECKING:
    from morfax.tracer.ink.chains import Junctions

ENDS_OF_ONE = 2  # of a single stroke: where there are more, strokes meet


def is_open(setup: Setup, stroke: Stroke) -> bool:
    """Whether no line of a patch comes round: it goes round no area, and none of its ends is at a gap."""
    if not may_solve(setup) or not goes_round(setup.sheet, stroke.patch, 0):
        return False
    return _is_apart(setup, stroke, _ends(setup, stroke, setup.settings.gap_mm))


def strokes_told(setup: Setup, contour: Contour, is_letter: bool) -> list[Line] | None:
    """The strokes of a patch, the longest first, if they are what was drawn: of a letter, of open ink of
    several strokes, and of small open ink that the head leaves across no gap.
    """
    stroke, is_small = contour.stroke, contour.reach_mm < LETTER_MM
    ends = _ends_of_open(setup, stroke)
    are_several = ends is not None and ends > ENDS_OF_ONE and _is_apart(setup, stroke, ends)
    may_tell = is_letter or are_several or (is_small and ends is not None)
    if not may_tell or not can_stand(setup, contour):
        return None
    strokes = strokes_of(setup, stroke.patch, contour.number)
    if not strokes or strokes[0].gap_mm is not None:  # its ends face each other
        return None
    junctions = junctions_of(setup, stroke.patch)
    if are_several:
        return strokes
    if not is_letter and leads_on(junctions, setup.settings.gap_mm):
        return None
    # what is left out lies beside them: the head may go along more
    long_mm = sum(line.length_mm for line in strokes)
    all_mm = sum(chain_mm(chain, junctions) for chain in junctions.chains())
    are_all = len(strokes) > 1 and long_mm > NEARLY_ALL * all_mm
    return strokes if are_all or strokes[0].length_mm > SHORT * strokes[0].ink_mm else None


def can_stand(setup: Setup, contour: Contour) -> bool:
    """Whether the head can be put down somewhere on a patch."""
    settings, stroke = setup.settings, contour.stroke
    width_mm = settings.line_width_mm or stroke.width_mm
    view = view_of(setup.sheet, settings.aperture_mm, width_mm)
    return any(stands_near(view, stroke, start_mm) for start_mm in contour.starts_mm)


def leads_on(junctions: Junctions, gap_mm: float) -> bool:
    """Whether the head goes on from any end of a patch, across a gap or over pale ink to another end."""
    from morfax.tracer.ink.net import end_leg

    net, tips = junctions.net, list[TipPose]()
    for line in net.lines:
        for last in (False, True):
            if line.junctions[last] not in net.free_ends:
                continue
            view, leg = line.runs[-1 if last else 0].view, end_leg(line, last)
            if straight_on(view, leg, gap_mm) is not None:
                return True
            tip = TipPose.of(view, leg)
            if any(faint_corner(view, tip, other) is not None for other in tips):
                return True
            tips.append(tip)
    return False


def strokes_of(setup: Setup, patch: int, number: int) -> list[Line]:
    """The longest stroke of a patch, and those others that are lines, the longest first, all with the patch's
    number; none if nothing is felt.
    """
    from morfax.tracer.ink.outlines import goes_round_paper, is_free

    junctions, ink_mm = junctions_of(setup, patch), float(setup.sheet.lengths_mm[patch])
    chains = [
        it for it in junctions.chains() if not it.closed or goes_round_paper(it, junctions)
    ]
    chains.sort(key=lambda chain: -chain_mm(chain, junctions))
    return [
        replace(line_along(setup, chain, junctions), number=number, ink_mm=ink_mm)
        for n, chain in enumerate(chains)
        if n == 0 or chain.closed or is_free(chain, junctions)
    ]


def _ends_of_open(setup: Setup, stroke: Stroke) -> int | None:
    """How many ends open ink has; None if it goes round an area, or a line comes from a reference point."""
    if not may_solve(setup) or not goes_round(setup.sheet, stroke.patch, 0):
        return None
    ends = ends_of(setup.sheet, stroke, setup.settings, setup.operator.reference_mm)
    if any(stance.reference_mm is not None for stance, _ in ends):
        return None
    return len(ends) if len(ends) < ENDS else _ends(setup, stroke, setup.settings.gap_mm)


def _is_apart(setup: Setup, stroke: Stroke, ends: int) -> bool:
    """Whether a patch has no more ends where the head goes on across no gap: no line leads on from it."""
    return ends == _ends(setup, stroke, 0.0)


def _ends(setup: Setup, stroke: Stroke, gap_mm: float) -> int:
    """How many open ends a patch has, if the head goes on across gaps no wider than this."""
    sheet, settings = setup.sheet, setup.settings
    view = view_of(sheet, settings.aperture_mm, settings.line_width_mm or stroke.width_mm)
    return sum(1 for _ in stances_at(view, stroke.ends_mm, gap_mm))
