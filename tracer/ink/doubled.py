"""Doubled ink: stretches that two lines share, nearer to each other than a pen's width all along.

Signals: the stations along each stretch (places mm, widths mm) in; out the pen's width and, of each stretch,
which stations lie in ink that two lines share (for the two lines see `both_lines`).

    ════════════════      a pen's lines are as wide everywhere; two of them that run together show ink
    ══════──────────      between one and about two widths wide, which swells and shrinks slowly

Only a clean sheet tells that: one whose lines have smooth edges and on which much of the ink is as narrow as
the narrowest. Lettering has pens of its own, and the strokes of a printed letter swell. A nib or a brush
swells and shrinks, too (see `nib`). Ink of one even width is a line of a broader pen; so is a patch of ink
that is nowhere as narrow as a line of the pen, for two lines cross, part, or end one after the other. Where
most broad ink is even, pens of several widths have drawn the sheet, and two lines are told by more swelling.

Source: our own.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.motion.plane import BEND_RAD
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.ink.nib import (
    ENOUGH,
    SwellingKind,
    is_by_heading,
    like_two_lines,
    may_be_two_lines,
    what_swells,
)
from morfax.tracer.ink.run import Run
from morfax.tracer.ink.swelling import (
    TWO,
    Swelling,
    pen_of,
    pen_of_hollow,
    second_pen_of,
    stands_out,
)
from morfax.tracer.limits import AS_WIDE, CLEAR_WIDTHS, WIDER

Flags = NDArray[np.bool_]

# All limits below were chosen by trial on drawings of nets and on line art.
BROADER = 1.05  # times the pen's width: of ink into which two lines run at both its ends
EVEN = 0.04  # of a stretch's width: a line whose width differs by no more is one line
# of it, where pens are of several widths: of their lines 0.12 at most, of two lines in one ink 0.14 or more
SWELLS = 0.13
FROM_ENDS = 10.0  # widths: within them two lines that share a stretch have begun to
HALF = 0.5  # of a short piece's stations tell its width
STRAIGHT_COS = math.cos(BEND_RAD)
# the width of a line as the head wants it: of a narrower one pixels make the width swell; and where they are
# ink or paper alone, and tell a width to one of them: `WIDER` is more then
LEAST_PX = 3.0, 7.0
# widths of a pen that are a long way: no crossing between two pieces is longer
LEAST_WIDTHS = 8.0


class SureWidths(NamedTuple):
    """Which widths of lines a drawing tells, mm: none that are less; and by how much a line of one width may
    differ all the same, because it runs along the steps of pixels for longer than its rims are laid through.
    """

    least_mm: float
    step_mm: float

    @classmethod
    def of(cls, drawing: Drawing) -> SureWidths:
        """Those of a drawing."""
        pixel_mm = drawing.pitch_mm * drawing.finer
        return cls(LEAST_PX[drawing.is_hard] * pixel_mm, drawing.has_rims * pixel_mm)


class Doubled(NamedTuple):
    """The pen's width, mm, and the stretches that two lines share: which of the stations of each.

    Short pieces of the same lines are `cut` by others that cross them. Where it is not sure that they are two
    they are run once, and told if a place along them looks so. `second_mm` is the width of a second, broader
    pen, if there is one.
    """

    pen_mm: float = math.nan
    stations: dict[int, Flags] = {}  # noqa: RUF012 - a NamedTuple's default, never written to
    cut: frozenset[int] = frozenset()
    is_sure: bool = True
    second_mm: float = math.nan

    @classmethod
    def of(
        cls,
        felt: Sequence[Run],
        found: Mapping[int, Swelling],
        patch_of: Mapping[int, int],
        onward: Callable[[int], tuple[int, int]],
        sure: SureWidths,
    ) -> Doubled:
        """Find the doubled stretches among those whose widths are given, and patches; none of a sheet that is
        not clean, or whose lines are narrower than it tells. `onward` says how many go straight on from
        either end of one.
        """
        # 1. whether the ink along each stretch is one pen's line, or two lines
        every = list(found.values())
        pen_mm, beside_mm = pen_of(every), pen_of_hollow(every)
        pen_mm = beside_mm if math.isnan(pen_mm) else pen_mm
        if not pen_mm > sure.least_mm:
            return cls()
        ink = SwellingKind.TWO_LINES if beside_mm > 0 else _what_is(every, pen_mm)
        if ink == SwellingKind.NIB:
            return cls()
        if not beside_mm > 0:  # where all lines run in pairs no ink is one line's
            found = _of_the_pen(found, patch_of, pen_mm)
        # 2. those that swell and shrink
        broad = {
            n: flags
            for n, some in found.items()
            if (flags := _broad(felt[n], some.averaged, pen_mm)) is not None
        }
        spreads = {n: spread(found[n].averaged) for n in broad}
        steps = {n: sure.step_mm / median(found[n].known) for n in broad}
        even = {n for n in broad if spreads[n] <= max(EVEN, steps[n])}
        second_mm = _second_mm(found, broad)
        if _are_most(felt, even, broad) or second_mm > 0:
            swell = {n for n in broad if spreads[n] > max(SWELLS, steps[n])}
        else:
            swell = {n for n in broad if spreads[n] > EVEN}
        if not beside_mm > 0:
            swell -= _nibs({n: found[n] for n in swell}, patch_of, onward, pen_mm)
        stations = {n: broad[n] for n in sorted(swell)}
        if ink == SwellingKind.EITHER:
            told = {n: stations[n] for n in stations if like_two_lines(found[n], pen_mm)}
            return cls(pen_mm, told, is_sure=False)
        return cls(pen_mm, stations, _cut(felt, patch_of, swell, pen_mm), second_mm=second_mm)

    def is_second(self, run: Run) -> bool:
        """Whether a stretch is a line of the second pen: about as broad as that all along."""
        known = run.widths_mm[np.isfinite(run.widths_mm)]
        if not self.second_mm > 0 or not len(known):
            return False
        return abs(median(known) / self.second_mm - 1) < AS_WIDE and spread(known) <= SWELLS

    def length_mm(self, felt: Sequence[Run], number: int) -> float:
        """The length of the ink of a stretch that two lines share, mm."""
        flags = self.stations.get(number)
        return 0.0 if flags is None else float(flags.sum()) * felt[number].view.step_mm

    def throughout(self, felt: Sequence[Run]) -> set[int]:
        """The stretches that two lines share from end to end: of others one of the lines ends on the way."""
        found = set[int]()
        if not self.is_sure:
            return found
        for n, flags in self.stations.items():
            there = np.flatnonzero(flags)
            end_mm = max(there[0], len(flags) - 1 - there[-1]) * felt[n].view.step_mm
            if end_mm < FROM_ENDS * self.pen_mm:
                found.add(n)
        return found


def _second_mm(found: Mapping[int, Swelling], broad: Mapping[int, Flags]) -> float:
    """The width of a second pen, mm, by the stations of ink that is broader than the first; NaN if none."""
    some = [found[n].averaged[flags] for n, flags in broad.items()]
    return second_pen_of([each[np.isfinite(each)] for each in some])


def _of_the_pen(
    found: Mapping[int, Swelling], patch_of: Mapping[int, int], pen_mm: float
) -> dict[int, Swelling]:
    """The stretches of the patches of which some ink is as narrow as a line of the pen."""
    own = {patch_of[n] for n, some in found.items() if some.known.min() < WIDER * pen_mm}
    return {n: some for n, some in found.items() if patch_of[n] in own}


def _nibs(
    some: Mapping[int, Swelling],
    patch_of: Mapping[int, int],
    onward: Callable[[int], tuple[int, int]],
    pen_mm: float,
) -> set[int]:
    """Stretches that swell as one stroke of a nib, on patches where lines do not cross more than once."""
    crossed = Counter[int]()
    for n, each in some.items():
        crossed[patch_of[n]] += len(like_two_lines(each, pen_mm))
    return {
        n
        for n, each in some.items()
        if crossed[patch_of[n]] < ENOUGH and not may_be_two_lines(each, pen_mm, onward(n))
    }


def _what_is(some: Sequence[Swelling], pen_mm: float) -> SwellingKind:
    """What ink is that swells. If the width of one pen stands out, what is broader is two lines."""
    if is_by_heading(some):
        return SwellingKind.NIB
    return SwellingKind.TWO_LINES if stands_out(some, pen_mm) else what_swells(some, pen_mm)


def _broad(run: Run, averaged: Array, pen_mm: float) -> Flags | None:
    """Which stations of a stretch lie in ink as broad as that of two lines; None if it is no long way."""
    if np.nanmax(averaged) > TWO * pen_mm:
        return None
    flags = averaged > WIDER * pen_mm  # NaN is not
    # near its ends a stretch shows no width: what is broad wherever it does is broad from end to end
    is_whole = bool((flags | np.isnan(averaged)).all())
    stations = len(flags) if is_whole else int(flags.sum())
    return flags if stations * run.view.step_mm > LEAST_WIDTHS * pen_mm else None


def spread(averaged: Array) -> float:
    """How much the width of a stretch differs along it, of its width."""
    low_mm, high_mm = np.nanpercentile(averaged, (10, 90))
    return float(1 - low_mm / high_mm)


def _are_most(felt: Sequence[Run], some: Iterable[int], every: Iterable[int]) -> bool:
    """Whether some stretches are most of the length of others."""
    some_mm, all_mm = (sum(felt[n].length_mm for n in each) for each in (some, every))
    return some_mm > HALF * all_mm


def _cut(
    felt: Sequence[Run], some: Iterable[int], doubled: set[int], pen_mm: float
) -> frozenset[int]:
    """Pieces that are too short to be told as doubled by themselves, between doubled ink straight on."""
    kept = {n for n in some if n not in doubled and _is_piece(felt[n], pen_mm)}
    before = set[int]()
    while kept != before:
        before, both = kept, [*kept, *doubled]
        kept = {
            n
            for n in kept
            if all(
                any(m != n and _is_straight_on(run, felt[m], pen_mm) for m in both)
                for run in (felt[n], felt[n].turned_round())
            )
        }
    return frozenset(kept)


def _is_piece(run: Run, pen_mm: float) -> bool:
    """Whether a stretch may be a piece of two lines: about as broad all along, and not where others cross."""
    known = run.widths_mm[np.isfinite(run.widths_mm)]
    if len(known) < HALF * len(run):
        return False
    low_mm, usual_mm, high_mm = np.percentile(known, (25, 50, 75))
    is_two = WIDER * pen_mm < usual_mm < TWO * pen_mm
    is_even = high_mm - low_mm < AS_WIDE * usual_mm
    return bool(is_two and is_even and run.length_mm > CLEAR_WIDTHS * usual_mm)


def _is_straight_on(run: Run, other: Run, pen_mm: float) -> bool:
    """Whether another stretch, about as broad there, lies straight on from a run's last place."""
    way, near = (
        run.places_mm[-1] - run.places_mm[0],
        round(0.5 * LEAST_WIDTHS * pen_mm / other.view.step_mm),
    )
    for onward, widths in (
        (other.places_mm, other.widths_mm[:near]),
        (other.places_mm[::-1], other.widths_mm[-near:]),
    ):
        gap, far = onward[0] - run.places_mm[-1], onward[-1] - onward[0]
        if (
            math.hypot(*gap) < LEAST_WIDTHS * pen_mm
            and min(_cos(way, far), _cos(way, gap + far)) > STRAIGHT_COS
            and abs(np.nanmedian(run.widths_mm) / np.nanmedian(widths) - 1) < AS_WIDE
        ):
            return True
    return False


def _cos(one: Array, other: Array) -> float:
    """The cosine of the angle between two directions; 0 where one is none."""
    sizes = math.hypot(*one) * math.hypot(*other)
    return float(one @ other) / sizes if sizes > 0 else 0.0
