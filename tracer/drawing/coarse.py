"""Coarse scans: a line of fewer than three pixels is laid out on pixels half as large.

Signals: darkness of a sheet and the width of its lines (pixels) in; how many times finer it is to be, and the
darkness on the finer pixels, out.

The head's sizes have a least number of pixels (see `head.settings`): at 2 pixels a line of 0.5 mm would be
felt for 3 mm to tell its direction, and every detail below that would be cut off. A scanner's lens leaves
nothing finer than its pixels, so the darkness between them is known: a windowed sinc gives it back.

Scans of two levels, and engravings that were made small, have steps at their edges that no lens has softened,
and gaps of a pixel. A wider aperture makes up for that.

Down to a width of 1.25 pixels outlines of 0.5 mm with slots, spikes and bays of 1.5 mm and more were right or
told in 60 of 60, at 1 pixel in 240 of 240: there the ink of each way is held against the scan's (see
`program.against_ink.redrawn`). The operator is warned of lines that look as wide as 1.5 pixels or less: how
wide they are cannot be told more closely, so nothing is refused: most paths on lines of 1 pixel are right.

Source: Lanczos' window, eight pixels across, as OpenCV has it. Questions: noise is spread as well, and the
head averages less of it: 1 um RMS on smooth lines.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing.blocks import BLOCK_PX, darkest
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.contrast import DARKER
from morfax.tracer.drawing.two_levels import with_rims
from morfax.tracer.limits import DETAIL_PX, PAPER

if TYPE_CHECKING:
    from morfax.tracer.drawing.noise import Within

Darkness = NDArray[np.float32]

# of a line's width as it is measured (2.7 by the pen): below, the head sees too few pixels between its edges
FEWEST_PX = 2.9
TIMES = 2  # three times finer is no better: the same details, 1 um more RMS
# of a pixel: standard deviation of the aperture; at 0.35 the gaps of small engravings stay open; by trial
APERTURE_PX = 0.6
BETWEEN = 0.03  # share of pixels that are neither paper nor ink, on a hard picture
MOST_PX = 1 << 22  # of a sheet, before: large sheets are no coarse scans, and need the memory
# pixels, as `noise.Within` says: a line of 1.5 looks 1.8 to 2.12 wide, one of 2 looks 2.16 or more; by trial
SEEN_PX = 2.14
DPI_STEP = 50  # of the resolutions that are advised


def times_finer(darkness: Darkness, width_px: float) -> int:
    """How many times finer the pixels of a sheet are to be; NaN is a sheet without any line."""
    is_coarse = math.isfinite(width_px) and width_px < FEWEST_PX
    return TIMES if is_coarse and darkness.size <= MOST_PX else 1


def finer(darkness: Darkness, times: int, seen_px: float = math.inf) -> Darkness:
    """The darkness behind a wider aperture, on pixels so many times finer; of lines that look so wide.

    The aperture leaves little more than half of the darkness of a hard line of a pixel, and less where pixels
    touch by their corners only: such ink is as dark as before.
    """
    soft = np.asarray(cv2.GaussianBlur(darkness, (0, 0), APERTURE_PX), np.float32)
    if seen_px < SEEN_PX and is_hard(darkness):
        soft /= _left_of(darkness, soft)
    larger = cv2.resize(soft, None, fx=times, fy=times, interpolation=cv2.INTER_LANCZOS4)
    return np.asarray(larger, np.float32)


def without_steps(
    darkness: Any, lines: Within, darkest_there: Darkness | None
) -> tuple[Any, int, bool]:
    """Darkness of which the head feels no pixel as a step, how many times finer its pixels are, and whether
    rims were laid through them (`two_levels`); of a sheet that has steps the darkest of its blocks is given.
    """
    finer_times = times_finer(darkness, lines.width_px)
    if finer_times > 1:
        return finer(np.asarray(darkness), finer_times, lines.seen_px), finer_times, False
    if darkest_there is None:
        return darkness, 1, False
    return with_rims(np.asarray(darkness), darkest_there), 1, True


def wanted_dpi(pitch_mm: float) -> int:
    """The resolution that is enough where lines are a pixel wide."""
    return finer_dpi(pitch_mm, math.ceil(FEWEST_PX))


def finer_dpi(pitch_mm: float, times: float) -> int:
    """The resolution, as one advises it, at which pixels of a pitch are so many times finer."""
    return DPI_STEP * math.ceil(times * MM_PER_INCH / pitch_mm / DPI_STEP)


def at_dpi(dpi: int, *, is_rendered: bool) -> str:
    """How the operator comes to a drawing at a resolution."""
    return f"give --dpi {dpi}" if is_rendered else f"scan at {dpi} dpi"


def note(seen_px: float, pitch_mm: float) -> str:
    """What the operator should know of lines that look so wide."""
    return (
        f"the lines look {seen_px:.1f} pixels wide, as lines of 1.5 pixels and less do: details below "
        f"{DETAIL_PX * pitch_mm:.2g} mm may be cut off, and the path strays where lines touch; scan at "
        f"{wanted_dpi(pitch_mm)} dpi, or save the drawing that much larger"
    )


def is_hard(darkness: Darkness, darkest_there: Darkness | None = None) -> bool:
    """Whether pixels are paper or ink, and hardly any lies between: no lens has softened the lines.

    The darkest of the sheet's blocks is told where it is known.
    """
    most = darkest(darkness) if darkest_there is None else darkest_there
    not_paper, between = _counts(darkness, most > PAPER)
    return bool(not_paper and between / not_paper < BETWEEN)


@njit(cache=True)
def _counts(darkness, are_asked):  # type: ignore[no-untyped-def]
    """How many pixels of some blocks are not paper, and how many of these are not ink either."""
    paper, ink = np.float32(PAPER), np.float32(1 - PAPER)
    not_paper = between = 0
    for i in range(len(are_asked)):
        for j in np.flatnonzero(are_asked[i]):
            rows = darkness[i * BLOCK_PX : (i + 1) * BLOCK_PX]
            for row in rows:
                for seen in row[j * BLOCK_PX : (j + 1) * BLOCK_PX]:
                    not_paper += seen > paper
                    between += paper < seen < ink
    return not_paper, between


def _left_of(darkness: Darkness, soft: Darkness) -> np.float32:
    """How dark ink of darkness 1 is behind the aperture."""
    return np.float32(np.percentile(soft[darkness > INK], DARKER))
