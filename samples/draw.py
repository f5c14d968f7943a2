"""Draw the sample drawings from known geometry, as a scanner would see them, with the truth beside them.

    python samples/draw.py [FOLDER]

Each drawing is a line of 0.5 mm at 300 dpi: the ink's coverage drawn eight times too fine and averaged,
softened by the scanner's lens (0.05 mm), on unevenly lit paper, with noise, in 21 grey levels and cut off at
the scanner's white (which keeps the files small). The truth is `loop,x,y` in mm in sheet coordinates: from
the lower-left corner of the sheet, X right, Y up; pixel i covers [i, i+1) pixel pitches.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

DPI = 300.0
PIXELS_PER_MM = DPI / 25.4
LINE_MM = 0.5
MARGIN_MM = 7.0
STEP_MM = 0.2  # between points on curves: 0.17 um of sagitta on a radius of 30 mm
OVERSAMPLE = 8
SOFTNESS_MM = 0.05
NOISE_GREY = 6.0
GREY_STEP = 12  # half of it is less than the noise, which therefore still averages out
INK_GREY = 40.0
PAPER_GREY = 240.0
SHADE_GREY = 10.0  # the paper is darker and lighter by this at its upper corners
WHITE_GREY = 240  # whatever is lighter, the scanner gives as white

Points = NDArray[np.float64]

Piece = tuple[float, ...]
# points: x, y, mm; arcs: x, y and radius, mm; from and to, degrees
BRACKET = (
    (0, 0), (60, 10, 10, -90, 0), (70, 24), (58, 32), (34, 32), (34, 38, 6, 270, 180), (28, 50), (0, 50),
)  # fmt: skip
SLOT = [(52, 15, 4, -90, 90), (30, 15, 4, 90, 270)]
PLATE = (
    (18, 12),
    (24, 6, 6, 180, 270),
    (56, 6, 6, 270, 360),
    (56, 26, 6, 0, 90),
    (24, 26, 6, 90, 180),
)
STROKES: tuple[list[Piece], ...] = (
    [(0, 16), (18, 16)],  # the lead line
    [(13, 14.5), (13, 17.5)],  # a stop before the plate
    [(62, 14), (65, 14)],  # and one on it
    [(-1.5, 16), (1.5, 16)],  # the cross of the reference point
    [(0, 14.5), (0, 17.5)],
    [(40, 32), (40, 20)],  # the guide line to the drill point
    [(40, 20, 0.2, 0, 360)],
    [(40, 20, 0.5, 0, 360)],
)
TEETH, ROOT_MM, TIP_MM = 8, 16.0, 22.0  # radii


def arc(
    centre_mm: tuple[float, float], radius_mm: float, from_deg: float, to_deg: float
) -> Points:
    """Points of an arc, both ends included, mm."""
    angle = np.radians(
        np.linspace(
            from_deg, to_deg, 2 + int(abs(np.radians(to_deg - from_deg)) * radius_mm / STEP_MM)
        )
    )
    return np.array(centre_mm) + radius_mm * np.column_stack([np.cos(angle), np.sin(angle)])


def drawn(pieces: Sequence[Piece]) -> Points:
    """Points (x, y) and arcs (x, y and radius; from and to) one after the other: mm, degrees."""
    return np.vstack(
        [arc((x, y), *of_arc) if of_arc else np.array([[x, y]]) for x, y, *of_arc in pieces]
    )


def closed(*pieces: Points) -> Points:
    """The pieces one after the other, and back to the first point, mm."""
    points = np.vstack([np.atleast_2d(piece) for piece in pieces])
    return np.vstack([points, points[:1]])


def cam() -> list[Points]:
    """Plate cam: base radius 30 mm, lift 15 mm; dwell 100°, cycloidal rise 80°, dwell 80°, cycloidal return
    100°.
    """
    angle_deg = np.linspace(0, 360, 1400)
    turns = np.interp(angle_deg, [0, 100, 180, 260, 360], [0, 0, 1, 1, 2])
    lift = np.abs((turns - np.sin(2 * np.pi * turns) / (2 * np.pi) + 1) % 2 - 1)
    radius_mm, angle = 30 + 15 * lift, np.radians(angle_deg)
    return [np.column_stack([radius_mm * np.cos(angle), radius_mm * np.sin(angle)])]


def bracket() -> list[Points]:
    """Angle bracket of 70 x 50 mm: right-angled, obtuse and rounded corners; and a slot of 8 mm."""
    return [closed(drawn(BRACKET)), closed(drawn(SLOT))]


def curve() -> list[Points]:
    """An open curve of 80 mm: a wave that dies out."""
    x_mm = np.linspace(0, 80, 800)
    return [np.column_stack([x_mm, 22 * np.exp(-x_mm / 45) * np.sin(2 * np.pi * x_mm / 42)])]


def gear() -> list[Points]:
    """Ratchet wheel of eight teeth, 44 mm across: straight flanks and sharp tips and roots."""
    turn = np.repeat(np.arange(TEETH), 2) * 2 * np.pi / TEETH + 0.1
    radius_mm = np.tile([ROOT_MM, TIP_MM], TEETH)
    return [closed(np.column_stack([radius_mm * np.cos(turn), radius_mm * np.sin(turn)]))]


def program() -> list[Points]:
    """A rounded plate of 44 x 32 mm, the lead line to it, its reference point, two stop marks, and a guide
    line to a drill point.
    """
    lead, *others = map(drawn, STROKES)
    return [lead, closed(drawn(PLATE)), *others]


DRAWINGS: dict[str, Callable[[], list[Points]]] = {
    "cam": cam,
    "bracket": bracket,
    "curve": curve,
    "gear": gear,
    "program": program,
}


def placed(loops: list[Points]) -> tuple[list[Points], NDArray[np.int_]]:
    """The loops moved to the margin, mm, and the sheet's size in whole pixels (x, y)."""
    every = np.vstack(loops)
    low, high = every.min(axis=0), every.max(axis=0)
    return [p - low + MARGIN_MM for p in loops], np.ceil(
        (high - low + 2 * MARGIN_MM) * PIXELS_PER_MM
    ).astype(int)


def coverage(loops: list[Points], sheet_px: NDArray[np.int_]) -> NDArray[np.float32]:
    """Share of each pixel that is ink, 0..1, rows from the top."""
    fine = np.zeros(tuple(sheet_px[::-1] * OVERSAMPLE), np.uint8)
    scale = PIXELS_PER_MM * OVERSAMPLE
    for points in loops:
        at = (
            np.column_stack([points[:, 0], sheet_px[1] / PIXELS_PER_MM - points[:, 1]]) * scale
            - 0.5
        )
        fixed = np.round(at * 256).astype(np.int32).reshape(-1, 1, 2)
        cv2.polylines(
            fine,
            [fixed],
            False,
            255,
            thickness=round(LINE_MM * scale),
            lineType=cv2.LINE_AA,
            shift=8,
        )
    size = (int(sheet_px[0]), int(sheet_px[1]))
    return (cv2.resize(fine, size, interpolation=cv2.INTER_AREA) / 255).astype(np.float32)


def scanned(ink: NDArray[np.float32], seed: int) -> NDArray[np.uint8]:
    """Grey values of the ink as a scanner gives them."""
    soft = cv2.GaussianBlur(ink, (0, 0), SOFTNESS_MM * PIXELS_PER_MM)
    rows, columns = soft.shape
    shade = np.linspace(-1, 1, columns)[None, :] * np.linspace(1, 0.3, rows)[:, None]
    paper = PAPER_GREY + SHADE_GREY * shade
    grey = (
        paper
        - (paper - INK_GREY) * soft
        + np.random.default_rng(seed).normal(0, NOISE_GREY, soft.shape)
    )
    return np.clip(np.round(grey / GREY_STEP) * GREY_STEP, 0, WHITE_GREY).astype(np.uint8)


def draw(name: str, folder: Path) -> None:
    """Write one drawing and its truth into a folder."""
    loops, sheet_px = placed(DRAWINGS[name]())
    image = Image.fromarray(scanned(coverage(loops, sheet_px), seed=list(DRAWINGS).index(name)))
    image.save(folder / f"{name}.png", dpi=(DPI, DPI), optimize=True)
    rows = [f"{k},{x:.5f},{y:.5f}\n" for k, points in enumerate(loops) for x, y in points]
    (folder / f"{name}.csv").write_text("loop,x,y\n" + "".join(rows))


if __name__ == "__main__":
    for drawing in DRAWINGS:
        draw(drawing, Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
