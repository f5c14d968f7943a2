"""Small pictures of many drawings: the sheet in grey with the traced line on it, and how much ink it follows.

Signals in: a traced drawing. Signals out: a PNG of at most `LARGEST_PX` pixels, within some milliseconds (the
pages of `overlay`, with axes and words, take a third of a second); the share of the ink's pixels on that
picture that lie within half a line's width, and one pixel, of the head's path.

Source: our own. Questions: ink that no line is, such as lettering, counts as ink that was not followed.
"""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import FileFault
from morfax.motion.files import written_beside
from morfax.reports.canvas import LIGHT
from morfax.reports.pixels import SHIFT

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from morfax.jobs.trace import TraceResult
    from morfax.tracer.drawing.drawing import Drawing

LARGEST_PX = 800
INK = 0.5  # darkness from which a pixel is ink: half way between paper and line
PAPER, GREYS = 0.12, 12  # what is lighter is paper, and so many greys: noise makes a file large
LINE_BGR = (33, 18, 193)


def draw_small(result: TraceResult, file: FilePath) -> None:
    """Draw the path over the drawing (.png)."""
    import cv2

    darkness, scale = _reduced(result.drawing)
    darkness[darkness < PAPER] = 0.0
    grey = 255 - np.floor(GREYS * np.clip(darkness, 0, 1)) / GREYS * 255 / LIGHT
    picture = cv2.cvtColor(grey.astype(np.uint8), cv2.COLOR_GRAY2BGR)
    places = [_pixels(run, result.drawing, scale) for run in result.traced.path.runs()]
    cv2.polylines(picture, places, False, LINE_BGR, 2, cv2.LINE_AA, SHIFT)
    _save(picture, file)


def draw_sheet(pixels: NDArray[Any], file: FilePath) -> None:
    """Draw a sheet on which nothing was traced: levels 0..255, or colours."""
    import cv2

    scale = min(1.0, LARGEST_PX / max(pixels.shape[:2]))
    small = cv2.resize(pixels, _size(pixels, scale), interpolation=cv2.INTER_AREA)
    small = small.astype(np.uint8)
    _save(small if small.ndim == 2 else small[..., ::-1], file)


def followed_share(result: TraceResult) -> float | None:
    """The share of the ink that lies under the path of the head; None on a sheet without ink."""
    import cv2

    darkness, scale = _reduced(result.drawing)
    inked = darkness > INK * darkness.max()
    if not inked.any():
        return None
    covered = np.zeros(inked.shape, np.uint8)
    for line in result.traced.trace.lines:
        width_px = line.width_mm / result.drawing.pitch_mm * scale
        place = _pixels(line.xy_mm, result.drawing, scale)
        cv2.polylines(covered, [place], False, 1, int(np.ceil(width_px)) + 2, shift=SHIFT)
    return float((covered.astype(bool) & inked).sum() / inked.sum())


def _reduced(drawing: Drawing) -> tuple[NDArray[np.float32], float]:
    """The darkness, reduced to what is drawn, and the scale of that."""
    import cv2

    scale = min(1.0, LARGEST_PX / max(drawing.darkness.shape))
    darkness = np.asarray(drawing.darkness)
    small = cv2.resize(darkness, _size(darkness, scale), interpolation=cv2.INTER_AREA)
    return np.asarray(small, np.float32), scale


def _size(pixels: NDArray[Any], scale: float) -> tuple[int, int]:
    """Columns and rows of a picture at a scale; a narrow strip keeps a row."""
    rows, columns = pixels.shape[:2]
    return max(1, round(scale * columns)), max(1, round(scale * rows))


def _pixels(xy_mm: Array, drawing: Drawing, scale: float) -> NDArray[np.int32]:
    """Places on the sheet, (n, 2) mm, as OpenCV takes them: pixel centres are whole numbers there."""
    rows = drawing.darkness.shape[0]
    columns = xy_mm[:, 0] / drawing.pitch_mm
    px = np.stack([columns, rows - xy_mm[:, 1] / drawing.pitch_mm], axis=1) * scale - 0.5
    return np.rint(px * (1 << SHIFT)).astype(np.int32)


def _save(picture: NDArray[Any], file: FilePath) -> None:
    """Write a picture whole or not at all."""
    import cv2

    made, data = cv2.imencode(".png", picture)
    if not made:
        raise FileFault(f"cannot write {file}: the picture could not be packed")
    with written_beside(file) as beside:
        beside.write_bytes(data.tobytes())
