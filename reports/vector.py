"""Plates as SVG and PDF, drawn by matplotlib; and plates' marks on the axes of other pictures.

Signals in: plates and the boxes in which they stand. Signals out: a figure of matplotlib.

matplotlib takes most of a second to import: nothing here does it before it is asked for. PNG pictures are
drawn without it (`bitmap`), with the same looks.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from morfax.reports.axis_numbers import numbers
from morfax.reports.canvas import DPI, new_figure
from morfax.reports.lettering import PAD, legend_share
from morfax.reports.looks import AWAY_PT, NAMES, SEE_THROUGH, WORDS_PT
from morfax.reports.page import Box, PageLayout
from morfax.reports.plate import (
    Caption,
    Colours,
    Mark,
    Plate,
    Polyline,
    Spot,
    TintedArea,
    free_corner,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def figure_of(
    page: PageLayout, plates: Sequence[tuple[Box, Plate]], scale: Colours | None
) -> Figure:
    """A page with all its plates and its scale of colours."""
    figure = new_figure(page.width_in, page.height_in, layout="none")

    def axes(box: Box) -> Axes:
        left = box.left_in / page.width_in
        bottom = box.bottom_in / page.height_in
        across = box.width_in / page.width_in
        up = box.height_in / page.height_in
        return figure.add_axes((left, bottom, across, up))

    for box, plate in plates:
        _fill(axes(box), plate, (box.width_in * DPI, box.height_in * DPI))
    if scale is not None and page.bar is not None:
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import LinearSegmentedColormap, Normalize

        colours = LinearSegmentedColormap.from_list("error", list(scale.colours))
        coloured = ScalarMappable(Normalize(0, scale.largest), colours)
        figure.colorbar(
            coloured, cax=axes(page.bar), orientation="horizontal", label=scale.label
        )
    return figure


def put(axes: Axes, mark: Mark) -> None:
    """Draw one mark on axes."""
    if isinstance(mark, Polyline):
        _line(axes, mark)
    elif isinstance(mark, Spot):
        axes.plot(
            *mark.place_mm,
            marker=mark.shape,
            markersize=mark.size_pt,
            markerfacecolor="none",
            color=mark.colour,
            linestyle="none",
            label=mark.label or None,
            zorder=mark.order,
        )
    elif isinstance(mark, TintedArea):
        from matplotlib.patches import Polygon

        edge = mark.colour if mark.edged else "none"
        filled: dict[str, Any] = {"facecolor": mark.colour, "edgecolor": edge}
        filled |= {"alpha": mark.alpha, "label": mark.label or None, "zorder": mark.order}
        axes.add_patch(Polygon(mark.corners_mm, **filled))
    else:
        _words(axes, mark)


def _fill(axes: Axes, plate: Plate, size_px: tuple[float, float]) -> None:
    """Draw a plate on axes of its own, which would have such a size as pixels."""
    if plate.ground is not None:
        grey: dict[str, Any] = {"cmap": "gray", "vmin": 0, "vmax": 255, "zorder": 0}
        axes.imshow(
            plate.ground.grey, extent=plate.ground.extent, interpolation="nearest", **grey
        )
    for mark in plate.marks:
        put(axes, mark)
    axes.set(xlim=plate.view[:2], ylim=plate.view[2:], aspect="equal")
    axes.set_title(plate.title, fontsize=plate.title_pt)
    axes.tick_params(labelsize=plate.numbers_pt, length=AWAY_PT / 2, pad=AWAY_PT / 2)
    if plate.most_numbers is not None:
        for ticks, (first, last) in (
            (axes.set_xticks, plate.view[:2]),
            (axes.set_yticks, plate.view[2:]),
        ):
            values = numbers(first, last, plate.most_numbers)
            ticks([value for value, _ in values], [text for _, text in values])
    if plate.names is not None:
        axes.set_xlabel(plate.names[0], labelpad=AWAY_PT)
        axes.set_ylabel(plate.names[1], labelpad=AWAY_PT)
    if plate.legend:
        is_upper, is_right = free_corner(plate, legend_share(plate, *size_px))
        corner: Any = f"{'upper' if is_upper else 'lower'} {'right' if is_right else 'left'}"
        room: dict[str, Any] = {"borderpad": PAD, "handletextpad": PAD}
        axes.legend(loc=corner, fontsize=WORDS_PT, framealpha=SEE_THROUGH, **room)


def _line(axes: Axes, line: Polyline) -> None:
    """Draw a line with its gaps."""
    style: dict[str, Any] = {"linewidth": line.width_pt, "solid_capstyle": "round"}
    if line.dash is not None:
        style["linestyle"] = (0, line.dash)
    style |= {"label": line.label or None, "zorder": line.order}
    axes.plot(*line.places_mm.T, color=line.colour, **style)


def _words(axes: Axes, words: Caption) -> None:
    """Write words beside a place, or with their middle on it."""
    style: dict[str, Any] = {"fontsize": words.size_pt, "color": words.colour, "zorder": NAMES}
    if words.ring:
        style["bbox"] = {
            "boxstyle": "circle,pad=0.2",
            "facecolor": "white",
            "edgecolor": words.ring,
            "alpha": SEE_THROUGH,
        }
    if words.centred:
        style |= {"ha": "center", "va": "center"}
    axes.annotate(
        words.text, words.place_mm, words.offset_pt, textcoords="offset points", **style
    )
