"""The systems side by side: one traced contour recorded in each medium, played on each control, and measured.

Signals in: a drawing and what the head traced of it. Signals out: for each system the path that its machine
ran and its figures, or the fault that kept it from running; the others go on.

    drawing ─► head ─► traced ─┬─► .wav   ─► phase-locked drives ───────► path ─┐
                               ├─► .steps ─► stepping motors ───────────► path ─┤ against the ink's centre,
                               ├─► .cubic ─► difference interpolator ───► path ─┤ the traced path and its corners
                               └─► .ngc   ─► pulse interpolator ────────► path ─┘
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from morfax.console.terminal.desk import Desk
from morfax.jobs import comparison
from morfax.jobs import files as medium
from morfax.jobs.playing import Controls
from morfax.motion.arrays import Array
from morfax.motion.faults import Fault
from morfax.motion.motion import IN_WORK_BELOW_MM, Path
from morfax.reports import following
from morfax.reports.table import Figures

if TYPE_CHECKING:
    from morfax.jobs.drawing import Sheet
    from morfax.jobs.traced import Traced
    from morfax.jobs.tracing import Head
    from morfax.player.monitor.chart import Chart
    from morfax.tracer.drawing.drawing import Drawing

NAMES = {
    "wav": "Morfax 1969",
    "steps": "Superior Electric 1975",
    "cubic": "SEA 1957",
    "ngc": "Pratt & Whitney 1967",
}
OUTPUTS = (".html", ".png", ".svg", ".pdf")
HELD_SHARE = 0.05  # of the tracing speed, either way
HELD_OVER_S = 0.5  # a step of 10 um is a fivehundredth of the way at 10 mm/s
CORNER_RAD = 0.5  # of turn within 50 um


class Systems(click.ParamType):
    """The systems asked for: all, or some by the suffixes of their programs."""

    name = "systems"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Any:
        """Read "all" or a list such as "wav,steps"."""
        if not isinstance(value, str):
            return value
        asked = (
            list(NAMES)
            if value.strip().lower() == "all"
            else [word.strip(" .").lower() for word in value.split(",")]
        )
        unknown = [word for word in asked if word not in NAMES]
        if unknown:
            self.fail(
                f"there is no system {unknown[0]!r}; give all, or some of {','.join(NAMES)}",
                param,
                ctx,
            )
        return tuple(dict.fromkeys(asked))


@dataclass(frozen=True, slots=True)
class Result:
    """What became of one system: its path and comparisons, or its fault; the figures are there either way."""

    suffix: str
    figures: Figures
    path: Path | None = None
    from_ink: comparison.Comparison | None = None
    from_traced: comparison.Comparison | None = None
    chart: Chart | None = None
    speeds: following.Speeds | None = None
    fault: Fault | None = None

    @property
    def name(self) -> str:
        """Whose system it is, and what its programs are called."""
        return f"{NAMES[self.suffix]} (.{self.suffix})"


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is asked of a comparison: the drawing, the systems, a report or a picture, and how far a contour
    may be off.
    """

    drawing: FilePath
    asked: tuple[str, ...]
    output: FilePath | None
    tolerance_mm: float | None


def compare(wanted: Wanted, sheet: Sheet, head: Head, desk: Desk) -> bool:
    """Trace, measure, tell and draw; whether a contour is beyond the tolerance. Raises the first fault when
    all is told.
    """
    if wanted.output is not None:
        medium.outgoing(medium.with_suffix_in(wanted.output, OUTPUTS), wanted.drawing)
    if medium.kind_of(wanted.drawing) != "drawing":
        raise click.UsageError(
            f"{wanted.drawing} is no drawing; --systems traces one and plays it on each system"
        )
    drawing = sheet.open(wanted.drawing)
    traced = head.trace(drawing, desk)
    results = measure(drawing, traced, head.speed_mm_s, wanted.asked, desk)
    largest_mm = [
        result.from_ink.largest_mm for result in results if result.from_ink is not None
    ]
    beyond = (
        wanted.tolerance_mm is not None and max(largest_mm, default=0.0) > wanted.tolerance_mm
    )
    rows = {
        "traced": traced_row(drawing, traced, head.speed_mm_s),
        **{r.name: r.figures for r in results},
    }
    if wanted.output is not None:
        _draw(wanted, drawing, traced, results, rows)
    desk.figures(
        {
            "drawing": str(wanted.drawing),
            "report": None if wanted.output is None else str(wanted.output),
            "tolerance_mm": wanted.tolerance_mm,
            "within_tolerance": None if wanted.tolerance_mm is None else not beyond,
            "ending": traced.trace.ending,
            "length_mm": traced.trace.length_mm,
            "corners": len(corner_places(traced.path)),
            **(
                {"traced": rows["traced"], **{r.suffix: r.figures for r in results}}
                if desk.json
                else rows
            ),
        }
    )
    for fault in (traced.fault, *(result.fault for result in results)):
        if fault is not None:
            raise fault
    return beyond


def _draw(
    wanted: Wanted,
    drawing: Drawing,
    traced: Traced,
    results: list[Result],
    rows: dict[str, Figures],
) -> None:
    """Write the report, or the picture of all contours alone."""
    from morfax.reports import report, side_by_side
    from morfax.reports.overlay import save

    assert wanted.output is not None
    title = f"{wanted.drawing.name} on {len(wanted.asked)} systems"
    contours = side_by_side.contours(
        title, results, traced.path, drawing, corner_places(traced.path)
    )
    if wanted.output.suffix.lower() != ".html":
        save(contours, wanted.output)
        return
    told = [
        f"One drawing, traced once ({traced.trace.length_mm:.1f} mm), recorded in each medium and played on each control. "
        "From ink: distance of the machine's contour from the middle of the ink; from traced: from the head's path. Corner "
        "error: the largest distance of a traced corner from the contour. Bits per mm are the medium's own: of .steps the "
        "punched ones. Speed held: share of the way run within 5 % of the tracing speed.",
    ]
    pictures = [
        ("All contours; the numbered places enlarged, with axes in µm", contours),
        ("Distance from the ink's centre along the contour", side_by_side.errors(results)),
    ]
    for result in results:
        if result.chart is not None:
            said = f"{result.name}: following error against its limit"
            pictures.append((said, following.picture(result.chart, said, result.speeds)))
    report.write(wanted.output, title, told, rows, pictures)


def measure(
    drawing: Drawing, traced: Traced, speed_mm_s: float, asked: Sequence[str], desk: Desk
) -> list[Result]:
    """Record, play and measure each system that is asked for."""
    from morfax.player.controls import CONTROLS
    from morfax.recorder.media import MEDIA

    desk.warn_of_compiling("recorders and controls", "motion", "recorder", "player")
    corners_mm = corner_places(traced.path)
    results = []
    with (
        tempfile.TemporaryDirectory(prefix="morfax-") as folder,
        desk.bar("comparing", len(asked)) as advance,
    ):
        for done, suffix in enumerate(asked):
            desk.note(
                f"{NAMES[suffix]}: {MEDIA[f'.{suffix}'].what}, played by {CONTROLS[f'.{suffix}'].what}"
            )
            try:
                results.append(
                    _measured(
                        drawing,
                        traced,
                        speed_mm_s,
                        corners_mm,
                        FilePath(folder) / f"part.{suffix}",
                    )
                )
            except Fault as fault:
                results.append(
                    Result(suffix, {"fault": " ".join(str(fault).split())}, fault=fault)
                )
            advance(done + 1)
    return results


def traced_row(drawing: Drawing, traced: Traced, speed_mm_s: float) -> Figures:
    """The figures of the head's own path, to set the others against."""
    row = comparison.from_drawing(drawing, traced.path).rows["path_to_ink"]
    return {
        **_from_ink(row),
        "duration_s": _duration_s(traced.path),
        **held(traced.path, speed_mm_s),
    }


def corner_places(path: Path) -> Array:
    """Where a path turns sharply with the tool in the work, (n, 2) mm."""
    from morfax.motion.segments import Limits, corners

    limits = Limits(
        1.0, 1.0, window_mm=0.05, corner_rad=CORNER_RAD
    )  # speeds do not matter here
    found = [np.zeros((0, 2))]
    for run in path.runs():
        points = run[np.r_[True, np.hypot(*np.diff(run, axis=0).T) > 1e-6]]
        if len(points) > 2:
            found.append(points[corners(points, limits)])
    return np.vstack(found)


def held(path: Path, speed_mm_s: float) -> Figures:
    """The mean speed in the work, and the share of the way there that is run within 5 % of a speed."""
    t_s = np.arange(path.t_s[0], path.t_s[-1], HELD_OVER_S)
    places_mm = np.column_stack(
        [np.interp(t_s, path.t_s, column) for column in path.positions_mm.T]
    )
    way_mm = np.sqrt((np.diff(places_mm, axis=0) ** 2).sum(axis=1))
    works = places_mm[:, 2] <= IN_WORK_BELOW_MM
    way_mm = way_mm[works[1:] & works[:-1]]
    holds = np.abs(way_mm / (HELD_OVER_S * speed_mm_s) - 1) <= HELD_SHARE
    share = float(way_mm[holds].sum() / max(way_mm.sum(), 1e-12))
    return {
        "mean_speed_mm_s": float(way_mm.mean() / HELD_OVER_S) if len(way_mm) else None,
        "speed_held_share": share,
    }


def _measured(
    drawing: Drawing, traced: Traced, speed_mm_s: float, corners_mm: Array, file: FilePath
) -> Result:
    """One system; raises what its recorder or its control raises."""
    from morfax.recorder.media import record

    chart, recording = following.new_chart(raw=False), record(traced.trace, file)
    played = Controls().play(file, Desk(quiet=True), chart=chart)
    if played.fault is not None:
        raise played.fault
    from_ink = comparison.from_drawing(drawing, played.path)
    from_traced = comparison.from_path(played.path, traced.path)
    bits = medium.told(recording).get("punched_bits", 8 * recording.bytes)
    figures = {
        **_from_ink(from_ink.rows["path_to_ink"]),
        "from_traced_rms_mm": from_traced.rows["a_to_b"]["rms_mm"],
        "from_traced_max_mm": from_traced.largest_mm,
        "corner_error_mm": _corner_error_mm(corners_mm, played.path),
        "duration_s": _duration_s(played.path),
        "bytes_per_mm": round(recording.bytes / traced.trace.length_mm, 1),
        "bits_per_mm": round(bits / traced.trace.length_mm, 1),
        **held(played.path, speed_mm_s),
        "following_error_mm": float(played.playback.following_error_mm.max()),
    }
    speeds = following.speeds_held(played.playback)
    return Result(file.suffix[1:], figures, played.path, from_ink, from_traced, chart, speeds)


def _from_ink(row: Figures) -> dict[str, Any]:
    """The contour's error."""
    return {"from_ink_rms_mm": row["rms_mm"], "from_ink_max_mm": row["max_mm"]}


def _corner_error_mm(corners_mm: Array, path: Path) -> float | None:
    """The largest distance of a corner's vertex, as traced, from the path; None where there are no corners."""
    from morfax.motion.contour import distances_mm

    return float(distances_mm(corners_mm, path).max()) if len(corners_mm) else None


def _duration_s(path: Path) -> float:
    """How long a path takes, s."""
    return float(path.t_s[-1] - path.t_s[0])
