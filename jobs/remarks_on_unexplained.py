"""Remarks on places at which closed lines are not what is drawn.

Signals in: the traced lines. Signals out: one text for each kind of place, each with what to do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from morfax.tracer.program.program import Trace
    from morfax.tracer.program.unexplained import Kind, Unexplained

    Said = Callable[[Sequence[Unexplained], str], str]


def of_unexplained(trace: Trace) -> Iterator[str]:
    """Closed lines that may be other lines than those drawn, by what is there."""
    is_closed = any(line.ending == "closed" for line in trace.lines)
    for kind, said in SAID.items():
        places = [place for place in trace.unexplained if place.kind == kind]
        if places:
            yield said(places, "closed line" if is_closed else "line")


def _of_tips(places: Sequence[Unexplained], _: str) -> str:
    """Tips of filled shapes that the way cuts short."""
    (x, y), cut_mm = places[0][:2]
    many = _many(places, "tip", "tips")
    return (
        f"the path cuts {many} of the shape short, by up to {cut_mm:.2f} mm at {x:.1f},{y:.1f} mm; printed "
        "twice as large, and with --scale 0.5, by half of that"
    )


def _of_ink(places: Sequence[Unexplained], line: str) -> str:
    """Ink that is joined to the line, and beside its way."""
    (x, y), long_mm = places[0][:2]
    many = _many(places, "piece of ink", "pieces of ink")
    return (
        f"{many} joined to the {line} beside its way, up to {long_mm:.1f} mm from it, at "
        f"{x:.1f},{y:.1f} mm: a tip or a bay that is narrower than two lines, or another line; --picture "
        "marks it, and --lines all follows other lines too"
    )


def _of_bare(places: Sequence[Unexplained], _: str) -> str:
    """A way over bare paper."""
    (x, y), long_mm = places[0][:2]
    return (
        f"the closed line runs over {long_mm:.1f} mm of bare paper at {x:.1f},{y:.1f} mm, where no ink "
        "leads: look at --picture, and draw the line there"
    )


def _of_beside(places: Sequence[Unexplained], _: str) -> str:
    """A way beside its own ink."""
    (x, y), long_mm = places[0][:2]
    many = _many(places, "place", "places")
    return (
        f"the closed line runs beside its ink at {many}, the longest {long_mm:.1f} mm at {x:.1f},{y:.1f} mm: "
        "look there in --picture; a notch or a tongue that is narrower than two lines is followed if it is "
        "drawn with a finer pen"
    )


def _of_broad(places: Sequence[Unexplained], _: str) -> str:
    """Strokes within ink that is as broad as two lines."""
    (x, y), long_mm = places[0][:2]
    pieces = "piece of ink is" if len(places) == 1 else "pieces of ink are"
    return (
        f"{len(places)} {pieces} about as broad as two lines, the longest {long_mm:.1f} mm at "
        f"{x:.1f},{y:.1f} mm: if it is a slot, a notch or a tongue, its two sides are not followed; draw it "
        "with a finer pen, or scan it at a higher resolution"
    )


def _of_pale(places: Sequence[Unexplained], _: str) -> str:
    """A way over pale pixels of a coarse scan."""
    (x, y), dpi = places[0].place_mm, places[0].wants_dpi
    many = _many(places, "place", "places")
    return (
        f"not sure that the closed line is the one drawn: the pixels are too large to tell at {many}, the "
        f"first at {x:.1f},{y:.1f} mm, where a spike or a bay may be cut off; scan at {dpi} dpi"
    )


def _many(places: Sequence[Unexplained], one: str, several: str) -> str:
    """How many places there are, in words."""
    return f"1 {one}" if len(places) == 1 else f"{len(places)} {several}"


SAID: dict[Kind, Said] = {
    "tip": _of_tips,
    "ink": _of_ink,
    "bare": _of_bare,
    "beside": _of_beside,
    "broad": _of_broad,
    "pale": _of_pale,
}
