"""Several lines of a drawing: which of them the head follows, and in what order they become one program.

Signals: a Drawing and the lines that are asked for in; out a Trace over all those lines, inner before outer,
with short idle ways from line to line.

The lines are followed one after the other, the widest spread first, and put in order when it is known where
each begins and ends. If one is lost, the others are cut all the same. Lines that cross or touch one another
are one patch of ink: the others of it are followed after the first (see `joined_lines`).

Source: patent ES 361967 has one contour to a tape, and an operator who brings the head to it; to bring the
head to one line after the other is our own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from morfax.motion.faults import LineFault
from morfax.motion.polyline import nearest_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.lettering import lettering, lower_than
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.arrows import with_arrows
from morfax.tracer.program.cutting_order import in_cutting_order
from morfax.tracer.program.head_runs import followed
from morfax.tracer.program.laid.explained import explained, mended
from morfax.tracer.program.laid.line_parts import in_direction
from morfax.tracer.program.laid.narrow_bays import with_bars
from morfax.tracer.program.laid.small_lines import small_lines
from morfax.tracer.program.lines import selection
from morfax.tracer.program.lines.marks_read import with_marks_read
from morfax.tracer.program.lines.repeated import without_repeats
from morfax.tracer.program.lines.selection import COVERED, Contour, Which
from morfax.tracer.program.lines.small_rings import (
    SmallPatch,
    filled_up,
    none_begun,
    small_rings,
    unclear_patches,
)
from morfax.tracer.program.one_of_each import is_inside, one_of_each
from morfax.tracer.program.patch_lines import further_lines
from morfax.tracer.program.program import Trace
from morfax.tracer.program.setup import HeadProgress, Setup

# shares of the work that are done, as the bar has them; by the times of a form and a page of handwriting:
# when one line of each patch is found, when bays that show as bars are laid, of what it takes to find all ...
ONE_OF_EACH, WITH_BARS = 0.7, 0.85
# ... lines; when all are found, bent, and held against their ink
FOUND, BENT, EXPLAINED = 0.7, 0.8, 0.95


@dataclass(frozen=True, slots=True)
class FoundLines:
    """Lines that were followed, not yet in order; how many patches are no lines, and mm of ink that is joined
    to lines, but none. `patch_of` has the patch's number of each line that is joined to another; in
    `letters_out` are the numbers of lettering that is lower than the operator wants; on the patches `unclear`
    the head could nowhere be put down; the `slots` are patches whose sides run together.
    """

    lines: list[Line]
    left_out: int
    left_mm: dict[int, float]
    patch_of: dict[int, int] = field(default_factory=dict)
    letters_out: tuple[int, ...] = ()
    unclear: tuple[SmallPatch, ...] = ()
    slots: frozenset[int] = frozenset()

    def left_out_mm(self, but: frozenset[int] = frozenset()) -> float:
        """How much ink of all patches but some is joined to lines, but none."""
        return sum(mm for patch, mm in self.left_mm.items() if patch not in but)


def trace_lines(
    drawing: Drawing,
    which: Which = "contours",
    settings: Settings | None = None,
    operator: Operator | None = None,
    progress: HeadProgress | None = None,
) -> Trace:
    """Follow several lines of the drawing: "contours", those inside no other ("outer"), or some by their
    numbers (1 is the longest).

    `progress` hears how far the head has come and the length of all the lines, mm. Raises LineFault if no
    line is there to start on, or none has a number that is asked for.
    """
    operator = operator or Operator()
    setup = Setup(drawing.sheet, settings or Settings(), operator, progress)
    found = found_lines(setup.part(0.0, FOUND), which)
    lines, unread = with_marks_read(with_arrows(setup, found.lines), operator)
    _refuse_none_begun(lines, found.unclear)
    laid = explained if which == "contours" else mended  # some lines show no whole patch
    lines, left, one = laid(setup.part(FOUND, EXPLAINED), lines)
    lines = [in_direction(line, operator.direction) for line in lines]
    sheet = setup.sheet
    is_searched = _is_searched(setup, which, lines)
    return Trace(
        tuple(in_cutting_order(setup.part(EXPLAINED, 1.0), lines)),
        operator,
        left_out=found.left_out,
        left_out_mm=found.left_out_mm(but=one),
        unread=unread,
        unexplained=left if which == "contours" else (),
        letters=_letters(sheet, lines) if which == "contours" else (),
        letters_out=found.letters_out,
        small_rings=small_rings(sheet, found.slots) if is_searched else (),
        unclear=found.unclear + (_filled_up(sheet, found.slots) if is_searched else ()),
    )


def _filled_up(sheet: Sheet, slots: frozenset[int]) -> tuple[SmallPatch, ...]:
    """What is most likely a slot, and is none that was followed."""
    return tuple(SmallPatch.of(sheet, p) for p in filled_up(sheet) if p not in slots)


def _is_searched(setup: Setup, which: Which, lines: Sequence[Line]) -> bool:
    """Whether small closed lines are looked for that are no contours; a drawn program has rings as marks."""
    is_whole = isinstance(which, str) and not setup.sheet.drawing.edges_mm
    return is_whole and not setup.operator.reads_marks(lines)


def _letters(sheet: Sheet, lines: Sequence[Line]) -> tuple[int, ...]:
    """The numbers of lines that are likely lettering."""
    letters, followed_lines = lettering(sheet), {line.number for line in lines}
    patches = enumerate(selection.lines_of(sheet).tolist(), 1) if letters else ()
    return tuple(n for n, patch in patches if patch in letters and n in followed_lines)


def trace_places(
    drawing: Drawing,
    starts_mm: Sequence[tuple[float, float]],
    settings: Settings | None = None,
    operator: Operator | None = None,
    progress: HeadProgress | None = None,
) -> Trace:
    """Follow the line at each of some places (sheet mm); they are numbered as the places are given.

    Raises LineFault if no line is near a place, or two places are on one line.
    """
    operator = operator or Operator()
    alone = len(starts_mm) == 1
    sheet, heard = Sheet.of(drawing), progress if alone else None
    setup, lines = Setup(sheet, settings or Settings(), operator, heard), list[Line]()
    for number, start_mm in enumerate(starts_mm, 1):
        line = followed(setup, start_mm, number)
        for other in lines:
            near = nearest_mm(line.places_mm, other.places_mm) < line.width_mm
            if near.mean() > COVERED:
                raise _one_line(starts_mm[other.number - 1], start_mm)
        lines.append(line)
        if progress is not None and not alone:
            progress(float(number), float(len(starts_mm)))
    setup = replace(setup, progress=None)  # all that is told has come to its end
    _refuse_none_begun(lines)
    lines, unread = with_marks_read(with_arrows(setup, lines), operator)
    lines, left, _ = mended(setup, lines)
    beside = left if alone else ()
    return Trace(
        tuple(in_cutting_order(setup, lines)), operator, unread=unread, unexplained=beside
    )


def found_lines(setup: Setup, which: Which) -> FoundLines:
    """Follow the lines that are asked for; raises LineFault for a number that no line has.

    Numbers: patches, the longest first; dots that stand alone; slots whose sides run together; lines that are
    joined to another.
    """
    numbers = () if isinstance(which, str) else which
    last, patches = max(numbers, default=0), len(selection.lines_of(setup.sheet))
    small = _small_asked(setup, which, last > patches)
    holes = [line for _, line in small]
    beyond = last > patches + len(holes)
    # 1. one line of each patch; only a line joined to another has a number beyond patches and dots
    numbered = tuple(n for n in numbers if n <= patches) if numbers else which
    asked, left_out = selection.plan(setup.sheet, "contours" if beyond else numbered)
    asked, letters_out = _high_enough(setup, asked) if not numbers else (asked, ())
    lines, unclear, strokes = one_of_each(setup.part(0.0, ONE_OF_EACH), asked, which)
    # 2. the other lines of those patches
    others = [line for some in strokes.values() for line in some]
    lines = with_bars(setup.part(ONE_OF_EACH, WITH_BARS), lines, others)
    joined, left_mm = further_lines(setup.part(WITH_BARS, 1.0), asked, lines, strokes)
    patch_of = dict[int, int]()
    if beyond or not numbers:
        further = _numbered_on(joined, patches + len(holes))
        patch_of = {line.number: patch for line, patch in further}
        others = [line for line, _ in further]
        lines += [line for line in others if which != "outer" or not is_inside(line, lines)]
    lines = lines if numbers else without_repeats(lines)
    lines = selection.with_least_numbers(lines, asked)
    # 3. dots that stand alone, and slots whose sides run together
    lines += holes
    if beyond or (holes and numbers):
        lines = _of_numbers(lines, numbers)
    no_lines = left_out + len(unclear) - len(holes)
    too_small = unclear_patches(setup.sheet, unclear)
    slots = frozenset(patch for patch, line in small if not line.is_dot)
    return FoundLines(lines, no_lines, left_mm, patch_of, letters_out, too_small, slots)


def _high_enough(setup: Setup, asked: list[Contour]) -> tuple[list[Contour], tuple[int, ...]]:
    """The contours without lettering lower than the operator wants, and the numbers of that lettering; all,
    if nothing else is on the sheet.
    """
    from_mm = setup.operator.letters_from_mm
    if from_mm <= 0:
        return asked, ()
    low = lower_than(setup.sheet, lettering(setup.sheet), from_mm)
    kept = [contour for contour in asked if contour.stroke.patch not in low]
    if not kept:
        return asked, ()
    return kept, tuple(sorted({c.number for c in asked} - {c.number for c in kept}))


def _small_asked(setup: Setup, which: Which, are_numbered: bool) -> list[tuple[int, Line]]:
    """The small lines with their patches, where contours are asked for, or a number that one may have."""
    return small_lines(setup) if which == "contours" or are_numbered else []


def _numbered_on(joined: list[tuple[Line, int]], last: int) -> list[tuple[Line, int]]:
    """The lines with numbers after the last one, the longest first; each with its patch's number."""
    longest_first = sorted(joined, key=lambda each: -each[0].length_mm)
    numbered = enumerate(longest_first, last + 1)
    return [(replace(line, number=number), patch) for number, (line, patch) in numbered]


def _of_numbers(lines: list[Line], numbers: tuple[int, ...]) -> list[Line]:
    """The lines that have one of some numbers; raises LineFault for a number that none has."""
    have = {line.number for line in lines}
    for number in numbers:
        if number not in have:
            raise selection.no_line(int(number), sorted(have))
    return [line for line in lines if line.number in numbers]


def _refuse_none_begun(lines: list[Line], unclear: Sequence[SmallPatch] = ()) -> None:
    """Raise LineFault for a sheet on which no line could be begun."""
    if any(len(line.xy_mm) > 1 for line in lines):
        return
    fault = lines[0].fault if lines else None
    raise fault or none_begun(unclear)


def _one_line(first_mm: tuple[float, float], second_mm: tuple[float, float]) -> LineFault:
    """The fault of two places to start that are on one line."""
    (x, y), (u, v) = first_mm, second_mm
    return LineFault(
        f"--start {x:g},{y:g} and --start {u:g},{v:g} are on the same line; leave one of them out",
        x_mm=u,
        y_mm=v,
    )
