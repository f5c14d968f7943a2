"""Draw the drawings of the recipes: `python -m docs.figures.recipe_drawings` writes them all anew.

Each is a sheet as somebody would bring it: a scan in 300 dpi of lines of 0.5 mm (as `samples/draw.py` draws
them), a filled shape, a part on a scanner's glass, a faded sheet, a photograph by a simulated phone. Lengths
are mm.
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
    """A plate of 60 x 40 mm with a bore and four holes."""
    holes = [circle(x, y, 6) for x in (8, 52) for y in (8, 32)]
    return [rounded(0, 0, 60, 40, 6), circle(30, 20, 16), *holes]


def shelf_bracket() -> list[Points]:
    """A bracket for a shelf, 52 x 46 mm, with a hollow in its slope and two holes."""
    outline = closed(
        np.array([[0.0, 0.0], [52.0, 0.0], [52.0, 10.0]]),
        arc((52, 52), 42, -94, -168),
        np.array([[10.0, 46.0], [0.0, 46.0]]),
    )
    return [outline, circle(6, 38, 5), circle(44, 5.5, 5)]


def name_tag() -> list[Points]:
    """A tag of 50 x 22 mm with a hole for a string and a star in it."""
    turn = np.radians(90 + 36 * np.arange(10))
    radius = np.tile([7.5, 3.5], 5)
    star = closed(np.column_stack([28 + radius * np.cos(turn), 10.5 + radius * np.sin(turn)]))
    return [rounded(0, 0, 50, 22, 5), circle(6, 11, 4), star]


def figure() -> list[Points]:
    """A figure of Lissajous that crosses itself seven times, drawn in one line."""
    turn = np.linspace(0, 2 * math.pi, 1500)
    return [np.column_stack([24 * np.sin(2 * turn), 17 * np.sin(3 * turn)])]


def leaf() -> Grey:
    """A filled leaf of 40 x 24 mm with two veins left white."""
    grey = np.full((round(34 * PX_PER_MM), round(50 * PX_PER_MM)), 255, np.uint8)
    along = np.linspace(0, 1, 200)
    width = 12 * np.sin(math.pi * along**0.8)
    upper, lower = (np.column_stack([5 + 40 * along, 17 + side * width]) for side in (1, -1))
    _fill(grey, np.vstack([upper, lower[::-1]]), 20)
    for x in (18.0, 29.0):
        _fill(grey, rounded(x - 1.5, 12, x + 1.5, 22, 1.4), 255)
    return _softened(grey)


def lever() -> Grey:
    """A worn lever on a scanner's glass: two bores, 40 mm apart, and an edge that has lost a piece."""
    grey = np.full((round(34 * PX_PER_MM), round(68 * PX_PER_MM)), 235, np.uint8)
    _fill(grey, closed(arc((15, 17), 11, 60, 300), arc((55, 17), 8, -120, 120)), 35)
    for x, diameter in ((15, 10), (55, 7)):
        _fill(grey, circle(x, 17, diameter), 235)
    _fill(grey, circle(36, 26, 5), 235)
    return _softened(grey)


def flange() -> Grey:
    """A faded flange on grey paper, with centre lines, a number, and a scale bar of 30 mm."""
    bolts = [circle(26 + 14 * math.cos(t), 26 + 14 * math.sin(t), 5) for t in (0.8, 3.9)]
    centre = [np.array([[26.0, 2.0], [26.0, 50.0]]), np.array([[2.0, 26.0], [50.0, 26.0]])]
    bar = [np.array([[58.0, 6.0], [88.0, 6.0]])]
    ticks = [np.array([[x, 4.0], [x, 8.0]]) for x in (58.0, 88.0)]
    loops = [circle(26, 26, 40), circle(26, 26, 16), *bolts, *centre, *bar, *ticks]
    grey = scanned(coverage(*placed(loops)), seed=8)
    rows, columns = np.mgrid[: grey.shape[0], : grey.shape[1]]
    stain = 12 * np.exp(-(((rows - 150) / 150) ** 2) - ((columns - 900) / 200) ** 2)
    faded = (150 + (grey.astype(float) - 40) * 0.35 - stain).astype(np.uint8)
    cv2.putText(faded, "No. 7", (820, 260), 2, 1.4, 165, 4, cv2.LINE_AA)
    return faded


def gasket(file: Path) -> None:
    """A gasket drawn on a sheet with marks, photographed from aslant."""
    sheet = picture(Layout.of("a4"), 25.4 * PHONE_PX_PER_MM)
    outline = closed(arc((85, 150), 18, 90, 270), arc((125, 150), 18, -90, 90))
    for line in (outline, circle(105, 150, 26), circle(80, 150, 8), circle(130, 150, 8)):
        x, y = line.T * PHONE_PX_PER_MM
        places = np.round(16 * np.column_stack([x - 0.5, len(sheet) - y - 0.5]))
        pen = round(0.6 * PHONE_PX_PER_MM)
        cv2.polylines(
            sheet, [places.astype(np.int32)], False, (45, 40, 60), pen, cv2.LINE_AA, 4
        )
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
SHEETS: dict[str, Callable[[], Grey]] = {"leaf": leaf, "lever": lever, "flange": flange}


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
