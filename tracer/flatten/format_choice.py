"""Which format a sheet of paper has, by its four edges in a photograph.

Signals: a picture, and what is known of the lens, in; a format, upright or lying, and the fit out.

Four edges fit a rectangle of any sides: a homography takes every quadrangle to every other. But a rigid
sheet before a lens of a known focal length has one ratio of sides only. So a format fits as well as its
sheet stands rigidly there (see `projection.Pose`). The sheets of the A series all have one ratio, and fit
together. A picture that was cropped to one side, or stretched, is no view of a camera's whole frame: where a
sheet of no sides at all would stand rigidly, its shape tells nothing, and a named format is believed.

Source: Zhang and He 2007, whiteboards (the ratio of a rectangle in one view). Questions: without a focal
length in the file phones' usual one is taken; a sheet tilted far may then fit two formats.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault
from morfax.tracer.flatten import outline
from morfax.tracer.flatten.edges import Picture
from morfax.tracer.flatten.fit import Fit, fitted, homography_of
from morfax.tracer.flatten.formats import FORMATS, Format
from morfax.tracer.flatten.projection import Focal, Pose, Projection, Rectangle

# standard deviations (see projection.RIGID) by which a sheet may be off a format: 4 % in its ratio where the
# operator names the format, 2.5 % where it is to be told from others
FITS_NAMED, FITS_ALONE = 8.0, 5.0
MARKS_WAY = "--flatten marks with a sheet that `morfax sheet` prints"
PLACES_WAY = '--flatten "X,Y X,Y X,Y X,Y=200x100mm" with four places in the photograph'

Sides = list[tuple[Array, Array]]  # see outline.sides


class FormatChoice(NamedTuple):
    """The format of a sheet as it lies, its fit, and what about the choice is worth a word."""

    paper: Format
    fit: Fit
    doubt: str = ""


def fit_named(picture: Picture, paper: Format, focal: Focal) -> FormatChoice:
    """Fit a sheet of a format, upright or lying; raises DrawingFault if no edges show, or do not fit."""
    found = _sides(picture)
    if found is None:
        raise DrawingFault(
            "the four edges of the sheet do not show in the photograph; photograph the whole sheet on a"
            f" table that is darker or of another colour, or give {MARKS_WAY}, or {PLACES_WAY}"
        )
    each, off = _likelier(picture, found, paper, focal)
    if off <= FITS_NAMED:
        return FormatChoice(each, _fit(picture, found, each))
    if _likeliest(outline.corners_of(found), photo_of(picture), focal)[1] > FITS_ALONE:
        doubt = (
            "no camera sees a sheet in this shape: the picture was cropped to one side or stretched, so only"
            f" --flatten says that the sheet is {paper.name}"
        )
        return FormatChoice(each, _fit(picture, found, each), doubt)
    fitting = _fitting(picture, found, focal)
    others = f"; {' or '.join(other.name for other in fitting)} would fit" if fitting else ""
    raise DrawingFault(
        f"the sheet in the photograph does not have the sides of {paper.name} ({paper.width_mm:g} x"
        f" {paper.height_mm:g} mm){others}; give its own, such as --flatten paper=148x105mm"
    )


def fit_any(picture: Picture, focal: Focal) -> FormatChoice:
    """Fit a sheet of the one known format that it can have; raises DrawingFault if none or several fit."""
    found = _sides(picture)
    if found is None:
        raise DrawingFault(
            "the photograph shows neither marks nor the four edges of a sheet; give"
            f" {MARKS_WAY}, --flatten paper=a4 with all edges of the sheet to be seen, or {PLACES_WAY}"
        )
    fitting = _fitting(picture, found, focal)
    if len(fitting) == 1:
        each = fitting[0]
        doubt = (
            f"morfax takes the sheet for {each.name}, {each.width_mm:g} x {each.height_mm:g} mm, by its shape"
            " alone; if it has another format, give that, such as --flatten paper=a4"
        )
        return FormatChoice(each, _fit(picture, found, each), doubt)
    if fitting:
        names = [each.name for each in fitting]
        can_be = f"can be {', '.join(names[:-1])} or {names[-1]}"
        size = f"--flatten paper={names[0]} if that is its size"
    else:
        can_be = "has the shape of no known format"
        size = "its size, such as --flatten paper=148x105mm (or paper=a4 if the picture was cropped)"
    raise DrawingFault(
        f"the photograph shows no marks, and its sheet {can_be}; give {size}, {MARKS_WAY}, or {PLACES_WAY}"
    )


def tilt_and_cost(picture: Picture, focal: Focal) -> tuple[float, float] | None:
    """Tilt (rad) of a sheet whose outline shows, and how much sizes differ over it; None without one."""
    corners = outline.outline(picture)
    if corners is None:
        return None
    likely, _ = _likeliest(corners, photo_of(picture), focal)
    finest, coarsest = likely.mm_per_px()
    return likely.tilt_rad(focal), coarsest / finest - 1


def corners_of(sheet: Rectangle) -> Array:
    """Corners (4, 2) of a sheet, clockwise from the upper left, mm."""
    w, h = sheet.width, sheet.height
    return np.array([(0, h), (w, h), (w, 0), (0, 0)], float)


def photo_of(picture: Picture) -> Rectangle:
    """A picture's size, px."""
    return Rectangle(picture.shape[1], picture.shape[0])


def _likeliest(corners: Array, photo: Rectangle, focal: Focal) -> tuple[Projection, float]:
    """The sheet of whatever sides that stands most rigidly so, and how far off it is (see Pose.off)."""
    from scipy.optimize import minimize_scalar

    def projection(log_stretch: float) -> Projection:
        """The sheet as if its width were so many times its height."""
        sheet = Rectangle(math.exp(log_stretch), 1.0)
        return Projection(sheet, photo, homography_of(corners_of(sheet), corners, sheet, photo))

    best = minimize_scalar(
        lambda log_stretch: Pose.of(projection(log_stretch).homography, focal).off,
        bounds=(-1.0, 1.0),
        method="bounded",
    )
    return projection(best.x), float(best.fun)


def _sides(picture: Picture) -> Sides | None:
    """Places on the four sides of the sheet; None if it does not show."""
    corners = outline.outline(picture)
    return None if corners is None else outline.sides(picture, corners)


def _fitting(picture: Picture, found: Sides, focal: Focal) -> list[Format]:
    """The known formats that the sheet can have, as they lie."""
    likelier = [_likelier(picture, found, each, focal) for each in FORMATS.values()]
    return [each for each, off in likelier if off <= FITS_ALONE]


def _likelier(
    picture: Picture, found: Sides, paper: Format, focal: Focal
) -> tuple[Format, float]:
    """A format upright or lying, whichever is likelier, and how far the sheet is off it (see Pose.off)."""
    photo, corners = photo_of(picture), outline.corners_of(found)
    each_off = []
    for each in (paper, paper.turned):
        sheet = Rectangle(each.width_mm, each.height_mm)
        homography = homography_of(corners_of(sheet), corners, sheet, photo)
        each_off.append((each, Pose.of(homography, focal).off))
    return min(each_off, key=lambda one: one[1])


def _fit(picture: Picture, found: Sides, paper: Format) -> Fit:
    """Fit a sheet of a format as it lies."""
    sheet = Rectangle(paper.width_mm, paper.height_mm)
    photo = photo_of(picture)
    first = homography_of(corners_of(sheet), outline.corners_of(found), sheet, photo)
    seen = outline.sightings(found, paper.width_mm, paper.height_mm)
    return fitted(seen, sheet, photo, first, inked=False)
