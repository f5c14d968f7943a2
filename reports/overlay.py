"""Pictures: the path over its drawing, with the error along the contour in colour.

Signals in: a path, and what it was compared with: the drawing it came from, or another path, with the error
at each of some points along the contour, all in mm. Out: a picture; its axes are sheet coordinates in mm. The
worst places are shown once more, enlarged until the error can be seen.

A .png is drawn by `bitmap`, which needs no matplotlib, other kinds by `vector`, which does.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.motion import Path
from morfax.motion.units import POINTS_PER_INCH
from morfax.reports import corrected, labels, leaders, left_out
from morfax.reports.canvas import (
    COMPRESSION,
    DPI,
    FLATTEST,
    LIGHT,
    REFERENCE,
    UM_PER_MM,
    grey,
    save,
    write,
)
from morfax.reports.coloured import error_lines
from morfax.reports.looks import (
    BELOW_PT,
    BESIDE_PT,
    BOLD_PT,
    LINE_PT,
    ON_SPOTS,
    SPOT_PT,
    THIN_PT,
    WORDS_PT,
)
from morfax.reports.page import INSETS, PageLayout, lay_out, shortened
from morfax.reports.plate import (
    BLACK,
    Caption,
    Colours,
    Plate,
    Polyline,
    Spot,
    TintedArea,
    View,
    has_free_corner,
    with_gaps,
)

if TYPE_CHECKING:
    from morfax.jobs.remarks.who_led import WhoLed
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.ink.left_out import Area

PLAIN = "#c1121f"
RAISED = "#1f5fbf"  # stops, and ways with the tool up
UNMEASURED = "#8a8a8a"  # the path where its error cannot be measured
MARGIN_SHARE = 0.06  # of the larger side, round the path
MARGIN_RIGHT = 0.28  # of the width: room for a legend where no corner is free
# along an enlargement: each number of all takes a hundredth of a picture's time
FEW_NUMBERS = 4
PIXELS = ".png"
MOST_NUMBERED = 60  # lines; chosen


@dataclass(frozen=True, slots=True)
class Picture:
    """What a picture shows: a path, its reference, and the error at points along it."""

    title: str
    path: Path
    drawing: Drawing | None = None
    reference: Path | None = None
    points_mm: Array | None = None  # (n, 2)
    error_mm: Array | None = None  # (n,); not a number where it cannot be measured
    # numbers of lines, and where each begins; where the head stops, by name
    numbers_mm: Sequence[tuple[str, tuple[float, float]]] = ()
    stops_mm: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    led: WhoLed | None = None  # who led the head, in colours
    left_out: Sequence[Area] = ()  # ink along which no stroke was to run
    path_called: str = ""  # in the legend, where the points do not lie on the path


def draw(picture: Picture, file: FilePath) -> None:
    """Write the picture, of the kind that the suffix says (.png, .svg, .pdf)."""
    places, view = _worst_places(picture), view_of(picture)
    page, main, scale = _laid_out(picture, view, len(places))
    if main.legend and not has_free_corner(main, _legend_share(main, page)):
        page, main, scale = _laid_out(picture, _with_margin(view), len(places))
    plates = [(page.main, main)]
    for number, (box, place_mm) in enumerate(zip(page.insets, places, strict=True), 1):
        plates.append((box, _enlarged(picture, place_mm, number)))
        at = (float(place_mm[0]), float(place_mm[1]))
        main.add(
            Spot(at, "+", SPOT_PT, BLACK, order=ON_SPOTS),
            Caption(at, str(number), WORDS_PT, offset_pt=BESIDE_PT),
        )
    labels.spread(
        main, page.main.width_in * POINTS_PER_INCH, page.main.height_in * POINTS_PER_INCH
    )
    if file.suffix.lower() == PIXELS:
        from morfax.reports import bitmap

        write(bitmap.encoded(bitmap.drawn(page, plates, scale), COMPRESSION), file)
    else:
        from morfax.reports import vector

        save(vector.figure_of(page, plates, scale), file, trim=False)


def _laid_out(
    picture: Picture, view: View, insets: int
) -> tuple[PageLayout, Plate, Colours | None]:
    """The page for a view, the whole contour on it, and what its colours mean."""
    shape = (view[3] - view[2]) / (view[1] - view[0])
    page = lay_out(shape, insets, has_bar=_is_measured(picture))
    return page, *_whole(picture, view, page)


def _legend_share(plate: Plate, page: PageLayout) -> tuple[float, float]:
    """How much of the main axes' width and height the legend takes."""
    from morfax.reports.lettering import legend_share

    return legend_share(plate, page.main.width_in * DPI, page.main.height_in * DPI)


def _with_margin(view: View) -> View:
    """The same view with room for a legend on its right."""
    left, right, low, high = view
    return left, left + (right - left) / (1 - MARGIN_RIGHT), low, high


def _whole(picture: Picture, view: View, page: PageLayout) -> tuple[Plate, Colours | None]:
    """The whole contour with its marks, and what its colours mean."""
    title = picture.title
    if len(picture.numbers_mm) > MOST_NUMBERED:
        title += (
            f"; the {MOST_NUMBERED} longest of {len(picture.numbers_mm)} lines have numbers"
        )
    plate = Plate(view, shortened(title, page.main.title_letters))
    _ground(plate, picture)
    scale = _contour(plate, picture)
    if picture.led is not None:
        plate.add(*leaders.lines(picture.led))
    _ends(plate, picture.path)
    _numbers(plate, picture)
    _stops(plate, picture)
    plate.add(*left_out.marks(picture.left_out))
    if picture.drawing is not None and picture.drawing.corrected is not None:
        plate.add(*corrected.marks(picture.drawing.corrected))
    return plate, scale


def _ground(plate: Plate, picture: Picture) -> None:
    """Draw what the path was compared with: the drawing in light grey, or the other path."""
    if picture.drawing is not None:
        plate.ground = grey(picture.drawing, plate.view, LIGHT)
        plate.add(*_beside_sheet(picture.drawing.width_mm, plate.view))
    if picture.reference is not None and (runs := picture.reference.runs()):
        plate.add(Polyline(with_gaps(runs), REFERENCE, THIN_PT, dash=(4, 2), order=1))


def _beside_sheet(width_mm: float, view: View) -> list[TintedArea]:
    """What of a view lies right of the sheet: room for the legend, and no paper."""
    _, right, low, high = view
    corners = np.array([(width_mm, low), (right, low), (right, high), (width_mm, high)])
    return [TintedArea(corners, UNMEASURED, 0.2, order=1)] if right > width_mm else []


def _is_measured(picture: Picture) -> bool:
    """Whether the error is known anywhere."""
    error_mm = picture.error_mm
    if picture.points_mm is None or error_mm is None:
        return False
    return bool(np.isfinite(error_mm).any())


def _contour(plate: Plate, picture: Picture) -> Colours | None:
    """Draw the path, its error in colour if that is known; gives what the colours mean."""
    measured = _is_measured(picture)
    if runs := picture.path.runs():
        colour = UNMEASURED if measured else PLAIN
        plate.add(Polyline(with_gaps(runs), colour, LINE_PT, label=picture.path_called))
    if not measured:
        return None
    assert picture.points_mm is not None and picture.error_mm is not None
    lines, scale = error_lines(picture.points_mm, picture.error_mm, plate.view, BOLD_PT)
    plate.add(*lines)
    return scale


def _ends(plate: Plate, path: Path) -> None:
    """Mark where the path starts and where it ends in the work."""
    runs = path.runs()
    if not runs:
        return
    x, y = runs[0][0].tolist()
    end_x, end_y = runs[-1][-1].tolist()
    plate.add(
        Spot((x, y), "o", SPOT_PT, "#2a7f3f", "start"),
        Spot((end_x, end_y), "s", SPOT_PT, "#7a3fa0", "end"),
    )


def _numbers(plate: Plate, picture: Picture) -> None:
    """Number several lines, each beside its start, in a ring: the enlargements have plain numbers.

    Of very many lines only the longest, which have the lowest numbers: the rings would hide the path.
    """
    numbers = sorted((number for number, _ in picture.numbers_mm), key=lambda it: (len(it), it))
    beside_pt = -BELOW_PT[0], BELOW_PT[1]
    longest = set(numbers[:MOST_NUMBERED])
    for number, place_mm in picture.numbers_mm:
        if number in longest:
            plate.add(Caption(place_mm, number, WORDS_PT, offset_pt=beside_pt, ring=REFERENCE))


def _stops(plate: Plate, picture: Picture) -> None:
    """Mark the stops, and the ways with the tool up."""
    if not picture.stops_mm:
        return
    raised = np.where(picture.path.tool[:, None], np.nan, picture.path.xy_mm)
    plate.add(Polyline(raised, RAISED, LINE_PT, dash=(4, 2), label="tool up"))
    written, named = labels.shortened(picture.stops_mm), set[str]()
    for name, place_mm in picture.stops_mm.items():
        words, label = written[name]
        plate.add(
            Spot(
                place_mm, "D", SPOT_PT, RAISED, "" if label in named else label, order=ON_SPOTS
            )
        )
        plate.add(Caption(place_mm, words, WORDS_PT, RAISED, BESIDE_PT))
        named.add(label)


def _enlarged(picture: Picture, place_mm: Array, number: int) -> Plate:
    """One of the worst places so large that its error can be seen."""
    assert picture.points_mm is not None and picture.error_mm is not None
    error_mm = float(
        np.nanmax(np.abs(picture.error_mm[(picture.points_mm == place_mm).all(axis=1)]))
    )
    reach_mm = float(np.clip(20 * error_mm, 0.5, 4.0))
    x, y = (float(side) for side in place_mm)
    view = (x - reach_mm, x + reach_mm, y - reach_mm, y + reach_mm)
    title = f"{number}: {error_mm * UM_PER_MM:.3g} µm at {x:.1f}, {y:.1f}"
    plate = Plate(
        view, title, WORDS_PT, numbers_pt=WORDS_PT, most_numbers=FEW_NUMBERS, names=None
    )
    _ground(plate, picture)
    _contour(plate, replace(picture, path_called=""))  # the whole contour's legend says it
    return plate


def _worst_places(picture: Picture) -> list[Array]:
    """The places with the largest error, apart from each other."""
    if picture.points_mm is None or picture.error_mm is None:
        return []
    left = np.nan_to_num(np.abs(picture.error_mm))
    apart_mm = 0.12 * float(np.ptp(picture.points_mm, axis=0).max(initial=0.0))
    places: list[Array] = []
    while len(places) < INSETS and left.max(initial=0.0) > 0:
        worst = picture.points_mm[int(left.argmax())]
        places.append(worst)
        left[np.hypot(*(picture.points_mm - worst).T) < apart_mm] = 0
    return places


def view_of(picture: Picture) -> View:
    """The part of the sheet to show, mm: what was compared, or the whole sheet without an error to see."""
    if picture.drawing is not None and picture.points_mm is None:
        return 0.0, picture.drawing.width_mm, 0.0, picture.drawing.height_mm
    parts = [
        run
        for path in (picture.path, picture.reference)
        if path is not None
        for run in path.runs()
    ]
    every = np.vstack(parts) if parts else picture.path.xy_mm
    low, high = every.min(axis=0), every.max(axis=0)
    longer_mm = max(float((high - low).max()), 1.0)
    margin = np.maximum(MARGIN_SHARE * longer_mm, (FLATTEST * longer_mm - (high - low)) / 2)
    low, high = low - margin, high + margin
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])
