"""The picture of the sheet as it is shown at once, before anything has looked for lines on it.

Signals in: a drawing's file and its options as text. Signals out: a Picture of its grey levels.
"""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import numpy as np

from morfax.panel.tiles import Pyramid

if TYPE_CHECKING:
    from morfax.panel.commands import Options

# that change which pixels are shown; a picture that was made flat comes from the worker
SHOWN_BY = ("--page", "--dpi", "--flatten", "--bar", "--edge", "--ink")


def key(drawing: FilePath, options: Options) -> str:
    """What the picture hangs on: the same text, the same picture."""
    return "\n".join([str(drawing), *(f"{name}={options.get(name)}" for name in SHOWN_BY)])


def read(drawing: FilePath, options: Options) -> Pyramid:
    """Read the picture; raises DrawingFault and FileFault for a file that holds none."""
    from morfax.tracer.drawing import raster

    page, dpi = options.get("--page"), options.get("--dpi")
    scan = raster.read(
        drawing,
        coloured=False,
        page=int(page) if isinstance(page, str) else None,
        dpi=float(dpi) if isinstance(dpi, str) else None,
    )
    return Pyramid(np.clip(scan.pixels, 0, 255).astype(np.uint8, copy=False))
