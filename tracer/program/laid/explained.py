"""Explained: lines bent to their ink, with narrow bays mended, and patches that are one outline as that.

Signals: the set-up and the lines that the head found in; the lines as they explain the ink, what they leave
of it, and which patches are one line now, out.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.unexplained import Unexplained
from morfax.tracer.program.laid import narrow_bays
from morfax.tracer.program.laid.bent import bent
from morfax.tracer.program.laid.one_outline import OneOutline, as_one_outline
from morfax.tracer.program.setup import Setup

BENT = 0.4  # share of the work that is done when lines are bent, by the times of a form


class Explained(NamedTuple):
    """Lines, what they leave unexplained, and the patches of ink that are one of them each."""

    lines: list[Line]
    left: tuple[Unexplained, ...]
    one: frozenset[int] = frozenset()


def explained(setup: Setup, lines: Sequence[Line]) -> Explained:
    """The lines as they explain the ink: those of a patch that is one outline as that, unless the lines that
    were found leave less of its ink when they are mended.
    """
    outlines = _outlines(setup, lines)
    found = _mended(setup, lines, outlines)
    if all(outline.is_sure for outline in outlines.values()):
        return found
    sure = {patch: outline for patch, outline in outlines.items() if outline.is_sure}
    other = _mended(setup, lines, sure)
    patches = [_patches(setup, each.lines) for each in (found, other)]
    better = frozenset(
        patch
        for patch in outlines.keys() - sure.keys()
        if outlines[patch].left(_on(patch, other, patches[1]))
        < outlines[patch].left(_on(patch, found, patches[0]))
    )
    return _put_together(setup, (found, other), patches, better) if better else found


def _mended(
    setup: Setup, lines: Sequence[Line], outlines: Mapping[int, OneOutline]
) -> Explained:
    """The lines with outlines in place of those of some patches, bent to their ink, and their narrow bays
    mended.
    """
    place = {id(each.found[0]): each.line for each in outlines.values()}
    gone = {id(line) for each in outlines.values() for line in each.found[1:]}
    outlined = [place.get(id(line), line) for line in lines if id(line) not in gone]
    told = bent(setup.part(0.0, BENT), outlined)
    mended, left = narrow_bays.explained(setup.part(BENT, 1.0), told)
    return Explained(mended, left, frozenset(outlines))


def _outlines(setup: Setup, lines: Sequence[Line]) -> dict[int, OneOutline]:
    """The patches of ink on which lines were found that are one outline each, by their numbers."""
    sheet, found = setup.sheet, dict[int, list[Line]]()
    goes_round = sheet.loops()
    if goes_round.max(initial=0) < 2 or setup.operator.reads_marks(lines):
        return {}
    for line in lines:
        if goes_round[patch := sheet.patch_at(line.places_mm[0])] > 1:
            found.setdefault(patch, []).append(line)
    outlines = {patch: as_one_outline(setup, patch, those) for patch, those in found.items()}
    return {patch: each for patch, each in outlines.items() if each is not None}


def _patches(setup: Setup, lines: Sequence[Line]) -> list[int]:
    """The patch of ink of each line."""
    return [setup.sheet.patch_at(line.places_mm[0]) for line in lines]


def _on(patch: int, found: Explained, patches: list[int]) -> list[Line]:
    """The lines on a patch."""
    return [line for line, on in zip(found.lines, patches, strict=True) if on == patch]


def _put_together(
    setup: Setup,
    both: tuple[Explained, Explained],
    patches: Sequence[list[int]],
    better: frozenset[int],
) -> Explained:
    """The first of two, but for some patches, of which the other is better."""
    lines, left = list[Line](), list[Unexplained]()
    for n, each in enumerate(both):
        is_from = [(patch in better) == n for patch in patches[n]]
        lines += [line for line, is_one in zip(each.lines, is_from, strict=True) if is_one]
        places = [setup.sheet.patch_at(np.array(place.place_mm)) for place in each.left]
        left += [
            place
            for place, patch in zip(each.left, places, strict=True)
            if (patch in better) == n
        ]
    longest_first = sorted(left, key=lambda place: -place.length_mm)
    return Explained(lines, tuple(longest_first), both[0].one - better)
