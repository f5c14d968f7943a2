"""Flattening: a photograph becomes a flat scan to scale before it becomes a drawing.

Signals: a Scan and what is wanted of it in; out a Scan whose resolution is true, and how well it is known
(`tracer.flatten`). A picture that a camera made is flattened unasked, unless its scale is given.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.jobs.wrong_use import WrongUse
from morfax.motion.units import MM_PER_INCH

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.jobs.listener import Listener
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.drawing.scan import Scan
    from morfax.tracer.flatten.flat import Flattening
    from morfax.tracer.flatten.projection import Focal
    from morfax.tracer.flatten.wanted import Wanted

JPEG = b"\xff\xd8"  # with which such a file begins
WORTH_A_WARNING_RAD = math.radians(2)  # of tilt: an outline found roughly tells no less
NO_MARKS = "--bar is the bar of a sheet with marks; leave it out, or give --flatten marks"


@dataclass(frozen=True, slots=True)
class FlattenSettings:
    """How a photograph is made flat; None: by itself, if a camera made it and no scale is given."""

    wanted: Wanted | None = None
    bar_mm: float | None = None  # length of the printed bar; None: 100 mm

    def check(self, scale_given: bool) -> None:
        """Raise WrongUse for settings that do not go together."""
        if self.wanted is not None and scale_given:
            raise WrongUse("--flatten gives the scale itself; leave out any other scale")
        if self.bar_mm is not None and (
            scale_given or (self.wanted is not None and self.wanted.way in ("paper", "corners"))
        ):
            raise WrongUse(NO_MARKS)

    def of(self, scan: Scan, scale_given: bool) -> Wanted | None:
        """What is wanted of a scan; None: nothing."""
        from morfax.tracer.flatten.wanted import Wanted

        if self.bar_mm is not None:
            return Wanted("marks")
        if self.wanted is None and scan.camera is not None and not scale_given:
            return Wanted("auto")
        return self.wanted


def made_flat(
    scan: Scan, wanted: Wanted, bar_mm: float | None, listener: Listener
) -> tuple[Scan, Flattening]:
    """A scan in colours made flat, and how well; raises DrawingFault if it cannot be."""
    from morfax.tracer.drawing.scan import Stated
    from morfax.tracer.flatten.flat import flattened
    from morfax.tracer.flatten.layout import BAR_MM

    listener.detail(f"{scan.file}: making the photograph flat")
    picture = np.asarray(scan.pixels, np.uint8)
    flat, pitch_mm, made = flattened(picture, wanted, bar_mm or BAR_MM, _focal(scan))
    dpi = MM_PER_INCH / pitch_mm
    for text in made.warnings:
        listener.warning(f"{scan.file}: {text}")
    return replace(scan, pixels=flat, stated=Stated((dpi, dpi))), made


def in_grey(scan: Scan, made: Flattening) -> Scan:
    """A flat scan in grey: its darkest colour, of which red, in which the printed grid shows, is left out."""
    colours = scan.pixels[..., 1:] if made.wanted.way == "marks" else scan.pixels
    return replace(scan, pixels=np.ascontiguousarray(colours.min(axis=2)))


def warn_of_tilt(scan: Scan, listener: Listener) -> None:
    """Warn of a photograph whose sheet is tilted though a scale is given for all of it."""
    from morfax.tracer.flatten.format_choice import tilt_and_cost

    if scan.camera is None or scan.pixels.dtype != np.uint8:
        return
    picture = scan.pixels if scan.pixels.ndim == 3 else np.dstack([scan.pixels] * 3)
    found = tilt_and_cost(np.asarray(picture, np.uint8), _focal(scan))
    if found is None or found[0] < WORTH_A_WARNING_RAD:
        return
    tilt_rad, differ = found
    listener.warning(
        f"{scan.file}: the sheet was photographed at a tilt of some {math.degrees(tilt_rad):.0f} degrees:"
        f" sizes come out {100 * (1 / math.cos(tilt_rad) - 1):.1f} % wrong, and differ by up to"
        f" {100 * differ:.0f} % from one end of the sheet to the other;"
        " --flatten paper=a4, or a sheet with marks, makes it flat"
    )


def warn_of_table(scan: Scan, listener: Listener) -> None:
    """Warn of a sheet on a table in a JPEG that tells of no camera, as messengers pass them on: all of it is
    read. It is looked for on a picture that was made small while it was opened.
    """
    with scan.file.open("rb") as opened:
        if scan.camera is not None or opened.read(len(JPEG)) != JPEG:
            return
    from PIL import Image, ImageOps

    from morfax.tracer.flatten.outline import SMALL_PX, on_a_table

    with Image.open(scan.file) as file:
        file.draft("RGB", (SMALL_PX, SMALL_PX))
        small = np.asarray(ImageOps.exif_transpose(file.convert("RGB")))
    corners = on_a_table(small)
    if corners is None:
        return
    corners *= max(scan.columns, scan.rows) / max(small.shape)
    places = " ".join(f"{x:.0f},{y:.0f}" for x, y in corners.tolist())
    listener.warning(
        f"{scan.file}: a sheet of paper on a darker table shows, its corners at {places} px, and what lies"
        " beside it is read too; give --flatten paper=a4, or the paper's own size such as paper=148x105mm,"
        " instead of another scale: then the sheet alone is read"
    )


def figures(drawing: Drawing | None, picture: FilePath | None = None) -> dict[str, Any]:
    """How well a photograph was made flat, as figures; none of a drawing that was not."""
    made = None if drawing is None else drawing.flattening
    if drawing is None or made is None:
        return {}
    flat_picture = picture_beside(picture, drawing)
    fit, (finest_mm, coarsest_mm) = made.fit, made.mm_per_px
    told: Figures = {
        "flat_picture": None if flat_picture is None else str(flat_picture),
        "flattened_by": made.told,
        "tilt_deg": round(math.degrees(made.tilt_rad), 2),
        "finest_pixel_mm": finest_mm,
        "coarsest_pixel_mm": coarsest_mm,
        "bar_mm": made.bar_mm,
    }
    if fit is None:
        return dict(told)
    return {
        **told,
        "residual_rms_mm": fit.rms_mm * made.scale,
        "residual_largest_mm": fit.max_mm * made.scale,
        "residual_size_share": fit.size_share,
        "edge_softness_px": round(fit.softness_px, 2),
    }


def picture_beside(picture: FilePath | None, drawing: Drawing) -> FilePath | None:
    """The name for the picture of how a drawing was made flat, beside another picture; None: none."""
    if picture is None or drawing.flattening is None:
        return None
    beside = picture.with_name(f"{picture.stem}.flat{picture.suffix}")
    is_drawing = drawing.file is not None and beside.exists() and beside.samefile(drawing.file)
    return None if is_drawing else beside


def _focal(scan: Scan) -> Focal:
    """The focal length that the camera states, or phones' usual one."""
    from morfax.tracer.flatten.projection import Focal

    film_mm = None if scan.camera is None else scan.camera.focal_35mm
    return Focal() if film_mm is None else Focal.stated(film_mm)
