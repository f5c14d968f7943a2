"""The drawing put in: the options that say how an image file is to be read, which become the `Sheet` of a
verb.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from morfax.console.options.types import LENGTH

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing


@dataclass(frozen=True, slots=True)
class Sheet:
    """How the operator puts a drawing in: its scale, where its file states none or a wrong one."""

    dpi: float | None = None
    width_mm: float | None = None
    ink: str | None = None
    edge: bool = False

    def open(self, file: FilePath) -> Drawing:
        """Open a drawing; at most one of the two scales may be given."""
        from morfax.tracer.drawing.drawing import Drawing

        if self.dpi is not None and self.width_mm is not None:
            raise click.UsageError("--dpi and --width were both given; give one of them")
        return Drawing.open(
            file, dpi=self.dpi, width_mm=self.width_mm, ink=self.ink, edge=self.edge
        )


def sheet_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Give a verb the options of a drawing, and hand it the `sheet`."""

    @click.option(
        "--dpi",
        type=click.FloatRange(min=0, min_open=True),
        help="Resolution of the drawing, dots per inch.  [default: what the file states]",
    )
    @click.option(
        "--width",
        "width_mm",
        type=LENGTH,
        help="Width of the whole sheet, such as 120mm; instead of --dpi.",
    )
    @click.option(
        "--ink",
        callback=_colour,
        metavar="COLOUR",
        help="The line's colour, such as blue or '#0000c0': other colours, such as a printed grid's, are taken for paper.  "
        "[default: whatever is dark]",
    )
    @click.option("--edge", is_flag=True, help="Filled shapes: the head rides on their edges.")
    @functools.wraps(verb)
    def with_sheet(
        *args: Any,
        dpi: float | None,
        width_mm: float | None,
        ink: str | None,
        edge: bool,
        **options: Any,
    ) -> Any:
        return verb(*args, sheet=Sheet(dpi, width_mm, ink, edge), **options)

    return with_sheet


def _colour(ctx: click.Context, param: click.Parameter, value: str | None) -> str | None:
    """A colour as it was given; wrong use if it is none."""
    if value is not None:
        from morfax.tracer.drawing.inks import parsed

        try:
            parsed(value)
        except ValueError as error:
            raise click.BadParameter(str(error)) from None
    return value
