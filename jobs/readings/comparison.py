"""How far a path is from another path, or from the ink of a drawing: figures, and the error along the path.

A path from a path: the distance of each sample of the first from the nearest place of the second, and back.
A path from a drawing: the distance of each point from the ink's own centre, measured across the path in the
image; not a number at crossings and corners, where the ink has no single centre; and the ink that no path
covers.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from morfax.jobs.figures import Figures
from morfax.jobs.listener import SILENT, Listener

if TYPE_CHECKING:
    from morfax.motion.contour import Summary
    from morfax.motion.motion import Path
    from morfax.tracer.drawing.drawing import Drawing

LEAST_SHARE = 0.5  # of a path along ink: corners, crossings and gaps take less; by trial
SAMPLE_MM = 0.05  # between the points that a picture shows


@dataclass(frozen=True, slots=True)
class Comparison:
    """Rows of figures by name, the largest distance, and the error at points along the path (mm)."""

    rows: dict[str, Figures]
    largest_mm: float
    points_mm: NDArray[np.float64]
    error_mm: NDArray[np.float64]
    missed: dict[str, Any] | None = None
    measured_share: float = 1.0  # of the path; the rest has no ink's centre beside it

    @property
    def is_elsewhere(self) -> bool:
        """Whether so little of the path lies along ink that its distances say nothing."""
        return self.measured_share < LEAST_SHARE

    def is_within(self, tolerance_mm: float) -> bool:
        """Whether no place is further off than a tolerance."""
        return not self.is_elsewhere and self.largest_mm <= tolerance_mm

    @property
    def figures(self) -> dict[str, Any]:
        """All figures, for a table or for JSON."""
        return {**(self.missed or {}), **self.rows}


def measured_on(drawing: Drawing) -> Drawing:
    """The drawing with whose ink paths are compared: of lines and solid areas, rims in place of these."""
    from morfax.tracer.ink.lines_and_rims import lines_and_rims

    return lines_and_rims(drawing) if drawing.both else drawing


def from_path(
    path: Path,
    reference: Path,
    names: tuple[str, str] = ("a", "b"),
    listener: Listener = SILENT,
) -> Comparison:
    """Compare a path with another one; `names` are what the figures call the two."""
    from morfax.motion.contour import distance, pointwise

    with listener.progress("comparing", 3.0) as advance:
        found = distance(path, reference, lambda share: advance(2.0 * share))
        along = pointwise(path, reference, SAMPLE_MM, lambda share: advance(2.0 + share))
    rows = {
        f"{names[0]}_to_{names[1]}": _row(found.path_to_reference),
        f"{names[1]}_to_{names[0]}": _row(found.reference_to_path),
    }
    return Comparison(rows, found.hausdorff_mm, *along)


def from_drawing(
    drawing: Drawing, path: Path, name: str = "path", radius_mm: float = 0.0
) -> Comparison:
    """Compare a path with the ink of its drawing; with a cutter's radius, what the cutter's edge touches.

    Leads through the scrap are not compared.
    """
    from morfax.motion.lead_parts import without_leads
    from morfax.tracer.drawing.deviation import deviation, touched

    path = without_leads(path)

    found = (
        deviation(drawing, touched(drawing, path, radius_mm), [path.xy_mm])
        if radius_mm
        else deviation(drawing, path)
    )
    row = {"rms_mm": found.rms_mm, "p95_mm": found.p95_mm, "max_mm": found.max_mm}
    row["measured_share"] = found.measured_share
    missed = {"missed_ink_mm": found.missed_mm, "missed_ink_share": found.missed_share}
    return Comparison(
        {f"{name}_to_ink": row},
        found.max_mm,
        found.points_mm,
        found.error_mm,
        missed,
        found.measured_share,
    )


def _row(summary: Summary) -> Figures:
    """One way of a comparison as figures."""
    return {"rms_mm": summary.rms_mm, "p95_mm": summary.p95_mm, "max_mm": summary.max_mm}
