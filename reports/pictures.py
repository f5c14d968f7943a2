"""What belongs to the result of each job beside its figures: pictures, the report, the figures in a file.

Signals in: a result of `morfax.jobs`. Out: files, each under the name that the result has for it, and only
when it is whole.
"""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.files import written_beside
from morfax.motion.units import drawn_length_mm
from morfax.reports import following, table
from morfax.reports.canvas import save
from morfax.reports.overlay import Picture, draw
from morfax.reports.sheet import draw_sheet

if TYPE_CHECKING:
    from morfax.jobs.compare import CompareResult
    from morfax.jobs.play import PlayResult
    from morfax.jobs.run import RunResult
    from morfax.jobs.settings.drawing_file import DrawingFile
    from morfax.jobs.systems import SystemsResult
    from morfax.jobs.trace import TraceResult
    from morfax.motion.faults import LineFault
    from morfax.motion.motion import Path
    from morfax.player.monitor.chart import Chart
    from morfax.tracer.drawing.drawing import Drawing

REPORT = ".html"
TOLD = (
    "One drawing, traced once ({length_mm:.1f} mm), recorded in each medium and played on each control. From "
    "ink: distance of the machine's contour from the middle of the ink; from traced: from the head's path. "
    "Corner error: the largest distance of a traced corner from the contour. Bits per mm are the medium's "
    "own: of .steps the punched ones. Speed held: share of the way run within 5 % of the tracing speed."
)


def draw_traced(result: TraceResult) -> None:
    """Draw the traced path over the drawing, with the numbers of lines and stops."""
    if result.picture is None:
        return
    file, traced = result.drawing.file, result.traced
    picture = Picture(
        f"{file.name if file else 'drawing'}, traced",
        traced.path,
        result.drawing,
        numbers_mm=traced.places_mm,
        stops_mm=traced.marked_mm,
        led=traced.led,
        left_out=traced.left_out,
    )
    draw(picture, result.picture)
    _draw_flat(result.drawing, result.picture)


def draw_start(
    drawing: DrawingFile,
    start_mm: tuple[float, float] | None,
    fault: LineFault,
    file: FilePath,
) -> None:
    """Draw the sheet with the place at which the head found no line, and the nearest line's place."""
    places = {"--start": start_mm, "nearest line": fault.nearest_mm}
    known = {name: place_mm for name, place_mm in places.items() if place_mm is not None}
    draw_sheet(drawing.open(), known, file)


def draw_run(result: RunResult) -> None:
    """Draw the played path over the drawing, its distance from the ink's centre in colour."""
    name = result.drawing.file.stem if result.drawing.file else "drawing"
    largest = drawn_length_mm(result.from_ink.largest_mm)
    picture = Picture(
        f"{name}, played: largest distance from the ink's centre {largest}",
        result.played,
        result.drawing,
        None,
        result.from_ink.points_mm,
        result.from_ink.error_mm,
        numbers_mm=result.traced.places_mm,
        stops_mm=result.traced.marked_mm,
    )
    draw(picture, result.picture)
    _draw_flat(result.drawing, result.picture)


def write_figures(result: RunResult) -> None:
    """Write the figures of a run as JSON."""
    with written_beside(result.report) as beside:
        beside.write_text(table.as_json(result.figures) + "\n", encoding="utf-8")


def draw_compared(result: CompareResult, names: str, file: FilePath) -> None:
    """Draw the first path, its error in colour, over what it was compared with."""
    found, paths = result.found, result.paths
    reference = paths[1] if len(paths) > 1 else None
    picture = Picture(
        f"{names}: largest distance {drawn_length_mm(found.largest_mm)}",
        paths[0],
        result.drawing,
        reference,
        found.points_mm,
        found.error_mm,
        path_called="middle of the tool" if result.is_beside else "",
    )
    draw(picture, file)
    if result.drawing is not None:
        _draw_flat(result.drawing, file)


def draw_played(result: PlayResult, name: str) -> None:
    """Draw the machine's path, and write its following errors, where they are asked for."""
    from morfax.jobs.play import is_picture

    for file in filter(is_picture, result.paths):
        assert result.path is not None
        _draw_path(result.path, file, f"{name}, played")
    if result.picture is not None:
        assert result.path is not None and result.chart is not None
        draw(_followed(result.path, result.chart, f"{name}, played"), result.picture)
    for file in result.charts:
        assert result.chart is not None
        title = f"{name}: following error against its limit"
        following.write(result.chart, file, title, result.speeds)


def _followed(path: Path, chart: Chart, title: str) -> Picture:
    """The machine's path with the following error of X and Y in colour, where the tool is in the work.

    Of each axis the error is that which came nearest to its limit within the chart's stretch of time.
    """
    in_work = np.interp(chart.t_s, path.t_s, path.tool) > 0
    x_mm, y_mm = (np.interp(chart.t_s, path.t_s, along) for along in path.xy_mm.T)
    error_mm = np.hypot(*chart.error_mm[:, :2].T)
    points_mm = np.column_stack([x_mm, y_mm])
    return Picture(title, path, points_mm=points_mm[in_work], error_mm=error_mm[in_work])


def draw_systems(result: SystemsResult, file: FilePath) -> None:
    """Write the report of all systems (.html), or the picture of all contours alone."""
    from morfax.jobs.systems import corner_places
    from morfax.reports import report, side_by_side

    drawing, traced, results = result.drawing, result.traced, result.results
    name = drawing.file.name if drawing.file else "drawing"
    title = f"{name} on {len(results)} systems"
    corners_mm = corner_places(traced.path)
    contours = side_by_side.contours(title, results, traced.path, drawing, corners_mm)
    if file.suffix.lower() != REPORT:
        save(contours, file)
        return
    pictures = [
        ("All contours; the numbered places enlarged, with axes in µm", contours),
        ("Distance from the ink's centre along the contour", side_by_side.errors(results)),
    ]
    for one in results:
        if one.chart is not None:
            said = f"{one.name}: following error against its limit"
            pictures.append((said, following.picture(one.chart, said, one.speeds)))
    told = [TOLD.format(length_mm=traced.trace.length_mm)]
    report.write(file, title, told, result.rows, pictures)


def draw_punched(program: FilePath, file: FilePath) -> int:
    """Draw the punched tape of a step program; the number of rows that the picture shows."""
    from morfax.recorder.steps.file import read_program
    from morfax.reports import punched

    return punched.draw_tape(read_program(program), file)


def _draw_flat(drawing: Drawing, beside: FilePath) -> None:
    """Draw how a photograph was made flat, if the drawing is one, beside another picture."""
    from morfax.jobs.settings.flattening import picture_beside
    from morfax.reports.flattening import draw_flattening

    file = picture_beside(beside, drawing)
    if file is not None:
        draw_flattening(drawing, file)


def _draw_path(path: Path, file: FilePath, title: str) -> None:
    """Draw a path in its true size (.svg), or as a picture."""
    if file.suffix.lower() == ".svg":
        from morfax.reports.svg import write_svg

        write_svg(path, file)
    else:
        draw(Picture(title, path), file)
