"""The block recorder: a motion becomes a program of lines and arcs with feeds, in RS-274.

Signals: a stream of Motion or a Path in, a `.ngc` file out, in mm and mm/min:

    G17 G21 G90 G94
    G0 X7 Y18.0593 Z2            where the motion starts
    G1 Z-1 F600                  the tool goes down
    G1 X12.4 Y18.0612 F598.2     lines
    G3 X13.1 Y19.2 I0.2 J1.1     arcs, by the centre from where they begin
    G0 Z2                        the tool goes up; M2 ends the program

The path is cut where Z begins or ends to move. What lies in a plane is fitted with lines and arcs
(`recorder.arcs`), what does not with lines alone. The feed of a stretch is the speed at which most of its
length is run; what is run with the tool above the work, or upwards, is a rapid.

Source: RS-274-D, in the words that LinuxCNC and Grbl both take: no %, no G64, F before the first G1, M2 at
the end. Questions: a motion has a speed at every place and a program a feed for each block; its slowing down
before corners is left to the control. Rests are left out. Places are written to 0.1 um.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import MotionFault
from morfax.motion.files import written_beside
from morfax.motion.motion import IN_WORK_BELOW_MM, Path
from morfax.motion.segments import Source, as_path
from morfax.recorder.gcode.arcs import Segment, fit
from morfax.recorder.report import Written

TOLERANCE_MM = 0.01
WRITTEN_MM = 1e-4  # the last digit
_LARGEST_RADIUS_MM = 10_000.0  # a way of 300 mm is 1.1 um off its chord
_LEVEL = 0.02  # Z that changes less than this share of the way stands
_NOISE_MM = 2e-4  # of a thinned path
_SLOWEST_MM_S, _FASTEST_MM_S = 0.01, 1000.0


@dataclass(frozen=True, slots=True)
class BlockReport(Written):
    """What was recorded: file, lines and arcs (rapids are lines), running time, largest distance from the
    motion.
    """

    lines: int
    arcs: int
    duration_s: float
    deviation_mm: float

    @property
    def figures(self) -> dict[str, Any]:
        """What else is worth telling."""
        return {"lines": self.lines, "arcs": self.arcs, "deviation_mm": self.deviation_mm}


@dataclass(frozen=True, slots=True)
class _Stretch:
    """A part of the path in one plane, or not (`level` false), and the speed at which most of it is run."""

    points_mm: Array
    level: bool
    speed_mm_s: float

    @property
    def rapid(self) -> bool:
        """Whether it is run above the work, or only upwards."""
        across, z = np.ptp(self.points_mm[:, :2], axis=0).max(), self.points_mm[:, 2]
        return bool(z.min() > IN_WORK_BELOW_MM or (across <= _NOISE_MM and z[-1] > z[0]))


def record_blocks(
    stream: Source, file: str | os.PathLike[str], *, tolerance_mm: float = TOLERANCE_MM
) -> BlockReport:
    """Record a motion as a program of lines and arcs that stay within the tolerance of it; raises
    MotionFault, FileFault.
    """
    if not 2 * WRITTEN_MM <= tolerance_mm < math.inf:
        raise ValueError(
            f"a tolerance of {tolerance_mm} mm cannot be written; give {2 * WRITTEN_MM} mm or more"
        )
    path = as_path(stream)
    stretches = list(_stretches(path, tolerance_mm))
    if not stretches:
        raise MotionFault(
            "the motion stands still at one place; a program needs at least two different places"
        )
    writer = _Writer(path.positions_mm[0])
    for stretch in stretches:
        writer.stretch(stretch, tolerance_mm - WRITTEN_MM)
    with written_beside(file) as beside:
        beside.write_text("\n".join([*writer.text, "M2", ""]), encoding="ascii")
    return BlockReport(
        FilePath(file), writer.lines, writer.arcs, writer.duration_s, writer.deviation_mm
    )


def _stretches(path: Path, tolerance_mm: float) -> Iterator[_Stretch]:
    """The path cut where Z begins or ends to move; what stands is left out."""
    step = np.diff(path.positions_mm, axis=0)
    across, up, took_s = np.hypot(step[:, 0], step[:, 1]), np.abs(step[:, 2]), np.diff(path.t_s)
    climbs = (up > _LEVEL * across) & (up > _NOISE_MM)
    moves = climbs | (across > _NOISE_MM / 10)
    kind = np.where(climbs, 2, 1)[moves]
    kept = np.flatnonzero(moves)
    for group in np.split(np.arange(len(kept)), np.flatnonzero(np.diff(kind)) + 1):
        if not len(group):
            continue
        steps = kept[group]
        points = path.positions_mm[np.r_[steps, steps[-1] + 1]]
        lengths, seconds = np.sqrt((step[steps] ** 2).sum(axis=1)), took_s[steps]
        if kind[group[0]] == 2 and np.ptp(points[:, :2], axis=0).max() <= tolerance_mm / 4:
            points[:, :2] = points[
                0, :2
            ]  # a sample that was taken in the corner where the tool turns upwards
        level = kind[group[0]] == 1 and float(np.ptp(points[:, 2])) <= tolerance_mm / 2
        yield _Stretch(points, level, _speed_mm_s(lengths, seconds))


def _speed_mm_s(lengths_mm: Array, seconds: Array) -> float:
    """The speed at which most of the length is run: its median by length."""
    speeds = lengths_mm / np.maximum(seconds, 1e-9)
    order = np.argsort(speeds)
    share = np.cumsum(lengths_mm[order])
    median = speeds[order[np.searchsorted(share, share[-1] / 2)]]
    return float(np.clip(median, _SLOWEST_MM_S, _FASTEST_MM_S))


class _Writer:
    """The text of a program so far, and where it has come to."""

    def __init__(self, start_mm: Array) -> None:
        self.place = np.round(start_mm, 4)
        self.text = ["G17 G21 G90 G94", "G0" + self._words("XYZ", self.place)]
        self.feed, self.lines, self.arcs, self.duration_s, self.deviation_mm = (
            "",
            0,
            0,
            0.0,
            0.0,
        )

    def stretch(self, stretch: _Stretch, tolerance_mm: float) -> None:
        """Write a stretch."""
        points = np.vstack([self.place, stretch.points_mm[1:]])
        self.duration_s += (
            float(np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1)).sum())
            / stretch.speed_mm_s
        )
        if stretch.rapid or not stretch.level:
            kept, off_mm = _straightest(points, tolerance_mm)
            self.deviation_mm = max(self.deviation_mm, off_mm)
            for place in points[kept[1:]]:
                self._line(place, stretch)
            return
        for chain in fit(points[:, :2], tolerance_mm):
            self.deviation_mm = max(self.deviation_mm, chain.deviation_mm + WRITTEN_MM)
            for segment in chain.segments:
                self._segment(segment, stretch, chain.deviation_mm)

    def _segment(self, segment: Segment, stretch: _Stretch, off_mm: float) -> None:
        """Write a line or an arc; an arc is a line where no digit tells it from its chord, or its centre is
        in the next street.
        """
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

    def _line(self, place_mm: Array, stretch: _Stretch) -> None:
        """Write a line or a rapid with the axes that move."""
        place: Array = np.round(place_mm, 4)
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
        feed = f" F{_digits(speed_mm_s * 60, 1)}"
        self.text.append(code + words + ("" if feed == self.feed else feed))
        self.feed = feed

    @staticmethod
    def _words(letters: str, values: Any) -> str:
        """Words such as X5 Y-0.25."""
        return "".join(
            f" {letter}{_digits(value, 4)}"
            for letter, value in zip(letters, values, strict=True)
        )


def _digits(value: float, places: int) -> str:
    """A number without needless digits, never minus nothing."""
    text = f"{value:.{places}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def _straightest(points: Array, tolerance_mm: float) -> tuple[list[int], float]:
    """Points between which lines stay within the tolerance of all others (Douglas and Peucker), and the
    largest gap.
    """
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
