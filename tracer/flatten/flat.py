"""A photograph made flat: the sheet alone, upright and to scale, and how well its camera is known.

Signals: a picture in (rows from the top, columns, 3 colours of 8 bits); out the sheet as pixels of one pitch,
and the figures: tilt, mm per pixel, what marks or edges are off, the bar's length, softness.

The picture is resampled once. Printed marks, the bar, and a rim beyond which the table may show, are made
paper.

Source: our own. Questions: a sheet that is bent is flat in no camera. What marks or edges are off tells; if
it stands for more than 1 % in size the photograph is refused.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np

from morfax.motion.faults import DrawingFault
from morfax.tracer.flatten import aruco, format_choice
from morfax.tracer.flatten.edges import Picture
from morfax.tracer.flatten.fit import Fit, homography_of
from morfax.tracer.flatten.format_choice import corners_of, photo_of
from morfax.tracer.flatten.formats import Format
from morfax.tracer.flatten.layout import BAR_MM, Box, Layout
from morfax.tracer.flatten.projection import Focal, Projection, Rectangle
from morfax.tracer.flatten.resampling import clean, resampled
from morfax.tracer.flatten.wanted import Wanted

WORTH_A_WARNING, TOO_MUCH = 0.002, 0.01  # of size
REDUCED_PX = 1200  # longer side of the photograph that is kept for a picture
# standard deviation; a sharp photograph has about 1, and beyond this too little is measured
BLURRED_PX = 2.5
STEEPEST = math.radians(60)  # chosen: a sheet tilted further is a strip


@dataclass(frozen=True)
class Flattening:
    """How a photograph was made flat, and how well; lengths in mm as they are on the paper."""

    wanted: Wanted
    paper: Format
    projection: Projection
    tilt_rad: float
    scale: float = 1.0  # mm on the paper to mm of the projection: a print that is not 100 %
    fit: Fit | None = None  # of marks or edges
    bar_mm: float | None = None
    reduced: Picture | None = None  # the photograph, smaller
    doubt: str = ""  # about which format the sheet has

    @property
    def mm_per_px(self) -> tuple[float, float]:
        """Finest and coarsest scale of the photograph on the sheet, mm per pixel."""
        finest, coarsest = self.projection.mm_per_px()
        return finest * self.scale, coarsest * self.scale

    @property
    def warnings(self) -> tuple[str, ...]:
        """What may not be meant so."""
        told = [self.doubt] if self.doubt else []
        if self.fit is not None and self.fit.size_share > WORTH_A_WARNING:
            told.append(
                f"the {self.seen} are up to {self.fit.max_mm:.2f} mm off a flat sheet, which is"
                f" {100 * self.fit.size_share:.2g} % in size; press the sheet flat and photograph it again"
            )
        if self.fit is not None and self.fit.softness_px > BLURRED_PX:
            told.append(
                f"the photograph is blurred by more than {BLURRED_PX:g} pixels (standard deviation); hold"
                " the camera still, and tap on the sheet so that it is sharp"
            )
        corners, photo = self.projection.corners_px(), self.projection.photo
        if ((corners < -1) | (corners > (photo.width + 1, photo.height + 1))).any():
            told.append(
                "a part of the sheet is outside the photograph; what is drawn there is missing"
            )
        return tuple(told)

    @property
    def printed_mm(self) -> list[Box]:
        """What is printed on the sheet, mm of the projection."""
        return Layout(self.paper).printed_mm() if self.wanted.way == "marks" else []

    @property
    def told(self) -> str:
        """What the sheet is, and what was found of it."""
        size = (
            f"{self.paper.width_mm * self.scale:g} x {self.paper.height_mm * self.scale:g} mm"
        )
        if self.wanted.way == "marks":
            assert self.fit is not None
            count = len(self.fit.displaced[0])
            return f"{count} of {len(Layout(self.paper).marks_mm)} marks on {self.paper.name}, {size}"
        if self.wanted.way == "paper":
            return f"edges of {self.paper.name}, {size}"
        return f"four places, {size}"

    @property
    def seen(self) -> str:
        """What the map was fitted to."""
        return {"marks": "marks", "paper": "sheet's edges"}.get(self.wanted.way, "places")


def flattened(
    picture: Picture, wanted: Wanted, bar_mm: float = BAR_MM, focal: Focal | None = None
) -> tuple[Picture, float, Flattening]:
    """Make a photograph flat: the sheet's pixels, their pitch in mm, and how well it is known.

    Raises DrawingFault if what is wanted is not in the photograph, or not flat.
    """
    made = found(picture, wanted, bar_mm, focal or Focal())
    flat, pitch_mm = resampled(picture, made.projection)
    if made.wanted.way != "corners":
        clean(flat, pitch_mm, made.printed_mm)
    by = min(1.0, REDUCED_PX / max(picture.shape[:2]))
    small = cv2.resize(picture, None, fx=by, fy=by, interpolation=cv2.INTER_AREA)
    made = replace(made, reduced=np.asarray(small, np.uint8))
    return flat, pitch_mm * made.scale, made


def found(picture: Picture, wanted: Wanted, bar_mm: float, focal: Focal) -> Flattening:
    """What is wanted, found in a photograph; raises DrawingFault if it is not there, or not flat."""
    made = _found(picture, wanted, bar_mm, focal)
    _check(made)
    return made


def _found(picture: Picture, wanted: Wanted, bar_mm: float, focal: Focal) -> Flattening:
    """What is wanted, found in a photograph."""
    if wanted.way == "corners":
        return _of_corners(picture, wanted, focal)
    if wanted.way != "paper":
        by_marks = _of_marks(picture, bar_mm / BAR_MM, focal)
        if by_marks is not None:
            return by_marks
        if wanted.way == "marks":
            raise DrawingFault(
                "the photograph shows no marks; print a sheet with `morfax sheet -o sheet.pdf`, draw on"
                " it, and photograph the whole sheet, sharp and evenly lit"
            )
    if wanted.paper is None:
        paper, fit, doubt = format_choice.fit_any(picture, focal)
    else:
        paper, fit, doubt = format_choice.fit_named(picture, wanted.paper, focal)
    tilt = fit.projection.tilt_rad(focal)
    return Flattening(Wanted("paper", paper), paper, fit.projection, tilt, fit=fit, doubt=doubt)


def _of_marks(picture: Picture, scale: float, focal: Focal) -> Flattening | None:
    """By the marks; None if there are none."""
    found = aruco.sheet_of(aruco.marks_in(picture), photo_of(picture))
    if found is None:
        return None
    layout, marks = found
    fit = aruco.fit_marks(picture, layout, marks)
    bar_mm = aruco.bar_length_mm(picture, layout, fit.projection)
    tilt = fit.projection.tilt_rad(focal)
    bar_mm = None if bar_mm is None else bar_mm * scale
    return Flattening(Wanted("marks"), layout.paper, fit.projection, tilt, scale, fit, bar_mm)


def _of_corners(picture: Picture, wanted: Wanted, focal: Focal) -> Flattening:
    """By four places."""
    assert wanted.paper is not None
    sheet = Rectangle(*wanted.paper[1:])
    photo = photo_of(picture)
    corners = np.array(wanted.corners_px)
    if ((corners < 0) | (corners > (photo.width, photo.height))).any():
        raise DrawingFault(
            "a place is outside the photograph, which has"
            f" {photo.width:.0f} x {photo.height:.0f} pixels; count from its upper left corner"
        )
    projection = Projection(
        sheet, photo, homography_of(corners_of(sheet), corners, sheet, photo)
    )
    return Flattening(wanted, wanted.paper, projection, projection.tilt_rad(focal))


def _check(made: Flattening) -> None:
    """Raise DrawingFault for a sheet that is not flat, or seen too aslant."""
    if made.tilt_rad > STEEPEST:
        raise DrawingFault(
            f"the sheet is tilted by {math.degrees(made.tilt_rad):.0f} degrees, and up to "
            f"{math.degrees(STEEPEST):.0f} are made flat; photograph it from above"
        )
    if made.fit is not None and made.fit.size_share > TOO_MUCH:
        raise DrawingFault(
            f"the {made.seen} are up to {made.fit.max_mm:.2f} mm off a flat sheet, which is"
            f" {100 * made.fit.size_share:.2g} % in size, more than {100 * TOO_MUCH:g} %;"
            " press the sheet flat and photograph it again"
        )
