"""DXF files that tests write, and what is read of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import ezdxf
import numpy as np
from ezdxf import units

from morfax.motion.arrays import Array
from morfax.recorder.drawings.cut_lines import CutLine, CutPiece

UM = 1e-3


def dxf(
    file: Path, draw: Callable[..., None], unit: int = units.MM, version: str = "R2010"
) -> Path:
    """A DXF with what is drawn in its model space."""
    document = ezdxf.new(version, units=unit)
    draw(document)
    document.saveas(file)
    return file


def off_circle(contour: Array, centre: tuple[float, float], radius: float) -> float:
    """How far the chords of a contour are off a circle at the most, mm."""
    middles = (contour[1:] + contour[:-1]) / 2
    places = np.vstack([contour, middles])
    return float(np.abs(np.hypot(*(places - centre).T) - radius).max())


# what is written is read back


def cut() -> list[CutLine]:
    """Lines and arcs that turn both ways, narrow and wide, and a hole; closed where they end exactly."""
    angle = math.radians(170)
    around = (20 + 10 * math.cos(angle), 20 + 10 * math.sin(angle))
    half = (CutPiece((10.0, 20.0), math.pi), CutPiece((30.0, 20.0), math.pi))
    return [
        CutLine((3.0, 4.0), (CutPiece((33.3333, 4.0)), CutPiece((43.3333, 14.0), math.pi / 2))),
        CutLine((30.0, 20.0), half),
        CutLine((30.0, 20.0), (CutPiece(around, angle),)),
        CutLine((50.0, 40.0), (CutPiece((51.0, 40.0), -1.8 * math.pi), CutPiece((60.0, 45.0)))),
        CutLine((12.5, 12.5), ()),
    ]
