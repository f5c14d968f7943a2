"""Remarks on the ink of a traced drawing: what of it was not followed, taken for a mark, or is not the line.

Signals in: the traced lines. Signals out: texts, each with what to do.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from morfax.jobs.remarks.on_survey import of_letters
from morfax.jobs.remarks.on_unexplained import of_unexplained
from morfax.motion.by_number import numbered

if TYPE_CHECKING:
    from morfax.tracer.following.line import Line
    from morfax.tracer.ink.ledger import Balance, Patch
    from morfax.tracer.program.lines.small_rings import SmallPatch
    from morfax.tracer.program.program import Trace

# chosen by trial on the test drawings
LEFT_SHARE = 0.01  # of all the ink: more that was not followed is worth a remark
# of the ink that is joined to a line: if the line is less, the rest is worth a remark
FEW_SHARE = 0.7
ENDED_SHARE = 0.9  # the same of a line that ended; one that was followed all along was 0.96 of it and more
AS_LONG = 0.03  # of a line's length: lengths by the ink of a patch are true to that
# an edge that strays further is rough: clean outlines of seven parts stray by 0 to 8 um, at 150 to
# 600 dpi, quiet or noisy
ROUGH_MM = 0.015


def of_ink(trace: Trace, *, several: bool) -> Iterator[str]:
    """Remarks on the ink of a sheet of which one line was asked for, or several."""
    yield from _of_all(trace)
    yield from _of_solids(trace)
    yield from _of_rough_edges(trace)
    yield from _of_lost_outlines(trace)
    yield from _of_unread(trace)
    yield from _of_letters(trace)
    yield from _of_small_rings(trace)
    yield from _of_joined(trace)
    alone = not several and trace.fault is None
    rest = tuple(_of_rest(trace.lines[0])) if alone else ()
    yield from rest
    if alone:
        yield from _of_others(trace)
    if not rest:
        yield from of_unexplained(trace)


def _of_all(trace: Trace) -> Iterator[str]:
    """Ink that was left out, where all of it was asked for."""
    if trace.ink is None:
        return
    left = trace.ink.left_mm / trace.ink.all_mm
    if left > LEFT_SHARE:
        yield (
            f"{trace.ink.left_mm:.0f} mm of ink ({100 * left:.0f} %) could not be followed"
            f"{_places(trace.ink.lost)}: stretches that are too short or too unclear to put the head down; "
            "scan at a higher resolution"
        )
    single = trace.ink.single_mm / trace.ink.all_mm
    if single > LEFT_SHARE:
        x, y, long_mm = trace.ink.single[0]
        yield (
            f"{trace.ink.single_mm:.0f} mm of ink ({100 * single:.0f} %) look like two lines nearer to each "
            f"other than a pen's width, and one stroke runs there (the longest, {long_mm:.0f} mm, about "
            f"{x:.1f},{y:.1f} mm; --picture marks them): if two lines are meant, draw them further apart or "
            "with a finer pen"
        )
    pale = trace.ink.pale_mm / trace.ink.all_mm
    if pale > LEFT_SHARE:
        x, y, _ = trace.ink.pale[0]
        yield (
            f"{trace.ink.pale_mm:.0f} mm of line ({100 * pale:.0f} %) are left out: less than half as dark "
            f"as the rest, or hardly a pixel wide (the longest at {x:.1f},{y:.1f} mm); if they belong to the "
            "drawing, and are no print of the paper, scan at a higher resolution, or raise its contrast "
            "until they are black too"
        )
    yield from _of_areas(trace.ink)
    if trace.ink.solid_mm > 0:
        yield (
            f"{trace.ink.solid_mm:.0f} mm of ink are the rims of filled shapes, and left out; --edge follows "
            "the outlines of filled shapes"
        )


def _places(lost: Sequence[Patch]) -> str:
    """Where the stretches are that were left, and where to find them."""
    if not lost:
        return ", in stretches too short to list"
    x, y, long_mm = lost[0]
    return (
        f" (the longest stretch, {long_mm:.1f} mm, at {x:.1f},{y:.1f} mm; the figures list it and the other "
        "long ones, and --picture marks them)"
    )


def _of_areas(ink: Balance) -> Iterator[str]:
    """Solid areas and letters among lines that were left out."""
    solids = ink.solids
    if solids:
        are = "1 solid area is" if len(solids) == 1 else f"{len(solids)} solid areas are"
        large_mm2 = sum(area.area_mm2 for area in solids)
        x, y = solids[0].place_mm
        largest_mm2 = solids[0].area_mm2
        advice = (
            "an outline needs an area of 1 mm across, whole on the sheet: scan it with paper all round, or "
            "a larger print, with --scale"
            if ink.outlines_asked
            else "--lines all --edge goes round their outlines"
        )
        yield (
            f"{are} broader than a line, and left out ({large_mm2:.0f} mm2; the largest, "
            f"{largest_mm2:.1f} mm2, at {x:.1f},{y:.1f} mm): {advice}"
        )
    if ink.dots:
        x, y, across_mm = ink.dots[0]
        are = "1 dot is" if len(ink.dots) == 1 else f"{len(ink.dots)} dots are"
        yield (
            f"{are} broader than two lines, and left out (the largest, {across_mm:.1f} mm across, at {x:.1f},"
            f"{y:.1f} mm): to have one in the program, draw it as a ring"
        )
    if ink.letters_mm > 0:
        yield (
            f"{ink.letters_mm:.0f} mm of ink are lettering, and left out; --lettering all follows it"
        )


def _of_solids(trace: Trace) -> Iterator[str]:
    """A line in the rim of a filled shape."""
    solid = [line for line in trace.lines if line.is_solid]
    if solid:
        x, y = solid[0].start_mm
        yield (
            f"the ink at {x:.1f},{y:.1f} mm is the rim of a dark area broader than a line: if that is a "
            "filled "
            "shape, --edge follows its outline, and --lines all --edge the lines beside it too"
        )


def _of_rough_edges(trace: Trace) -> Iterator[str]:
    """Edges that stray from their own smooth way."""
    rough = [line for line in trace.lines if (line.roughness_mm or 0.0) > ROUGH_MM]
    if rough:
        worst = max(rough, key=lambda line: line.roughness_mm or 0.0)
        what = "the edge is" if len(trace.lines) == 1 else f"the edge of line {worst.number} is"
        yield (
            f"{what} rough: within 3 mm it strays by {worst.roughness_mm:.3f} mm (standard deviation) from a "
            "smooth way, and the path follows it; if that is the pen or the print, and not the shape, draw "
            "it twice as large with the same pen, and with --scale 0.5 the path strays half as far"
        )


def _of_lost_outlines(trace: Trace) -> Iterator[str]:
    """Outlines that were left out, as the head was lost on them."""
    lost = trace.lost_outlines
    if not lost:
        return
    are, them = (
        ("1 outline is", "it") if len(lost) == 1 else (f"{len(lost)} outlines are", "them")
    )
    (x, y), longest_mm = lost[0]
    all_mm = sum(outline.length_mm for outline in lost)
    yield (
        f"{are} left out, {all_mm:.0f} mm in all: too small or too fine for the head, which was lost on "
        f"{them} (the longest, {longest_mm:.1f} mm, at {x:.1f},{y:.1f} mm; the figures list all, --picture "
        f"marks them); the other outlines are whole: look whether the part can do without {them}"
    )


def _of_unread(trace: Trace) -> Iterator[str]:
    """Ticks and dots that were taken for ink."""
    if trace.unread and trace.operator.marks == "auto":
        what = "1 tick or dot" if trace.unread == 1 else f"{trace.unread} ticks and dots"
        yield (
            f"{what} did not stop the head: without a reference point or a card they are ink; "
            "if they are stops or holes, give --marks on"
        )


def _of_letters(trace: Trace) -> Iterator[str]:
    """Contours that are likely letters, followed or left out."""
    if trace.letters_out:
        high_mm = trace.operator.letters_from_mm
        low = f" lower than {high_mm:g} mm" if math.isfinite(high_mm) else ""
        yield (
            f"{numbered('line', list(trace.letters_out))} likely lettering{low}, and left out; --lettering "
            "all follows it"
        )
    yield from of_letters(list(trace.letters))


def _of_small_rings(trace: Trace) -> Iterator[str]:
    """Lines that are too small to be contours, and may be holes."""
    rings = trace.small_rings
    if rings:
        many = (
            "1 small closed line is"
            if len(rings) == 1
            else f"{len(rings)} small closed lines are"
        )
        yield (
            f"{many} left out, too short for a contour ({_largest(rings)}): --lines all follows all ink"
        )
    filled = [patch for patch in trace.unclear if patch.is_filled]
    lines = [patch for patch in trace.unclear if not patch.is_filled]
    if filled:
        many = "1 filled shape is" if len(filled) == 1 else f"{len(filled)} filled shapes are"
        yield (
            f"{many} left out ({_largest(filled)}): --lines all --edge follows the outlines of filled shapes "
            "and the lines beside them"
        )
    if lines:
        many = "1 line is" if len(lines) == 1 else f"{len(lines)} lines are"
        yield (
            f"{many} left out, so small or narrow that the head can nowhere be put down "
            f"({_largest(lines)}): draw it larger or with a finer pen"
        )


def _largest(patches: Sequence[SmallPatch]) -> str:
    """The first of some patches in words: they are sorted by size."""
    (x, y), across_mm = patches[0].place_mm, patches[0].across_mm
    return f"the largest, {across_mm:.1f} mm across, at {x:.1f},{y:.1f} mm"


def _of_joined(trace: Trace) -> Iterator[str]:
    """Ink that is joined to contours, and of which no run of the head has made a line."""
    if trace.ink is None and trace.left_out_mm > LEFT_SHARE * trace.length_mm:
        yield (
            f"about {trace.left_out_mm:.0f} mm of ink that is joined to the contours was not followed: "
            "bars between them, or lines that run too close to them; --lines all follows all of it"
        )


def _of_rest(line: Line) -> Iterator[str]:
    """One line that is the smaller part of the ink in which lines cross or touch, or ended in that."""
    share = ENDED_SHARE if line.ending == "ended" else FEW_SHARE
    if line.length_mm < share * line.ink_mm:
        yield (
            f"about {line.ink_mm - line.length_mm:.0f} mm of ink that is joined to the line was not "
            "followed: "
            "--lines all also follows the lines that cross or touch it, --start X,Y another one"
        )


def _of_others(trace: Trace) -> Iterator[str]:
    """Further lines of the sheet, where one was traced and nobody said which."""
    others = trace.others
    if others.lines:
        one = others.lines == 1
        lines = "1 other line" if one else f"{others.lines} other lines, the longest"
        is_longer = others.longest_mm > (1 + AS_LONG) * trace.length_mm
        longer = ", longer than this one" if is_longer else ""
        are = "inside it" if one else f"{others.inside} of them inside it"
        inside = f", {are}" if others.inside else ""
        yield (
            f"one line of {trace.length_mm:.0f} mm is traced; the sheet has {lines} of about "
            f"{others.longest_mm:.0f} mm{longer}{inside}: --lines contours cuts a part with its holes, "
            "holes first, --lines all traces every stretch of line, and `morfax lines` lists them"
        )
