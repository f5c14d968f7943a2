"""Scale: how many mm a pixel of a scan is, by what the operator gives, or by what the file states.

Signals in: a Scan; a resolution or a width that the operator gives. Signals out: the pixel's pitch in X and
Y, mm.

Source: the patent takes the drawing's scale for granted. Questions: a wrong scale makes a wrong part, and
nothing later can tell. So a file without a resolution, or with one that is to be doubted (see `raster`), is
refused, and the operator is asked.
"""

from __future__ import annotations

from dataclasses import dataclass

from morfax.motion.faults import DrawingFault
from morfax.tracer.drawing.scan import MM_PER_INCH, Scan

# chosen far beyond any scan: a scale outside is a slip
LEAST_PITCH_MM, LARGEST_PITCH_MM = 0.001, 10.0


@dataclass(frozen=True, slots=True)
class Scale:
    """What the operator gives as the scale; nothing: the file's own counts."""

    dpi: float | None = None
    width_mm: float | None = None  # of the whole sheet

    def pitches_mm(self, scan: Scan) -> tuple[float, float]:
        """Pixel pitch in X and Y, mm; raises DrawingFault if there is no scale, or no sensible one."""
        if self.dpi is not None and self.width_mm is not None:
            raise DrawingFault(
                "both a resolution and a width were given; give one of --dpi and --width"
            )
        if self.width_mm is not None:
            pitch_mm = self.width_mm / scan.columns
            return (_checked("--width", self.width_mm, pitch_mm),) * 2
        if self.dpi is not None:
            pitch_mm = MM_PER_INCH / self.dpi if self.dpi else 0.0
            return (_checked("--dpi", self.dpi, pitch_mm),) * 2
        return _stated_mm(scan)


def _checked(option: str, value: float, pitch_mm: float) -> float:
    """A pixel pitch, mm; raises DrawingFault for one that no scan has."""
    if LEAST_PITCH_MM <= pitch_mm <= LARGEST_PITCH_MM:
        return pitch_mm
    allowed = f"{MM_PER_INCH / LARGEST_PITCH_MM:.3g} to {MM_PER_INCH / LEAST_PITCH_MM:.3g} dpi"
    raise DrawingFault(
        f"{option} is {value:g}; it must give pixels of {LEAST_PITCH_MM:g} to"
        f" {LARGEST_PITCH_MM:g} mm, {allowed}"
    )


def _stated_mm(scan: Scan) -> tuple[float, float]:
    """Pixel pitch in X and Y by what the file states, mm."""
    stated = scan.stated
    if stated is None:
        raise DrawingFault(
            f"{scan.file} states no resolution; "
            "give --dpi 300, or the sheet's width with --width 120mm"
        )
    if stated.doubt is not None:
        raise DrawingFault(
            f"{scan.file} states {stated.dpi[0]:g} dpi, {stated.doubt}; "
            f"give the sheet's width with --width 120mm, or --dpi {stated.dpi[0]:g} if that is true"
        )
    return MM_PER_INCH / stated.dpi[0], MM_PER_INCH / stated.dpi[1]
