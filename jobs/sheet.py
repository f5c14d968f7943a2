"""The job `sheet`: a sheet with marks, on which one draws and which a photograph is made flat by."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.jobs.media import files as medium
from morfax.jobs.wrong_use import settings_checked

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.tracer.flatten.layout import Layout


@dataclass(frozen=True, slots=True)
class SheetResult:
    """The sheet, the name under which it belongs, and figures. The face draws it."""

    figures: Figures
    layout: Layout
    file: FilePath
    grid: bool


@dataclass(frozen=True, slots=True)
class SheetJob:
    """Lay out a sheet with marks on a format of paper."""

    file: FilePath
    paper: str = "a4"
    grid: bool = True

    def run(self) -> SheetResult:
        """Lay it out; raises WrongUse for a format without marks, FileFault for a name that cannot be."""
        from morfax.tracer.flatten.layout import BAR_MM, Layout

        medium.outgoing(self.file)
        with settings_checked():
            layout = Layout.of(self.paper)
        left, bottom, right, top = layout.frame_mm
        figures = {
            "sheet": str(self.file),
            "paper": layout.paper.name,
            "width_mm": layout.paper.width_mm,
            "height_mm": layout.paper.height_mm,
            "marks": len(layout.marks_mm),
            "bar_mm": BAR_MM,
            "frame_width_mm": right - left,
            "frame_height_mm": top - bottom,
        }
        return SheetResult(figures, layout, self.file, self.grid)
