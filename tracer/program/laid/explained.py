"""Explained: lines bent to their ink, with narrow bays mended, and patches that are one outline as that.

Signals: the set-up and the lines that the head found in; the lines as they explain the ink, what they leave
of it, and which patches are one line now, out.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.unexplained import Unexplained
from morfax.tracer.program.laid import narrow_bays
from morfax.tracer.program.laid.bent import bent
from morfax.tracer.program.setup import Setup

if TYPE_CHECKING:
    from morfax.tracer.program.laid.one_outline import OneOutline

NONE: Mapping[int, OneOutline] = {}
BENT = 0.4  # share of the work that is done when lines are bent, by the times of a form


class Explained(NamedTuple):
    """Lines, what they leave unexplained, and the patches of ink that are one of them each."""

    lines: list[Line]
    left: tuple[Unexplained, ...]
    one: frozenset[int] = frozenset()


def explained(setup: Setup, lines: Sequence[Line]) -> Explained:
    """All lines of a sheet, or of a patch, as they explain the ink: those of a patch that is one outline as
    that, unless the lines that were found leave less of its ink when they are mended.

    A patch that goes round several areas of paper is asked at once; another one if its lines leave some ink
    when they are mended.
    """
    # 1. with the outlines of the patches that are asked at once
    goes_round = setup.sheet.loops() > 1
    outlines = _outlines(setup, lines, set(np.flatnonzero(goes_round).tolist()))
    found = mended(setup, lines, outlines)
    # 2. the other way about, where that is in doubt
    is_left = {patch for patch in _told(setup, found) if not goes_round[patch]}
    others = _outlines(setup, lines, is_left)
    sure = {patch: outline for patch, outline in outlines.items() if outline.is_sure}
    doubtful = {p: o for p, o in outlines.items() if not o.is_sure} | others
    if not doubtful:
        return found
    other = mended(setup, lines, sure | others)
    # 3. of each patch what leaves less
    both = [_OnPatches.of(setup, each) for each in (found, other)]
    better = frozenset(
        patch
        for patch, outline in doubtful.items()
        if both[1].leaves(patch, outline) < both[0].leaves(patch, outline)
    )
    return _put_together(both, better) if better else found


class _OnPatches(NamedTuple):
    """Lines and what they leave, with the patch of ink of each."""

    found: Explained
    of_line: list[int]
    of_place: list[int]

    @classmethod
    def of(cls, setup: Setup, found: Explained) -> _OnPatches:
        """The same of some lines."""
        places = [np.array(place.place_mm) for place in found.left]
        of_place = [setup.sheet.patch_at(place) for place in places]
        return cls(found, _patches(setup, found.lines), of_place)

    def lines(self, patches: Container[int]) -> list[Line]:
        """The lines on some patches."""
        each = zip(self.found.lines, self.of_line, strict=True)
        return [line for line, patch in each if patch in patches]

    def left(self, patches: Container[int]) -> list[Unexplained]:
        """What is left on some patches."""
        each = zip(self.found.left, self.of_place, strict=True)
        return [place for place, patch in each if patch in patches]

    def leaves(self, patch: int, outline: OneOutline) -> tuple[float, float]:
        """How much ink is told of a patch, mm, and how much is left in all."""
        told_mm = sum(place.length_mm for place in self.left({patch}) if place.kind == "ink")
        return told_mm, outline.left(self.lines({patch}))


def mended(
    setup: Setup, lines: Sequence[Line], outlines: Mapping[int, OneOutline] = NONE
) -> Explained:
    """The lines with outlines in place of those of some patches, bent to their ink, and their narrow bays
    mended.
    """
    in_place_of = {id(each.found[0]): each.line for each in outlines.values()}
    gone = {id(line) for each in outlines.values() for line in each.found[1:]}
    outlined = [in_place_of.get(id(line), line) for line in lines if id(line) not in gone]
    as_bent = bent(setup.part(0.0, BENT), outlined)
    with_bays, left = narrow_bays.explained(setup.part(BENT, 1.0), as_bent)
    return Explained(with_bays, left, frozenset(outlines))


def _outlines(setup: Setup, lines: Sequence[Line], patches: set[int]) -> dict[int, OneOutline]:
    """Those of some patches of ink that are one outline each, by their numbers."""
    if not patches or setup.operator.reads_marks(lines):
        return {}
    from morfax.tracer.program.laid.one_outline import as_one_outline

    found = dict[int, list[Line]]()
    for line, patch in zip(lines, _patches(setup, lines), strict=True):
        if patch in patches:
            found.setdefault(patch, []).append(line)
    outlines = {patch: as_one_outline(setup, patch, those) for patch, those in found.items()}
    return {patch: each for patch, each in outlines.items() if each is not None}


def _told(setup: Setup, found: Explained) -> set[int]:
    """The patches of which ink is left."""
    places = [np.array(place.place_mm) for place in found.left if place.kind == "ink"]
    return {setup.sheet.patch_at(place) for place in places}


def _patches(setup: Setup, lines: Sequence[Line]) -> list[int]:
    """The patch of ink of each line."""
    return [setup.sheet.patch_at(line.places_mm[0]) for line in lines]


def _put_together(both: list[_OnPatches], better: frozenset[int]) -> Explained:
    """The first of two, but for some patches, of which the other is better."""
    first, second = both
    rest = {*first.of_line, *first.of_place} - better
    lines = first.lines(rest) + second.lines(better)
    left = first.left(rest) + second.left(better)
    longest_first = sorted(left, key=lambda place: -place.length_mm)
    return Explained(lines, tuple(longest_first), first.found.one ^ better)
