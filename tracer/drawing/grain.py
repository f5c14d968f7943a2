"""Grain: the line of a pencil on rough paper, of chalk or a dry pen, seen through a slit along the line.

Signals: darkness of a sheet (0 paper, 1 ink) in; the same behind the slit out, if the ink has grain.

A pencil leaves ink on the paper's high places only. Across the line that hides the edges, and a spot small
enough to see them sees gaps. A slit as long as the line is straight averages the grain and keeps the edges:

         ▓▓░▓ ░▓▓░ ▓▓▓
        ════╪═════╪════
         ░▓▓▓░▓▓ ▓░▓▓▓

Source: our own. Questions: strokes that bend tighter than the slit is long lose more by it than grain did
(see `mends`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing import coarse
from morfax.tracer.drawing.components import INK, SOFTENED_PX
from morfax.tracer.drawing.slit import FINEST_PX, Slit, behind
from morfax.tracer.limits import USUAL_WIDTH_MM

if TYPE_CHECKING:
    from morfax.tracer.drawing.noise import Within
    from morfax.tracer.drawing.tiles import Kept

Darkness = NDArray[np.float32]

# Chosen by trial on `python -m benchmarks pencil`.
LEAST_GRAIN = 0.15  # standard deviation of the ink's darkness; a clean scan has 0.02
# half of the strokes may be dry, as of a worn marker: the ink of all then has this, and the slit has to leave
# no more than this share of its pieces
LEAST_OF_SOME, JOINED = 0.08, 0.5
ENOUGH_TIMES = 2.0  # finer pixels, of lines that look 1.5 pixels wide or more
ALONG_WIDTHS = 0.8  # of the slit, standard deviation, ...
ALONG_MM = ALONG_WIDTHS * USUAL_WIDTH_MM  # ... at least
ACROSS_WIDTHS = 0.12


class Averaged(NamedTuple):
    """A sheet seen through the slit: its darkness, that as it was drawn, and what to tell."""

    darkness: Darkness
    drawn: Darkness
    note: str


def slit_for(grain: float, width_px: float, pitch_mm: float) -> Slit | None:
    """The slit that lines of a grain and width ask for; None without grain, and for too thin lines."""
    if not (grain > LEAST_OF_SOME and width_px > coarse.FEWEST_PX):
        return None
    along_px = max(ALONG_MM / pitch_mm, ALONG_WIDTHS * width_px)
    return Slit(along_px, max(ACROSS_WIDTHS * width_px, FINEST_PX), width_px)


def reach_mm(width_mm: float) -> float:
    """How far from a corner the slit for lines of a width rounds them, mm: two of its standard deviations."""
    return 2 * max(ALONG_MM, ALONG_WIDTHS * width_mm)


def _note(slit: Slit, pitch_mm: float) -> str:
    """What the operator should know of a sheet that is seen through the slit."""
    long_mm = 2 * slit.along_px * pitch_mm
    return (
        f"the lines have grain, as of a pencil: they are averaged over {long_mm:.1f} mm along each line, "
        "and corners may be off by some 0.1 mm; lines that are inked over are followed more exactly"
    )


def notes_of_few_pixels(lines: Within, drawn_grain: float, pitch_mm: float) -> tuple[str, ...]:
    """What the operator should know of lines that are few pixels wide, with grain or without."""
    if lines.seen_px < coarse.SEEN_PX:
        return (coarse.note(lines.seen_px, pitch_mm),)
    if not drawn_grain > LEAST_GRAIN or lines.width_px > coarse.FEWEST_PX:
        return ()
    return (
        f"the lines have grain, as of a pencil, and are fewer than {coarse.FEWEST_PX:g} pixels wide, so that "
        "it is not averaged: the path strays by up to a line's width; scan at "
        f"{coarse.finer_dpi(pitch_mm, ENOUGH_TIMES)} dpi, or ink the lines over",
    )


def averaged(
    darkness: Kept, drawn_grain: float, width_px: float, pitch_mm: float
) -> Averaged | None:
    """The sheet as seen through the slit, where lines of a grain and width ask for it and it mends them."""
    slit = slit_for(drawn_grain, width_px, pitch_mm)
    if slit is None:
        return None
    drawn = np.asarray(darkness)
    seen = behind(slit, drawn)
    if not mends(drawn, seen, drawn_grain):
        return None
    return Averaged(seen, drawn, _note(slit, pitch_mm))


def mends(before: Darkness, after: Darkness, grain: float) -> bool:
    """Whether the ink of a sheet hangs together as well behind the slit as before; far better, if only some
    of its strokes have grain.

    Grain parts a line, and the slit joins it. Where it parts more than it joins, strokes are pressed harder
    and softer, or bend tighter than the slit is long; that is no grain.
    """
    share = 1.0 if grain > LEAST_GRAIN else JOINED
    return _pieces(after) <= share * _pieces(before)


def _pieces(darkness: Darkness) -> int:
    """How many pieces the ink is in."""
    soft = cv2.GaussianBlur(darkness, (0, 0), SOFTENED_PX)
    return int(cv2.connectedComponents((soft > INK).view(np.uint8), connectivity=8)[0])
