"""Coloured paper: each colour channel of a picture is held against the paper's own.

On brown paper the blue channel is the darkest one, and in that channel a white label stands out more than ink
does: the lines would be taken for light ones on dark paper, and the ink left out.

         ┌──────────── 255        red    ink  95 below the paper of 207
      ───┴───┐    ┌───                                                    each channel times 207 over its own
             └────┘    0          blue   ink  60 below the paper of  95   paper: ink is as dark in all of them

On a blueprint the lines are lighter than the paper, and blue is the lightest channel by far: brought up to
it, red and green would be noise. So the lines have to be darker than the paper in its lightest channel (see
`polarity`); a white label can hardly stand out there.

Signals: an image in; levels (768,), 256 for each of red, green and blue, out, or None on paper that is grey,
white or dark, or bears light lines.

Source: our own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from morfax.tracer.drawing.polarity import polarity_of

if TYPE_CHECKING:
    from PIL.Image import Image

SAMPLES = 200  # columns and rows of the pixels that are looked at, at the most
# grey levels of 255: half; paper whose lightest channel is darker bears light lines
LIGHT = 128
BROADEST = SAMPLES // 10 - 1  # samples: a tenth of the sheet, no line is broader; an odd number
EVEN = 0.75  # of its lightest channel, chosen: paper that is hardly yellowed stays as it is


def levels_on_white(image: Image) -> list[int] | None:
    """What each level of red, green and blue becomes where the paper's colour is taken out of a picture."""
    from PIL import Image as Images

    columns, rows = (min(pixels, SAMPLES) for pixels in image.size)
    some = np.asarray(image.resize((columns, rows), Images.Resampling.NEAREST).convert("RGB"))
    paper = np.median(some.reshape(-1, 3), axis=0)
    if paper.max() < LIGHT or paper.min() > EVEN * paper.max() or not paper.all():
        return None
    lightest = np.asarray(some[:, :, paper.argmax()], np.float32)
    if not polarity_of(lightest, BROADEST).is_light:
        return None
    levels = np.arange(256)[:, None] * paper.max() / paper
    return np.minimum(np.rint(levels.T), 255).astype(int).ravel().tolist()
