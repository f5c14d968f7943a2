"""Remarks on places at which lines are not what is drawn.

Signals in: the traced lines. Signals out: one text for each kind of place, each with what to do.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from morfax.tracer.program.against_ink.unexplained import Kind, Unexplained
    from morfax.tracer.program.program import Trace


def of_unexplained(trace: Trace) -> Iterator[str]:
    """Lines that may be other lines than those drawn, by what is there."""
    is_closed = any(line.ending == "closed" for line in trace.lines)
    for kind in SAID:
        places = [place for place in trace.unexplained if place.kind == kind]
        if places:
            yield _said(kind, places, "closed line" if is_closed else "line")


def _said(kind: Kind, places: Sequence[Unexplained], line: str) -> str:
    """What is said of the places of a kind on a line, with the worst of them, which come first."""
    (one, several), text = SAID[kind]
    worst, further = places[0], places[1:3]
    many = f"1 {one}" if len(places) == 1 else f"{len(places)} {several}"
    at, *then = (f"{x:.1f},{y:.1f}" for (x, y), *_ in (worst, *further))
    at += f" mm (then {' and '.join(then)} mm)" if then else " mm"
    return text.format(many=many, at=at, mm=worst.length_mm, line=line, dpi=worst.wants_dpi)


# of each kind: one and several of its places, and the text, in which {mm} is what the worst place measures
SAID: dict[Kind, tuple[tuple[str, str], str]] = {
    # tips of filled shapes that the way cuts short
    "tip": (
        ("tip", "tips"),
        "the path cuts {many} of the shape short, by up to {mm:.2f} mm at {at}; printed twice as large, and "
        "with --scale 0.5, by half of that",
    ),
    # a way beside the edge of a filled shape
    "aside": (
        ("place", "places"),
        "the path is a part of a pixel beside the edge at {many}, the longest {mm:.1f} mm at {at}: pixels so "
        "large or hard draw it there; scan at a higher resolution, or save the picture with twice as many "
        "pixels",
    ),
    # ink that is joined to the line, and beside its way
    "ink": (
        ("piece of ink", "pieces of ink"),
        "{many} joined to the {line} beside its way, up to {mm:.1f} mm from it, at {at}: a tip or a bay that "
        "is narrower than two lines, or another line; --picture marks it, and --lines all follows other "
        "lines too",
    ),
    # a way over bare paper
    "bare": (
        ("", ""),
        "the closed line runs over {mm:.1f} mm of bare paper at {at}, where no ink leads: look at --picture, "
        "and draw the line there",
    ),
    # a way beside its own ink
    "beside": (
        ("place", "places"),
        "the path runs beside its ink at {many}, the longest {mm:.1f} mm at {at}: look there in "
        "--picture; a notch or a tongue that is narrower than two lines is followed if it is drawn with a "
        "finer pen",
    ),
    # a closed way that crosses itself where all is ink
    "crossed": (
        ("place", "places"),
        "the closed line crosses itself within its ink at {many}, the longest {mm:.1f} mm round at {at}: the "
        "ink of spikes that are narrower than two lines tells little of them; look there in --picture, and "
        "draw it with a finer pen",
    ),
    # a way within ink that is as broad as two lines or more
    "broad": (
        ("piece of ink is", "pieces of ink are"),
        "{many} as broad as two lines or more, the longest {mm:.1f} mm at {at}: if a broader pen has "
        "drawn it, the path is right; if it is a slot, a notch or a tongue, its two sides are not followed: "
        "draw it with a finer pen, or scan at a higher resolution",
    ),
    # strokes that leave ink, or go over paper, where lines meet
    "off": (
        ("place", "places"),
        "the strokes do not match the ink at {many}, the worst at {at}, for {mm:.1f} mm: a corner or an end "
        "in the ink of another line, or ink that is no line; look there in --picture, and draw it with a "
        "finer pen, or a little further from that line",
    ),
    # a way over pale pixels of a coarse scan
    "pale": (
        ("place", "places"),
        "not sure that the closed line is the one drawn: the pixels are too large to tell at {many}, the "
        "first at {at}, where a spike or a bay may be cut off; scan at {dpi} dpi",
    ),
}
