"""The options of a drawing: scale, flattening, page, ink, filled shapes."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from morfax.console.options.files import FILE
from morfax.console.options.groups import Decorator, given_all, option
from morfax.console.options.types import BAR, FLATTEN, LENGTH, PIXELS
from morfax.jobs.settings.correction_settings import CorrectionSettings
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.flattening import FlattenSettings
from morfax.recorder.drawings.drawn_units import UNITS_MM

if TYPE_CHECKING:
    from morfax.tracer.drawing.scale import Known


# of a drawing from CAD: DXF, SVG, HP-GL
DRAWN_UNIT = option(
    "Drawing",
    "--unit",
    "drawn_unit",
    type=click.Choice(tuple(UNITS_MM)),
    help="Unit of a drawing from CAD (.dxf, .svg).  [default: what the file says]",
)


def _known(
    ctx: click.Context, param: click.Parameter, value: tuple[Any, Any, Any] | None
) -> Known | None:
    """Two places and the length between them."""
    if value is None:
        return None
    from morfax.tracer.drawing.scale import Known

    return Known(*value)


def _colour(ctx: click.Context, param: click.Parameter, value: str | None) -> str | None:
    """A colour as it was given; wrong use if it is none."""
    if value is not None:
        from morfax.tracer.drawing.inks import parsed

        try:
            parsed(value)
        except ValueError as error:
            raise click.BadParameter(str(error)) from None
    return value


_DRAWING = (
    option(
        "Drawing",
        "--dpi",
        type=click.FloatRange(min=0, min_open=True),
        help="Resolution of the drawing, dots per inch; of a PDF's drawn lines: how finely they are "
        "rendered.  [default: what the file states; 600]",
    ),
    option(
        "Drawing",
        "--width",
        "width_mm",
        type=LENGTH,
        help="Width of the whole sheet, such as 120mm; instead of --dpi.",
    ),
    option(
        "Drawing",
        "--known",
        nargs=3,
        type=(PIXELS, PIXELS, LENGTH),
        callback=_known,
        metavar="X,Y X,Y LENGTH",
        help="Two places in pixels (columns from the left, rows from the top, as picture viewers show) "
        "and the length between them, such as 210,305 2572,310 200mm; instead of --dpi.",
    ),
    option(
        "Drawing",
        "--page",
        type=click.IntRange(min=1),
        help="Page of a file that has several: a PDF, a TIFF, moving pictures.  [default: the first]",
    ),
    option(
        "Drawing",
        "--ink",
        callback=_colour,
        metavar="COLOUR",
        help="Colour of the line, such as blue or '#0000c0': other colours, such as a printed grid, "
        "count as paper; or `dark` or `light`, if the sheet leaves it in doubt.  "
        "[default: all that is darker than the paper, or lighter than dark paper]",
    ),
    option(
        "Drawing",
        "--edge",
        is_flag=True,
        help="Filled shapes: the head follows their edges; with `--lines all` lines keep to their middle.",
    ),
    option(
        "Drawing",
        "--paper",
        type=click.Choice(("auto", "plain", "squared", "ruled")),
        default="auto",
        show_default=True,
        help="Leave out the printed lines of squared (also millimetre) or ruled paper, even where they are "
        "as dark as the drawing. auto: where they run over the whole sheet, or are paler or many squares "
        "with a margin; squared, ruled: wherever they run, and refuse a sheet without them; plain: leave "
        "nothing out.",
    ),
    option(
        "Drawing",
        "--flatten",
        "wanted",
        type=FLATTEN,
        metavar="WAY",
        help="Make a photograph flat and to scale: by the marks of a printed sheet (marks), by the "
        "edges of the sheet (paper=a4, letter, a3, 148x105mm), or by four places of a rectangle, in "
        'pixels from the upper left, clockwise ("X,Y X,Y X,Y X,Y=200x100mm"); auto takes marks, else the '
        "one format that fits.  [default: auto for a picture that a camera made]",
    ),
    option(
        "Drawing",
        "--bar",
        "bar_mm",
        type=BAR,
        help="Length of the bar on a printed sheet with marks, such as 99.6mm.  [default: 100mm]",
    ),
    option(
        "Drawing",
        "--corrections",
        "corrections_file",
        type=FILE,
        metavar="FILE",
        help="Corrections of the drawing (.morfax.toml), see morfax correct.  [default: the drawing's "
        "name with .morfax.toml beside it, if it is there]",
    ),
    option(
        "Drawing",
        "--no-corrections",
        is_flag=True,
        help="Read the drawing without its corrections.",
    ),
)


def drawing_options(argument: str) -> Decorator:
    """Give a verb the options of a drawing, and hand it the drawing of an argument, or each of several, as a
    DrawingFile.
    """

    def with_options(verb: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(verb)
        def with_drawing(*args: Any, **options: Any) -> Any:
            names = ("dpi", "width_mm", "ink", "edge", "paper", "page", "known")
            how = {name: options.pop(name) for name in names}
            how["flatten"] = FlattenSettings(options.pop("wanted"), options.pop("bar_mm"))
            used = not options.pop("no_corrections")
            how["corrections"] = CorrectionSettings(options.pop("corrections_file"), used)
            files = options[argument]
            if isinstance(files, tuple):
                options[argument] = tuple(DrawingFile(file, **how) for file in files)
            else:
                options[argument] = DrawingFile(files, **how)
            return verb(*args, **options)

        return given_all(_DRAWING, with_drawing)

    return with_options
