"""DXF, SVG and HPGL: what is cut, in true size, as other programs read it."""

from __future__ import annotations

import math
import re
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from ezdxf.path import make_path

from morfax.motion.contour import distance
from morfax.motion.faults import MotionFault
from morfax.motion.motion import Path as MotionPath
from morfax.recorder.drawings.drawings import TOLERANCE_MM
from morfax.recorder.media import DRAWINGS, record

STEP_MM = 0.025  # HP-GL's plotter unit
UM = 1e-3
CENTRE_MM, RADIUS_MM, HOLE_MM = (30.0, 25.0), 12.5, (30.0, 25.0)


def part() -> tuple[MotionPath, np.ndarray]:
    """A wheel with a flat, cut 2 mm deep, a hole in pecks at its middle; and its outline."""
    turn = np.linspace(0.4, math.tau - 0.4, 400)
    rim = np.array(CENTRE_MM) + RADIUS_MM * np.column_stack([np.cos(turn), np.sin(turn)])
    outline = np.vstack([rim, rim[:1]])
    cut = [(x, y, -2.0) for x, y in outline]
    hole = [(*HOLE_MM, z) for z in (2.0, -3.0, 2.0, -6.0, 2.0)]
    points = np.array([(*outline[0], 2.0), *cut, (*outline[0], 2.0), *hole])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return MotionPath(np.r_[0.0, np.cumsum(steps / 10.0)], points), outline


def read_dxf(file: Path) -> tuple[list[np.ndarray], list[tuple[float, float]]]:
    """The lines of a DXF, flattened to 1 um, and its points."""
    space = ezdxf.readfile(file).modelspace()
    lines = [
        np.array([(v.x, v.y) for v in make_path(entity).flattening(1 * UM)])
        for entity in space.query("LWPOLYLINE")
    ]
    return lines, [
        (point.dxf.location.x, point.dxf.location.y) for point in space.query("POINT")
    ]


def read_hpgl(file: Path) -> list[np.ndarray]:
    """The lines of a plotter file, mm."""
    lines = []
    for up, down in re.findall(r"PU(\d+,\d+);\s*PD([\d,]*);", file.read_text()):
        steps = [int(n) for n in f"{up},{down}".strip(",").split(",")]
        lines.append(STEP_MM * np.array(steps, float).reshape(-1, 2))
    return lines


def read_svg(file: Path) -> list[np.ndarray]:
    """The lines of an SVG in its own mm, Y up, arcs drawn out by the rules of SVG 1.1, appendix F.6.5."""
    text = file.read_text()
    height = float(re.search(r'height="([\d.]+)mm"', text)[1])  # type: ignore[index]
    lines = []
    for path in re.findall(r' d="([^"]+)"', text):
        points: list[complex] = []
        for letter, numbers in re.findall(r"([MLAZh]) ?([\d. -]*)", path):
            values = [float(n) for n in numbers.split()]
            if letter in "ML":
                points.append(complex(*values))
            elif letter == "A":
                points += arc_of(points[-1], values)
            elif letter == "Z":
                points.append(points[0])
        lines.append(np.array([(p.real, height - p.imag) for p in points]))
    return lines


def arc_of(begin: complex, values: list[float]) -> list[complex]:
    """Points of an arc from its end points, radius and flags; Y down."""
    radius, large, sweep, end = values[0], values[3], values[4], complex(*values[5:])
    half = (begin - end) / 2
    share = math.sqrt(max(0.0, radius**2 / abs(half) ** 2 - 1)) * (-1 if large == sweep else 1)
    centre = (begin + end) / 2 + share * half * -1j
    first = math.atan2((begin - centre).imag, (begin - centre).real)
    last = math.atan2((end - centre).imag, (end - centre).real)
    turned = (last - first) % math.tau if sweep else -((first - last) % math.tau)
    angles = first + turned * np.linspace(0, 1, 200)[1:]
    return [centre + radius * complex(math.cos(a), math.sin(a)) for a in angles]


def test_a_dxf_is_the_part_in_mm(tmp_path: Path) -> None:
    path, outline = part()
    report = record(path, tmp_path / "part.dxf")
    lines, points = read_dxf(tmp_path / "part.dxf")
    assert ezdxf.readfile(tmp_path / "part.dxf").units == ezdxf.units.MM
    assert len(lines) == 1 and points == [HOLE_MM]
    assert distance(lines, [outline]).hausdorff_mm <= TOLERANCE_MM + 1 * UM
    assert (report.lines, report.closed) == (2, 1)  # type: ignore[attr-defined]
    wheel = ezdxf.readfile(tmp_path / "part.dxf").modelspace().query("LWPOLYLINE")[0]
    assert wheel.closed and len(wheel) <= 4  # arcs and the flat, not chords


def test_an_svg_is_the_part_in_true_size(tmp_path: Path) -> None:
    path, outline = part()
    record(path, tmp_path / "part.svg")
    lines = read_svg(tmp_path / "part.svg")
    # an SVG begins at the corner of what is cut: laid over the part by its hole, which no fit has moved
    laid = lines[0] - lines[1][0] + HOLE_MM
    assert distance([laid], [outline]).hausdorff_mm <= TOLERANCE_MM + 1 * UM
    assert lines[0].min(axis=0) == pytest.approx((1.0, 1.0), abs=STEP_MM)  # the margin


@pytest.mark.parametrize("suffix", [".plt", ".hpgl"])
def test_a_plotter_file_is_the_part_in_steps(suffix: str, tmp_path: Path) -> None:
    path, outline = part()
    record(path, tmp_path / f"part{suffix}")
    lines = read_hpgl(tmp_path / f"part{suffix}")
    # half a step for the chords, half a step across each axis for the rounding
    allowed_mm = TOLERANCE_MM + STEP_MM / 2 + math.hypot(STEP_MM, STEP_MM) / 2
    assert distance(lines[:1], [outline]).hausdorff_mm <= allowed_mm
    assert lines[1].tolist() == [list(HOLE_MM)]


def test_what_a_plotter_cannot_reach_is_refused(tmp_path: Path) -> None:
    path, _ = part()
    left = MotionPath(path.t_s, path.positions_mm - [40, 0, 0])
    with pytest.raises(
        MotionFault,
        match=r"reaches to X -22\.5.*, and a plotter begins at 0, 0; .*--zero lower-left",
    ):
        record(left, tmp_path / "part.plt")
    far = MotionPath(path.t_s, path.positions_mm + np.array([800, 0, 0]))
    with pytest.raises(MotionFault, match=r"reaches to X 841.*a plotter file to 819 mm"):
        record(far, tmp_path / "part.plt")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", list(DRAWINGS))
def test_a_motion_that_cuts_nothing_is_no_drawing(suffix: str, tmp_path: Path) -> None:
    points = np.array([[0, 0, 5], [20, 0, 5], [20, 10, 5]], float)
    with pytest.raises(MotionFault, match=r"nothing is cut: Z stays above 0\.05 mm"):
        record(MotionPath(np.arange(3.0), points), tmp_path / f"part{suffix}")
    assert not list(tmp_path.iterdir())


def test_an_open_line_stays_open(tmp_path: Path) -> None:
    points = np.array([[0, 0, 0], [20, 0, 0], [20, 10, 0]], float)
    record(MotionPath(np.arange(3.0), points), tmp_path / "part.dxf")
    line = ezdxf.readfile(tmp_path / "part.dxf").modelspace().query("LWPOLYLINE")[0]
    assert not line.closed
    assert [tuple(p) for p in line.get_points("xy")] == [(0, 0), (20, 0), (20, 10)]
