"""Draw the drawings of the recipes: `python -m docs.figures.recipe_drawings` writes them all anew.

Each is a sheet as somebody would bring it: a scan in 300 dpi of lines of 0.5 mm (as those of `samples/draw.py`),
a filled shape, a part on a scanner's glass, a faded sheet, a photograph by a simulated phone. Lengths are mm.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from benchmarks.phone import Phone
from morfax.reports.marked_sheet import picture
from morfax.samples.draw import DPI, arc, closed, coverage, placed, scanned
from morfax.tracer.flatten.layout import Layout

DRAWINGS = Path(__file__).parents[1] / "recipes" / "drawings"
PX_PER_MM = DPI / 25.4
PHONE_PX_PER_MM = 10  # of the sheet before it is photographed

Points = NDArray[np.float64]
Grey = NDArray[np.uint8]


def circle(x: float, y: float, diameter: float) -> Points:
    """A circle."""
    return arc((x, y), 0.5 * diameter, 0, 360)


def rounded(left: float, bottom: float, right: float, top: float, radius: float) -> Points:
    """A rectangle with round corners."""
    return closed(
        arc((right - radius, bottom + radius), radius, -90, 0),
        arc((right - radius, top - radius), radius, 0, 90),
        arc((left + radius, top - radius), radius, 90, 180),
        arc((left + radius, bottom + radius), radius, 180, 270),
    )


def base_plate() -> list[Points]:
    """A plate of 90 x 60 mm with a bore, four holes and two slots."""
    holes = [circle(x, y, 7) for x in (9, 81) for y in (9, 51)]
    slots = [rounded(left, 24, left + 8, 44, 4) for left in (14, 68)]
    return [rounded(0, 0, 90, 60, 8), circle(45, 30, 24), *holes, *slots]


def shelf_bracket() -> list[Points]:
    """A bracket for a shelf, 80 x 70 mm, with a hollow in its slope and two holes."""
    outline = closed(
        np.array([[0.0, 0.0], [80.0, 0.0], [80.0, 14.0]]),
        arc((80, 80), 66, -90 - 4, -180 + 12),
        np.array([[14.0, 70.0], [0.0, 70.0]]),
    )
    return [outline, circle(8, 60, 5), circle(68, 7, 5)]


def name_tag() -> list[Points]:
    """A tag of 70 x 30 mm with a hole for a string and a star in it."""
    turn = np.radians(90 + 36 * np.arange(10))
    radius = np.tile([9.0, 4.0], 5)
    star = closed(
        np.column_stack([38 + radius * np.cos(turn), 14.5 + radius * np.sin(turn)])
    )
    return [rounded(0, 0, 70, 30, 6), circle(8, 15, 5), star]


def figure() -> list[Points]:
    """A figure of Lissajous that crosses itself seven times, drawn in one line, and a frame round it."""
    turn = np.linspace(0, 2 * math.pi, 1500)
    curve = np.column_stack([28 * np.sin(2 * turn + 0.5), 20 * np.sin(3 * turn)])
    return [curve, rounded(-34, -26, 34, 26, 5)]


def leaf() -> Grey:
    """A filled leaf with three veins left white, 60 x 40 mm."""
    grey = np.full((round(54 * PX_PER_MM), round(74 * PX_PER_MM)), 255, np.uint8)
    along = np.linspace(0, 1, 200)
    width = 18 * np.sin(math.pi * along**0.8)
    upper = np.column_stack([7 + 60 * along, 27 + width])
    _fill(grey, np.vstack([upper, np.column_stack([7 + 60 * along, 27 - width])[::-1]]), 20)
    for x in (22.0, 34.0, 46.0):
        _fill(grey, rounded(x - 1.5, 20, x + 1.5, 34, 1.4), 255)
    return _softened(grey)


def lever() -> Grey:
    """A worn lever on a scanner's glass: two bores, 60 mm apart, and an edge that has lost a piece."""
    grey = np.full((round(50 * PX_PER_MM), round(100 * PX_PER_MM)), 235, np.uint8)
    outline = closed(arc((20, 25), 14, 60, 300), arc((80, 25), 9, -120, 120))
    _fill(grey, outline, 35)
    for x, diameter in ((20, 12), (80, 8)):
        _fill(grey, circle(x, 25, diameter), 235)
    _fill(grey, circle(52, 36, 7), 235)
    return _softened(grey)


def archive() -> Grey:
    """A faded flange in brown ink on yellowed paper, with centre lines and a scale bar of 50 mm."""
    bolts = [circle(45 + 22 * math.cos(t), 45 + 22 * math.sin(t), 5) for t in (0.8, 2.3, 3.9, 5.5)]
    centre = [np.array([[45.0, 6.0], [45.0, 84.0]]), np.array([[6.0, 45.0], [84.0, 45.0]])]
    bar = [np.array([[100.0, 10.0], [150.0, 10.0]])]
    ticks = [np.array([[x, 8.0], [x, 12.0]]) for x in (100.0, 150.0)]
    loops = [circle(45, 45, 62), circle(45, 45, 26), *bolts, *centre, *bar, *ticks]
    grey = scanned(coverage(*placed(loops)), seed=8)
    rows, columns = np.mgrid[: grey.shape[0], : grey.shape[1]]
    stain = 12 * np.exp(-(((rows - 300) / 250) ** 2) - ((columns - 1500) / 300) ** 2)
    faded = (150 + (grey.astype(float) - 40) * 0.35 - stain).astype(np.uint8)
    cv2.putText(faded, "FLANGE No. 7", (1190, 420), 2, 2.0, 165, 5, cv2.LINE_AA)
    return faded


def gasket(file: Path) -> None:
    """A gasket drawn on a sheet with marks, photographed from aslant."""
    sheet = picture(Layout.of("a4"), 25.4 * PHONE_PX_PER_MM)
    outline = closed(arc((80, 150), 26, 90, 270), arc((130, 150), 26, -90, 90))
    bolts = [circle(x, y, 6) for x, y in ((59.5, 150), (150.5, 150), (105, 132), (105, 168))]
    for line in (outline, circle(80, 150, 30), circle(130, 150, 30), *bolts):
        x, y = line.T * PHONE_PX_PER_MM
        places = np.round(16 * np.column_stack([x - 0.5, len(sheet) - y - 0.5]))
        pen = round(0.6 * PHONE_PX_PER_MM)
        cv2.polylines(sheet, [places.astype(np.int32)], False, (45, 40, 60), pen, cv2.LINE_AA, 4)
    Phone(
        columns=1500,
        rows=2000,
        tilt_rad=math.radians(12),
        about_rad=0.6,
        turn_rad=0.05,
        k1=0.02,
        blur_px=0.7,
    ).write(sheet, (210.0, 297.0), file)


def _fill(grey: Grey, outline: Points, value: int) -> None:
    """Paint what an outline goes round (from the lower left, Y up)."""
    x, y = outline.T * PX_PER_MM
    places = np.round(16 * np.column_stack([x - 0.5, len(grey) - y - 0.5])).astype(np.int32)
    cv2.fillPoly(grey, [places], value, cv2.LINE_AA, 4)


def _softened(grey: Grey) -> Grey:
    """As a scanner's lens softens it."""
    return np.asarray(cv2.GaussianBlur(grey, (0, 0), 0.6), np.uint8)


LINES: dict[str, Callable[[], list[Points]]] = {
    "base-plate": base_plate,
    "shelf-bracket": shelf_bracket,
    "name-tag": name_tag,
    "figure": figure,
}
SHEETS: dict[str, Callable[[], Grey]] = {"leaf": leaf, "lever": lever, "flange": archive}


def main(folder: Path) -> None:
    """Write all drawings into a folder."""
    for seed, (name, loops) in enumerate(LINES.items()):
        grey = scanned(coverage(*placed(loops())), seed)
        Image.fromarray(grey).save(folder / f"{name}.png", dpi=(DPI, DPI), optimize=True)
    for name, drawn in SHEETS.items():
        stated = {} if name == "flange" else {"dpi": (DPI, DPI)}
        Image.fromarray(drawn()).save(folder / f"{name}.png", optimize=True, **stated)
    gasket(folder / "gasket.jpg")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else DRAWINGS)
