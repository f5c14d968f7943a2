"""The block recorder: a motion becomes a program of lines, arcs and dwells with feeds, in RS-274.

Signals: a stream of Motion or a Path in, a `.ngc` file out, in mm, mm/min and s:

    G17 G21 G90 G94
    G0 Z2                        up to the clearance, Z alone
    G0 X7 Y18.0593               where the motion starts
    G1 Z-1 F600                  the tool goes down
    G1 X12.4 Y18.0612 F598       lines
    G3 X13.1 Y19.2 I0.2 J1.1     arcs, by the centre from where they begin
    G4 P1                        a dwell
    G0 Z2                        the tool goes up; M2 ends the program

The path is cut into stretches (`recorder.gcode.stretches`). A stretch in a plane is fitted with lines and arcs
(`recorder.gcode.arcs`), a slope with lines alone; an upright one is one line. The feed of a stretch is the speed
at which most of its length is run; a stretch above the work, or straight up, is a rapid.

Source: RS-274-D, in the words that LinuxCNC and Grbl both take: no %, no G64, F before the first G1, M2 at
the end. Questions: a motion has a speed at every place and a program a feed for each block; the control slows
down before corners by its own rules. A motion that starts at or below the surface goes to its place first and
then down. Places are written to 0.1 um, depths that are whole counts of the Z unit as such.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import MotionFault
from morfax.motion.files import written_beside
from morfax.motion.motion import IN_WORK_BELOW_MM
from morfax.motion.segments import Source, as_path
from morfax.recorder.gcode.arcs import Segment, fit
from morfax.recorder.gcode.stretches import Stretch, stretches
from morfax.recorder.report import Written

TOLERANCE_MM = 0.01
WRITTEN_MM = 1e-4  # the last digit
_LARGEST_RADIUS_MM = 10_000.0  # a way of 300 mm is 1.1 um off its chord
COUNT_MM = 0.01  # the step of the Z unit's decades
COUNT_SHARE = 0.25  # of the tolerance, at most 2 um: a depth as near to a whole count is written as that count
COUNT_REACH_MM = 0.002  # three times what thinning takes off the place where one move of Z ends and one begins
WHOLE_FEED_MM_MIN = 10.0  # a feed from here on is written without decimals


@dataclass(frozen=True, slots=True)
class BlockReport(Written):
    """What was recorded: lines (rapids too), arcs, dwells, running time, largest distance from the motion."""

    lines: int
    arcs: int
    dwells: int
    duration_s: float
    deviation_mm: float

    @property
    def figures(self) -> dict[str, Any]:
        """Further figures for the report."""
        return {
            "lines": self.lines,
            "arcs": self.arcs,
            "dwells": self.dwells,
            "deviation_mm": self.deviation_mm,
        }


def record_blocks(
    stream: Source, file: str | os.PathLike[str], *, tolerance_mm: float = TOLERANCE_MM
) -> BlockReport:
    """Record a motion as lines and arcs within a tolerance; raises MotionFault, FileFault, ValueError."""
    if not 2 * WRITTEN_MM <= tolerance_mm < math.inf:
        raise ValueError(
            f"a tolerance of {tolerance_mm} mm cannot be written; give {2 * WRITTEN_MM} mm or more"
        )
    path = as_path(stream)
    parts = list(stretches(path, tolerance_mm))
    if not parts:
        raise MotionFault(
            "the motion stands still at one place; a program needs at least two different places"
        )
    writer = _Writer(path.positions_mm[0], parts[0].speed_mm_s, tolerance_mm)
    for part in parts:
        writer.stretch(part, tolerance_mm - WRITTEN_MM)
    with written_beside(file) as beside:
        beside.write_text("\n".join([*writer.text, "M2", ""]), encoding="ascii")
    return BlockReport(
        FilePath(file),
        writer.lines,
        writer.arcs,
        writer.dwells,
        writer.duration_s,
        writer.deviation_mm,
    )


class _Writer:
    """The text of a program so far, and the place that it has reached."""

    def __init__(self, start_mm: Array, feed_mm_s: float, tolerance_mm: float) -> None:
        self.count_reach_mm = min(COUNT_REACH_MM, COUNT_SHARE * tolerance_mm)
        self.text = ["G17 G21 G90 G94"]
        self.feed = ""
        self.lines = self.arcs = self.dwells = 0
        self.duration_s = self.deviation_mm = 0.0
        self.place = self._written(start_mm)
        self._begin(feed_mm_s)

    def _begin(self, feed_mm_s: float) -> None:
        """Write the way to the start: Z alone first where that is up, last where it is down."""
        x_y, z = self._words("XY", self.place[:2]), self._words("Z", self.place[2:])
        if self.place[2] > IN_WORK_BELOW_MM:
            self.text += ["G0" + z, "G0" + x_y]
        else:
            self.text.append("G0" + x_y)
            self._write("G1", z, feed_mm_s)

    def stretch(self, stretch: Stretch, tolerance_mm: float) -> None:
        """Write a stretch, and the dwell before it."""
        if stretch.dwell_s:
            self.text.append(f"G4 P{_digits(stretch.dwell_s, 2)}")
            self.dwells += 1
        points = np.vstack([self.place, stretch.points_mm[1:]])
        length_mm = float(np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1)).sum())
        self.duration_s += length_mm / stretch.speed_mm_s + stretch.dwell_s
        if stretch.rapid or stretch.kind != "plane":
            kept, off_mm = _straightest(points, tolerance_mm)
            self.deviation_mm = max(self.deviation_mm, off_mm)
            for place in points[kept[1:]]:
                self._line(place, stretch)
            return
        for chain in fit(points[:, :2], tolerance_mm):
            self.deviation_mm = max(self.deviation_mm, chain.deviation_mm + WRITTEN_MM)
            for segment in chain.segments:
                self._segment(segment, stretch, chain.deviation_mm)

    def _segment(self, segment: Segment, stretch: Stretch, off_mm: float) -> None:
        """Write a line or an arc; an arc that its chord stands for, or of a huge radius, becomes a line."""
        place: Array = np.array([*np.round(segment.end_mm, 4), self.place[2]])
        half = segment.turned_rad / 2
        (dx, dy), bulge = (place - self.place)[:2], segment.length_mm / 2 * math.tan(half / 2)
        if abs(bulge) < WRITTEN_MM or abs(segment.curvature_per_mm) * _LARGEST_RADIUS_MM < 1:
            self._line(place, stretch)
            self.deviation_mm = max(self.deviation_mm, off_mm + abs(bulge))
            return
        out = 0.5 / math.tan(half)
        centre = dx / 2 - out * dy, dy / 2 + out * dx
        code = "G3" if half > 0 else "G2"
        self._write(code, self._words("XYIJ", [*place[:2], *centre]), stretch.speed_mm_s)
        self.place, self.arcs = place, self.arcs + 1

    def _line(self, place_mm: Array, stretch: Stretch) -> None:
        """Write a line or a rapid with the axes that move."""
        place = self._written(place_mm)
        moving = [axis for axis in range(3) if place[axis] != self.place[axis]]
        if not moving:
            return
        words = "".join(self._words("XYZ"[axis], place[axis : axis + 1]) for axis in moving)
        if stretch.rapid:
            self.text.append("G0" + words)
        else:
            self._write("G1", words, stretch.speed_mm_s)
        self.place, self.lines = place, self.lines + 1

    def _write(self, code: str, words: str, speed_mm_s: float) -> None:
        """A line of the program, with the feed where it changes."""
        feed_mm_min = speed_mm_s * 60
        feed = f" F{_digits(feed_mm_min, 0 if feed_mm_min >= WHOLE_FEED_MM_MIN else 3)}"
        self.text.append(code + words + ("" if feed == self.feed else feed))
        self.feed = feed

    def _written(self, place_mm: Array) -> Array:
        """A place (x, y, z) as it is written: to the last digit, a depth as the whole count that it nearly is."""
        place: Array = np.round(place_mm, 4)
        count_mm = round(place_mm[2] / COUNT_MM) * COUNT_MM
        off_mm = abs(float(place_mm[2]) - count_mm)
        if off_mm <= self.count_reach_mm:
            place[2] = round(count_mm, 4)
            self.deviation_mm = max(self.deviation_mm, off_mm)
        return place

    @staticmethod
    def _words(letters: str, values: Any) -> str:
        """Words such as X5 Y-0.25."""
        return "".join(
            f" {letter}{_digits(value, 4)}"
            for letter, value in zip(letters, values, strict=True)
        )


def _digits(value: float, places: int) -> str:
    """A number without needless digits, never minus nothing."""
    text = f"{value:.{places}f}"
    if places:
        text = text.rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def _straightest(points: Array, tolerance_mm: float) -> tuple[list[int], float]:
    """Points between which lines stay within a tolerance of all others (Douglas, Peucker); the largest gap."""
    kept, worst_mm, waiting = {0, len(points) - 1}, 0.0, [(0, len(points) - 1)]
    while waiting:
        first, last = waiting.pop()
        off_mm = _off_line_mm(points[first : last + 1])
        worst = int(np.argmax(off_mm))
        if off_mm[worst] > tolerance_mm:
            kept.add(first + worst)
            waiting += [(first, first + worst), (first + worst, last)]
        else:
            worst_mm = max(worst_mm, float(off_mm[worst]))
    return sorted(kept), worst_mm


def _off_line_mm(points: Array) -> Array:
    """Distance of each point from the straight piece between first and last."""
    along, off = points[-1] - points[0], points - points[0]
    square = float(along @ along)
    share = np.clip(off @ along / square, 0.0, 1.0) if square else np.zeros(len(points))
    return np.sqrt(((off - np.multiply.outer(share, along)) ** 2).sum(axis=1))
