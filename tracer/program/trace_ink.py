"""All the ink of a drawing as one program: every stretch of line, in few long strokes and short idle ways.

Signals: a Drawing in; out a Trace over its strokes; of a drawing that was read for both, also over the
outlines of its solid areas. Crosses, ticks and dots are ink like all other: nothing stops the head.

Source: our own (see `tracer.ink`); patent ES 361967 has one contour to a tape.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from morfax.motion.faults import LineFault
from morfax.motion.long_array import filed
from morfax.tracer.drawing.components import Mask
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.memory import give_back
from morfax.tracer.drawing.shapes_among_lines import has_lines
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.bare import Thinned
from morfax.tracer.ink.chains import Junctions
from morfax.tracer.ink.ledger import balance
from morfax.tracer.ink.left_out import InkLeft, ink_left
from morfax.tracer.ink.put_down_again import put_down_again
from morfax.tracer.ink.ring import stroke_round
from morfax.tracer.ink.solving import solved
from morfax.tracer.ink.stretches import FeltSheet
from morfax.tracer.ink.struck_off import struck_off
from morfax.tracer.ink.track import InkStroke, stroke_along
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.against_ink.strokes_off_ink import strokes_off_ink
from morfax.tracer.program.against_ink.unexplained import Unexplained, is_about
from morfax.tracer.program.as_contours import as_contours
from morfax.tracer.program.laid.bent import bent
from morfax.tracer.program.laid.line_parts import back_along, is_clear
from morfax.tracer.program.laid.narrow_bays import beside_mended
from morfax.tracer.program.laid.small_loops import Loop, SmallLoops
from morfax.tracer.program.lines import stroke_order
from morfax.tracer.program.lines.small_rings import SmallPatch, filled_up
from morfax.tracer.program.program import Trace
from morfax.tracer.program.setup import HeadProgress, Setup
from morfax.tracer.program.trace_solids import of_silhouettes, with_outlines

SOLVED = 0.3  # of the time until all is followed junctions are solved first; measured on heavy sheets
NEWEST_BYTES = 8_000_000  # of the newest strokes are kept in memory, 0.8 m at 10 mm/s; chosen


def trace_ink(
    drawing: Drawing,
    settings: Settings | None = None,
    operator: Operator | None = None,
    progress: HeadProgress | None = None,
) -> Trace:
    """Follow every stretch of line of a drawing, each once; lettering if it is as high as the operator says.

    `progress` hears how far the head has come and the length of all the ink, mm. Raises LineFault if the head
    can be put down nowhere, DrawingFault for silhouettes that have no edges.
    """
    settings, operator = settings or Settings(), operator or Operator()
    if drawing.both and not has_lines(drawing):
        return of_silhouettes(drawing, settings, operator, progress)
    left = ink_left(drawing.sheet, operator.letters_from_mm)
    give_back()
    trace = _of_strokes(drawing.sheet, left, settings, progress)
    if drawing.both:
        trace = with_outlines(trace, drawing, left, settings)
    return replace(trace, operator=operator)


def _of_strokes(
    sheet: Sheet, left: InkLeft, settings: Settings, progress: HeadProgress | None
) -> Trace:
    """Follow every stretch of the ink that is left for strokes."""
    # 1. the lines and their junctions, and the head along each
    felt = FeltSheet.of(
        left.drawing, settings, left.ink, _letters(sheet, left), are_strokes=True
    )
    give_back()
    loops = SmallLoops(sheet, settings)
    run = _strokes(solved(felt, _told_of(progress)), settings, progress)
    strokes = _long_enough(_kept(_mended(loops, run)))
    strokes = struck_off(sheet.drawing, strokes, felt.shared_mm)
    give_back()
    thinned = Thinned.of(sheet, felt.graph, left)
    strokes += put_down_again(felt, thinned, strokes, settings)
    felt = felt.without_cells()
    give_back()
    if not strokes:
        raise LineFault(
            "no line can be begun: the ink on the sheet is too short, or is filled shapes; follow the edges"
            " of these with --edge, or scan at a higher resolution"
        )
    # 2. the longest first, and in an order with short idle ways
    strokes.sort(key=lambda stroke: -stroke.length_mm)
    setup = Setup(sheet, settings, Operator(marks="off"))
    lines = [_line(stroke, k) for k, stroke in enumerate(strokes, 1)]
    lines, broad = as_contours(setup, lines)
    lines, beside = beside_mended(setup, bent(setup, lines))
    broad += _slots_left(setup, lines)
    setup.sheet.seen.clear()
    give_back()
    off = strokes_off_ink(left.drawing, lines, settings.gap_mm)
    broad += [place for place in off if not is_about(place, beside, lines)]
    left_over = sorted((*beside, *broad), key=lambda place: -place.length_mm)
    ink = balance(sheet, felt, thinned, left, [line.xy_mm for line in lines])
    in_order = tuple(_in_order(lines))
    return Trace(
        in_order, Operator(), left_out_mm=ink.left_mm, ink=ink, unexplained=tuple(left_over)
    )


def _letters(sheet: Sheet, left: InkLeft) -> Mask | None:
    """The lettering of a sheet; None if there is none."""
    if not left.lettering.any():
        return None
    rows, columns = left.packed_ink.shape
    return sheet.patches.painted(left.lettering, 0, rows, 0, columns)


def _slots_left(setup: Setup, lines: Sequence[Line]) -> Iterator[Unexplained]:
    """What is most likely a slot whose sides run together, and is none that was laid."""
    if not is_clear(setup.sheet.drawing):
        return
    sheet = setup.sheet
    laid = {sheet.patch_at(line.xy_mm[0]) for line in lines if line.ending == "closed"}
    for patch in filled_up(sheet):
        if patch not in laid:
            place_mm, across_mm, *_ = SmallPatch.of(sheet, patch)
            yield Unexplained(place_mm, across_mm, "broad")


def _told_of(progress: HeadProgress | None) -> Callable[[float], None] | None:
    """Who hears how many of the junctions are solved, a share; None if nobody listens."""
    return None if progress is None else lambda share: progress(SOLVED * share, 1.0)


def _strokes(
    junctions: Junctions, settings: Settings, progress: HeadProgress | None
) -> Iterator[InkStroke]:
    """The strokes of a net, one chain of lines after the other."""
    all_mm, before_mm = sum(line.length_mm for line in junctions.net.lines), 0.0

    def told(come_mm: float) -> None:
        if progress is not None:
            come_mm = min(before_mm + come_mm, all_mm)
            progress(SOLVED * all_mm + (1 - SOLVED) * come_mm, all_mm)

    for chain in junctions.chains():
        stroke = stroke_round(chain, junctions, settings, told)
        stroke = stroke or stroke_along(chain, junctions, settings, told)
        before_mm += stroke.length_mm
        told(0.0)
        yield stroke


def _mended(loops: SmallLoops, strokes: Iterator[InkStroke]) -> Iterator[InkStroke]:
    """Strokes as they are; small loops that fail their ink as the compass lays them, also in place of all
    strokes of a patch along which none closes.
    """
    whole = dict[int, Loop | None](loops.slots)
    yield from map(_of_loop, loops.slots.values())
    for stroke in strokes:
        patch = loops.sheet.patch_at(stroke.way_mm[0])
        if patch not in whole:
            whole[patch] = None if stroke.closed else loops.of_patch(patch, stroke.width_mm)
            if (loop := whole[patch]) is not None:
                yield _of_loop(loop)
        if whole[patch] is None:
            own = loops.of_way(stroke.way_mm, stroke.width_mm) if stroke.closed else None
            whole[patch] = own  # it is all of the patch: no other stroke runs along it again
            yield stroke if own is None else _of_loop(own)


def _of_loop(loop: Loop) -> InkStroke:
    """A loop as a stroke."""
    return InkStroke(loop.way_mm, loop.length_mm, True, loop.width_mm, loop.led)


def _kept(strokes: Iterable[InkStroke]) -> list[InkStroke]:
    """All strokes; the ways of many are kept in files, as that of a long one is."""
    kept, newest = list[InkStroke](), list[InkStroke]()
    for stroke in strokes:
        newest.append(stroke)
        if sum(each.way_mm.nbytes for each in newest) > NEWEST_BYTES:
            ways = filed([each.way_mm for each in newest])
            kept += [each._replace(way_mm=way) for each, way in zip(newest, ways, strict=True)]
            newest.clear()
            give_back()
    return kept + newest


def _long_enough(strokes: list[InkStroke]) -> list[InkStroke]:
    """The strokes without those that are shorter than the lines are wide: they lie within others' ink."""
    if not strokes:
        return strokes
    lengths_mm = np.array([stroke.length_mm for stroke in strokes])
    widths_mm = np.array([stroke.width_mm for stroke in strokes])
    usual_mm = float(np.average(widths_mm, weights=lengths_mm))
    long = [stroke for stroke, mm in zip(strokes, lengths_mm, strict=True) if mm > usual_mm]
    return long or strokes


def _line(stroke: InkStroke, number: int) -> Line:
    """A stroke as a line of the program."""
    ending = "closed" if stroke.closed else "ended"
    return Line(
        stroke.way_mm,
        ending,
        stroke.width_mm,
        stroke.length_mm,
        number=number,
        led=stroke.led,
    )


def _in_order(lines: list[Line]) -> list[Line]:
    """The strokes in an order with a short idle way, open ones begun at either end."""
    begins = np.array([line.begin_mm for line in lines])
    ends = np.array([line.end_mm for line in lines])
    way, turned = stroke_order.in_order(begins, ends)
    return [
        back_along(lines[n]) if about else lines[n]
        for n, about in zip(way, turned, strict=True)
    ]
