"""The systems side by side: one traced contour recorded in each medium, played on each control, and measured.

Signals in: a drawing and what the head traced of it. Signals out: for each system the path that its machine
ran and its figures, or the fault that kept it from running; the others go on.

    drawing ─► head ─► traced ─┬─► .wav   ─► phase-locked drives ─────► path ─┐
                               ├─► .steps ─► stepping motors ─────────► path ─┤ against the ink's centre,
                               ├─► .cubic ─► difference interpolator ─► path ─┤ the traced path, its corners
                               └─► .ngc   ─► pulse interpolator ──────► path ─┘
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.machine.playing import Playing
from morfax.jobs.media import files as medium
from morfax.jobs.readings import comparison, following
from morfax.jobs.results import NAMES, SystemResult
from morfax.jobs.settings import correction_settings, flattening
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.settings import TraceSettings
from morfax.jobs.tracing.tracing import Tracing
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.arrays import NOT_ZERO
from morfax.motion.faults import Fault
from morfax.motion.plane import SAME_MM

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.jobs.tracing.traced import Traced
    from morfax.motion.arrays import Array
    from morfax.motion.motion import Path
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.operator.operator import Panel

HELD_SHARE = 0.05  # of the tracing speed, either way
HELD_OVER_S = 0.5  # a step of 10 um is a fivehundredth of the way at 10 mm/s
CORNER_RAD = 0.5  # of turn within 50 um
WINDOW_MM = 0.05
# points of a path that are nearer than this have no direction between them


@dataclass(frozen=True, slots=True)
class SystemsResult:
    """What the comparison gave: figures, the drawing and its traced path, and the result of each system.

    `rows` are the table's: the head's own path, then each system, by name. `faults` are those of a lost line
    and of systems that did not run. `within` the tolerance is None without one. A face draws both.
    """

    figures: Figures
    rows: dict[str, Figures]
    drawing: Drawing
    traced: Traced
    results: tuple[SystemResult, ...]
    within: bool | None
    faults: tuple[Fault, ...]


@dataclass(frozen=True, slots=True)
class SystemsJob:
    """Trace a drawing once, record it in the medium of each system, play it on its control, and compare.

    `report` (.html) and `picture` are names that a face draws to.
    """

    drawing: DrawingFile
    systems: tuple[str, ...] = tuple(NAMES)
    tolerance_mm: float | None = None
    report: FilePath | None = None
    picture: FilePath | None = None
    settings: TraceSettings = field(default_factory=TraceSettings)

    def run(self, listener: Listener = SILENT, panel: Panel | None = None) -> SystemsResult:
        """Trace, play and measure; a system's fault is in the result, and the others go on."""
        # 1. what is asked for
        file = self.drawing.file
        tracing = Tracing.prepared(self.settings, panel)
        for output in (self.report, self.picture):
            if output is not None:
                medium.outgoing(output, file)
        if medium.kind_of(file) != "drawing":
            raise WrongUse(
                f"{file} is no drawing; --systems traces a drawing and plays it on each system: give a scan, "
                "such as a .png"
            )
        # 2. trace, record, play, measure
        drawing = self.drawing.for_lines(tracing.settings.line).open(listener)
        traced = tracing.trace(drawing, listener)
        ink = comparison.measured_on(drawing)
        measured = _Measuring(ink, traced, tracing.of_head.speed_mm_s)
        results = measured.systems(self.systems, listener)
        # 3. judge
        largest_mm = max((r.from_ink.largest_mm for r in results if r.from_ink), default=0.0)
        within = None if self.tolerance_mm is None else largest_mm <= self.tolerance_mm
        rows = {"traced": measured.traced_row(), **{r.name: r.figures for r in results}}
        figures = {
            "drawing": str(file),
            "report": None if self.report is None else str(self.report),
            "picture": None if self.picture is None else str(self.picture),
            **flattening.figures(drawing),
            **correction_settings.figures(drawing),
            "tolerance_mm": self.tolerance_mm,
            "within_tolerance": within,
            "ending": traced.trace.ending,
            "length_mm": traced.trace.length_mm,
            "corners": len(corner_places(traced.path)),
        }
        every = (traced.fault, *(result.fault for result in results))
        faults = tuple(fault for fault in every if fault is not None)
        return SystemsResult(figures, rows, drawing, traced, tuple(results), within, faults)


@dataclass(frozen=True, slots=True)
class _Measuring:
    """What every system is measured against: the drawing, the traced path and the tracing speed."""

    drawing: Drawing
    traced: Traced
    speed_mm_s: float

    def systems(self, asked: tuple[str, ...], listener: Listener) -> list[SystemResult]:
        """Record, play and measure each system that is asked for."""
        from morfax.player.controls import CONTROLS
        from morfax.recorder.media import MEDIA

        packages = ("motion", "recorder", "player")
        listener.compiling("recorders and controls", packages)
        results = []
        with (
            tempfile.TemporaryDirectory(prefix="morfax-") as folder,
            listener.progress("comparing", len(asked)) as advance,
        ):
            for done, suffix in enumerate(asked, 1):
                what = MEDIA[f".{suffix}"].what
                by = CONTROLS[f".{suffix}"].what
                listener.note(f"{NAMES[suffix]}: {what}, played by {by}")
                try:
                    results.append(self._system(FilePath(folder) / f"part.{suffix}"))
                except Fault as fault:
                    said = " ".join(str(fault).split())
                    results.append(SystemResult(suffix, {"fault": said}, fault=fault))
                advance(done)
        return results

    def traced_row(self) -> Figures:
        """The figures of the head's own path, to set the others against."""
        path = self.traced.path
        row = comparison.from_drawing(self.drawing, path).rows["path_to_ink"]
        return {
            **_from_ink(row),
            "duration_s": _duration_s(path),
            **held(path, self.speed_mm_s),
        }

    def _system(self, file: FilePath) -> SystemResult:
        """One system; raises what its recorder or its control raises."""
        from morfax.recorder.media import record

        # 1. record and play
        trace, chart = self.traced.trace, following.new_chart(raw=False)
        recording = record(trace, file)
        played = Playing(file, chart=chart).whole(SILENT)
        if played.fault is not None:
            raise played.fault
        path = played.path
        # 2. measure
        from_ink = comparison.from_drawing(self.drawing, path)
        from_traced = comparison.from_path(path, self.traced.path)
        bits = medium.recorder_figures(recording).get("punched_bits", 8 * recording.bytes)
        corners_mm = corner_places(self.traced.path)
        figures = {
            **_from_ink(from_ink.rows["path_to_ink"]),
            "from_traced_rms_mm": from_traced.rows["a_to_b"]["rms_mm"],
            "from_traced_max_mm": from_traced.largest_mm,
            "corner_error_mm": corner_error_mm(corners_mm, path),
            "duration_s": _duration_s(path),
            "bytes_per_mm": round(recording.bytes / trace.length_mm, 1),
            "bits_per_mm": round(bits / trace.length_mm, 1),
            **held(path, self.speed_mm_s),
            "following_error_mm": float(played.playback.following_error_mm.max()),
        }
        speeds = following.speeds_held(played.playback)
        suffix = file.suffix[1:]
        return SystemResult(suffix, figures, path, from_ink, from_traced, chart, speeds)


def corner_places(path: Path) -> Array:
    """Where a path turns sharply with the tool in the work, (n, 2) mm."""
    from morfax.motion.segments import Limits, corners

    # speeds do not matter here
    limits = Limits(1.0, 1.0, window_mm=WINDOW_MM, corner_rad=CORNER_RAD)
    found = [np.zeros((0, 2))]
    for run in path.runs():
        points = run[np.r_[True, np.hypot(*np.diff(run, axis=0).T) > SAME_MM]]
        if len(points) > 2:
            found.append(points[corners(points, limits)])
    return np.vstack(found)


def held(path: Path, speed_mm_s: float) -> Figures:
    """The mean speed in the work, and the share of the way there that is run within 5 % of a speed."""
    from morfax.motion.motion import IN_WORK_BELOW_MM

    t_s = np.arange(path.t_s[0], path.t_s[-1], HELD_OVER_S)
    places_mm = np.column_stack(
        [np.interp(t_s, path.t_s, column) for column in path.positions_mm.T]
    )
    way_mm = np.sqrt((np.diff(places_mm, axis=0) ** 2).sum(axis=1))
    works = places_mm[:, 2] <= IN_WORK_BELOW_MM
    way_mm = way_mm[works[1:] & works[:-1]]
    holds = np.abs(way_mm / (HELD_OVER_S * speed_mm_s) - 1) <= HELD_SHARE
    share = float(way_mm[holds].sum() / max(way_mm.sum(), NOT_ZERO))
    return {
        "mean_speed_mm_s": float(way_mm.mean() / HELD_OVER_S) if len(way_mm) else None,
        "speed_held_share": share,
    }


def _from_ink(row: Figures) -> dict[str, Any]:
    """The contour's error."""
    return {"from_ink_rms_mm": row["rms_mm"], "from_ink_max_mm": row["max_mm"]}


def corner_error_mm(corners_mm: Array, path: Path) -> float | None:
    """The largest distance of a traced corner's vertex from the path; None without corners."""
    from morfax.motion.contour import distances_mm

    return float(distances_mm(corners_mm, path).max()) if len(corners_mm) else None


def _duration_s(path: Path) -> float:
    """How long a path takes, s."""
    return float(path.t_s[-1] - path.t_s[0])
