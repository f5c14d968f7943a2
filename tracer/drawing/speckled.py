"""Speckled lines: broad chalk, crayon or a dry brush, whose grain is far finer than its lines are wide.

    ▓░▓▓ ▓▓░▓▓▓        on the scan's pixels the ink is a net of specks and holes, and shows no line
    ▓▓ ▓░▓▓▓▓ ▓
    ▓░▓▓▓▓ ▓░▓▓        on pixels four times as large it is a line, six of them wide
    ▓▓▓ ▓▓░▓▓▓▓

The larger pixels are means of the scan's. They are taken where the scan's own show hardly a single line,
and where on the larger ones hardly a speck or a hole is left and the ink covers what it covered. The middle
of so broad a line is told by them as well: there are still as many as a line of a clean scan has.

Signals: the darkness of a sheet and what its lines look like in; how many times larger its pixels are to be,
and the grey levels on these, out.

Source: our own; a picture that is looked at in several sizes is the textbook's pyramid. Questions: of a sheet
with fine lines beside the speckled ones the pixels stay as they are, and the speckled ones come out in bits.
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.coarse import FEWEST_PX
from morfax.tracer.drawing.components import INK, SOFTENED_PX, Mask
from morfax.tracer.drawing.noise import Within, within
from morfax.tracer.drawing.paper import WIDEST_STROKE_MM
from morfax.tracer.effort import MANY

Darkness = NDArray[np.float32]

# Chosen by trial on made lines of 1.5 to 5 mm at 150 and 300 dpi, behind grain of one and two pixels.
TIMES = 2, 4, 8
ENOUGH_PX = 4.0  # of a line's width: with fewer it is followed, but half as exactly
# of the places on ink at which the scan shows a single line: of other sheets of lines 0.08 to 0.95
FEW = 0.05
LEFT = 0.15  # of the specks and holes may be left on larger pixels
# of the larger pixels' ink is ink on the scan: of hatching as dense as its gaps it is a half
FILLED = 0.65
BEYOND = 0.02  # of the scan's ink may lie farther out by a pixel: more are lines that are lost


def times_larger(darkness: Any, lines: Within, pitch_mm: float) -> int:
    """How many times larger the pixels of a sheet are to be whose lines look so; 1: as they are, also where
    what shows on larger ones is broader than any line.
    """
    if lines.single > FEW or not isinstance(darkness, np.ndarray):
        return 1
    ink = _ink(darkness)
    specks = _specks(ink)
    if specks < MANY:  # pieces and holes of the ink
        return 1
    widths_px = dict[int, float]()
    for times in TIMES:
        larger = on_larger_pixels(darkness, times)
        seen = _ink(larger)
        if _specks(seen) < LEFT * specks and _covers(seen, ink, times):
            width_px = within(larger).width_px
            if width_px * times * pitch_mm <= WIDEST_STROKE_MM:
                widths_px[times] = width_px
    # the largest pixels leave least of the grain, if the line has enough of them
    enough = [times for times, width_px in widths_px.items() if width_px > ENOUGH_PX]
    least = [times for times, width_px in widths_px.items() if width_px > FEWEST_PX]
    return max(enough or least, default=1)


def on_larger_pixels(picture: NDArray[Any], times: int) -> NDArray[Any]:
    """A picture on pixels so many times larger, which begin at its lower left corner; it is filled up above
    and to the right as its edges are.
    """
    above, right = (-size % times for size in picture.shape[:2])
    whole = cv2.copyMakeBorder(picture, above, 0, 0, right, cv2.BORDER_REPLICATE)
    size = whole.shape[1] // times, whole.shape[0] // times
    return np.asarray(cv2.resize(whole, size, interpolation=cv2.INTER_AREA))


def note(times: int, pitch_mm: float) -> str:
    """What the operator should know of a sheet whose pixels are taken so many times larger."""
    return (
        f"the ink is full of specks and holes, as of chalk, crayon or a noisy scan: {times} x {times} pixels "
        f"are taken as one of {times * pitch_mm:.2g} mm, and what is finer than that is not followed; of a "
        "filled shape --edge follows the outline"
    )


def _ink(darkness: Darkness) -> Mask:
    """Where a sheet is inked."""
    return np.asarray(cv2.GaussianBlur(darkness, (0, 0), SOFTENED_PX) > INK).view(np.uint8)


def _specks(ink: Mask) -> int:
    """How many pieces the ink is in, and how many areas of paper it leaves."""
    pieces = cv2.connectedComponents(ink, connectivity=8)[0]
    return int(pieces + cv2.connectedComponents(1 - ink, connectivity=4)[0])


def _covers(larger: Mask, ink: Mask, times: int) -> bool:
    """Whether ink on pixels so many times larger covers about what the ink covers."""
    near = np.asarray(cv2.dilate(larger, np.ones((3, 3), np.uint8)), np.uint8)
    covers, reaches = (_on_scan(mask, ink, times) for mask in (larger, near))
    filled = np.count_nonzero(ink & covers)
    beyond = np.count_nonzero(ink & (1 - reaches))
    return bool(
        filled > FILLED * np.count_nonzero(covers) and beyond < BEYOND * np.count_nonzero(ink)
    )


def _on_scan(larger: Mask, ink: Mask, times: int) -> Mask:
    """A mask of larger pixels on the scan's."""
    rows, columns = ink.shape
    return np.repeat(np.repeat(larger, times, axis=0), times, axis=1)[-rows:, :columns]
