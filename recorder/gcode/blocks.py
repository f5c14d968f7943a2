"""The block recorder: a motion becomes a program of lines, arcs and dwells with feeds, in RS-274.

Signals: a stream of Motion or a Path in, a program file out, in mm, mm/min and s. For LinuxCNC:

    G21 G17 G40 G49 G54 G80 G90 G94      how the machine wants its programs to begin (recorder.gcode.machine)
    G0 Z2                                up to the clearance, Z alone
    G0 X7 Y18.0593                       where the motion starts
    G1 Z-1 F600                          the tool goes down
    G1 X12.4 Y18.0612 F598               lines
    G3 X13.1 Y19.2 I0.2 J1.1             arcs, by the centre from where they begin
    G4 P1                                a dwell
    G0 Z2                                the tool goes up; M5 and M2 end the program

The path is cut into stretches (`recorder.gcode.stretches`). A stretch in a plane is fitted with lines and arcs
(`recorder.gcode.arcs`), a slope with lines alone; an upright one is one line. The feed of a stretch is the speed
at which most of its length is run, unless the operator gives feeds; a stretch above the work, or straight up, is
a rapid. `recorder.gcode.program_text` writes the blocks in the words of a machine.

Source: RS-274-D, as LinuxCNC, Grbl and Marlin take it. Questions: a motion has a speed at every place and a
program a feed for each block; the control slows down before corners by its own rules. A motion that starts at or
below the surface goes to its place first and then down. Depths that are whole counts of the Z unit are written as
such.
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
from morfax.motion.segments import Source, as_path
from morfax.recorder.gcode.arcs import Segment, fit
from morfax.recorder.gcode.machine import Machine, machine
from morfax.recorder.gcode.program_text import Block, program_text
from morfax.recorder.gcode.stretches import Stretch, stretches
from morfax.recorder.report import Written

TOLERANCE_MM = 0.01
_LARGEST_RADIUS_MM = 10_000.0  # a way of 300 mm is 1.1 um off its chord
COUNT_MM = 0.01  # the step of the Z unit's decades
COUNT_SHARE = 0.25  # of the tolerance, at most 2 um: a depth as near to a whole count is written as that count
COUNT_REACH_MM = 0.002  # three times what thinning takes off the place where one move of Z ends and one begins


@dataclass(frozen=True, slots=True)
class Feeds:
    """Feeds that the operator gives, mm/s; None: those of the motion."""

    cut_mm_s: float | None = None
    plunge_mm_s: float | None = None


@dataclass(frozen=True, slots=True)
class BlockReport(Written):
    """What was recorded: lines (rapids too), arcs, dwells, running time, largest distance from the motion."""

    lines: int
    arcs: int
    dwells: int
    duration_s: float
    deviation_mm: float
    machine: str

    @property
    def figures(self) -> dict[str, Any]:
        """Further figures for the report."""
        return {
            "machine": self.machine,
            "lines": self.lines,
            "arcs": self.arcs,
            "dwells": self.dwells,
            "deviation_mm": self.deviation_mm,
        }


def record_blocks(
    stream: Source,
    file: str | os.PathLike[str],
    *,
    tolerance_mm: float = TOLERANCE_MM,
    machine_name: str | None = None,
    feeds: Feeds | None = None,
) -> BlockReport:
    """Record a motion as a program of lines and arcs that stay within the tolerance of it.

    The machine is LinuxCNC's, a built-in one by its name, or that of a .toml file. Raises MotionFault, FileFault,
    CardFault for a mistake in a machine's file, ValueError for a name or a tolerance that cannot be.
    """
    wanted = machine() if machine_name is None else machine(machine_name)
    last_digit_mm = 10.0**-wanted.decimals
    if not 2 * last_digit_mm <= tolerance_mm < math.inf:
        raise ValueError(
            f"a tolerance of {tolerance_mm} mm cannot be written with {wanted.decimals} decimals; "
            f"give {2 * last_digit_mm:g} mm or more"
        )
    path = as_path(stream)
    parts = list(stretches(path, tolerance_mm))
    if not parts:
        raise MotionFault(
            "the motion stands still at one place; a program needs at least two different places"
        )
    planner = _Planner(path.positions_mm[0], wanted, feeds or Feeds(), tolerance_mm)
    for part in parts:
        planner.stretch(part)
    report = planner.report(FilePath(file))
    comments = [f"for {wanted.what}", *_comments(parts, report)]
    with written_beside(file) as beside:
        text = program_text(planner.start_mm, planner.blocks, wanted, comments)
        beside.write_text("\n".join([*text, ""]), encoding="ascii")
    return report


def _comments(parts: list[Stretch], report: BlockReport) -> list[str]:
    """What a person at the machine wants to know before pressing start."""
    cut = [part.points_mm for part in parts if not part.rapid]
    if not cut:
        return [f"about {report.duration_s:.0f} s, nothing is cut"]
    points = np.vstack(cut)
    x_mm, y_mm, _ = np.ptp(points, axis=0)
    length_mm = sum(float(np.hypot(*np.diff(piece[:, :2], axis=0).T).sum()) for piece in cut)
    return [
        f"cut {x_mm:.2f} x {y_mm:.2f} mm, Z down to {points[:, 2].min():.2f} mm",
        f"length {length_mm:.1f} mm, about {report.duration_s:.0f} s",
        f"within {report.deviation_mm:.4f} mm of the traced path",
    ]


class _Planner:
    """The blocks of a program so far, and the place that they have reached."""

    def __init__(
        self, start_mm: Array, wanted: Machine, feeds: Feeds, tolerance_mm: float
    ) -> None:
        self.machine, self.feeds = wanted, feeds
        self.last_digit_mm = 10.0**-wanted.decimals
        self.tolerance_mm = tolerance_mm - self.last_digit_mm
        self.count_reach_mm = min(COUNT_REACH_MM, COUNT_SHARE * tolerance_mm)
        self.blocks: list[Block] = []
        self.duration_s = self.deviation_mm = 0.0
        self.start_mm = self.place = self._written(start_mm)

    def report(self, file: FilePath) -> BlockReport:
        """What has been planned."""
        codes = [block.code for block in self.blocks]
        arcs, dwells = codes.count("G2") + codes.count("G3"), codes.count("G4")
        lines = len(codes) - arcs - dwells
        return BlockReport(
            file, lines, arcs, dwells, self.duration_s, self.deviation_mm, self.machine.name
        )

    def stretch(self, stretch: Stretch) -> None:
        """Plan a stretch, and the dwell before it."""
        if stretch.dwell_s:
            self.blocks.append(Block("G4", tuple(self.place), dwell_s=stretch.dwell_s))
        points = np.vstack([self.place, stretch.points_mm[1:]])
        length_mm = float(np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1)).sum())
        feed_mm_s = self._feed_mm_s(stretch)
        self.duration_s += length_mm / feed_mm_s + stretch.dwell_s
        if stretch.rapid or stretch.kind != "plane" or not self.machine.arcs:
            kept, off_mm = _straightest(points, self.tolerance_mm)
            self.deviation_mm = max(self.deviation_mm, off_mm)
            for place in points[kept[1:]]:
                self._line(place, feed_mm_s, rapid=stretch.rapid)
            return
        for chain in fit(points[:, :2], self.tolerance_mm):
            self.deviation_mm = max(self.deviation_mm, chain.deviation_mm + self.last_digit_mm)
            for segment in chain.segments:
                self._segment(segment, feed_mm_s, chain.deviation_mm)

    def _feed_mm_s(self, stretch: Stretch) -> float:
        """The feed of a stretch: the operator's, or the motion's."""
        asked_mm_s = (
            self.feeds.plunge_mm_s if stretch.kind == "upright" else self.feeds.cut_mm_s
        )
        return stretch.speed_mm_s if stretch.rapid or asked_mm_s is None else asked_mm_s

    def _segment(self, segment: Segment, feed_mm_s: float, off_mm: float) -> None:
        """Plan a line or an arc; an arc that its chord stands for, or of a huge radius, becomes a line."""
        place: Array = np.array(
            [*np.round(segment.end_mm, self.machine.decimals), self.place[2]]
        )
        half = segment.turned_rad / 2
        (dx, dy), bulge = (place - self.place)[:2], segment.length_mm / 2 * math.tan(half / 2)
        is_straight = abs(bulge) < self.last_digit_mm
        if is_straight or abs(segment.curvature_per_mm) * _LARGEST_RADIUS_MM < 1:
            self._line(place, feed_mm_s, rapid=False)
            self.deviation_mm = max(self.deviation_mm, off_mm + abs(bulge))
            return
        out = 0.5 / math.tan(half)
        centre = dx / 2 - out * dy, dy / 2 + out * dx
        code = "G3" if half > 0 else "G2"
        self.blocks.append(Block(code, tuple(place), centre, feed_mm_s))
        self.place = place

    def _line(self, place_mm: Array, feed_mm_s: float, *, rapid: bool) -> None:
        """Plan a line or a rapid, if it goes anywhere."""
        place = self._written(place_mm)
        if (place == self.place).all():
            return
        self.blocks.append(Block("G0" if rapid else "G1", tuple(place), feed_mm_s=feed_mm_s))
        self.place = place

    def _written(self, place_mm: Array) -> Array:
        """A place (x, y, z) as it is written: to the last digit, a depth as the whole count that it nearly is."""
        place: Array = np.round(place_mm, self.machine.decimals)
        count_mm = round(place_mm[2] / COUNT_MM) * COUNT_MM
        off_mm = abs(float(place_mm[2]) - count_mm)
        if off_mm <= self.count_reach_mm:
            place[2] = round(count_mm, self.machine.decimals)
            self.deviation_mm = max(self.deviation_mm, off_mm)
        return place


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
