"""Plotter files of other programs: distances, arcs and circles, and what is written is read back exactly."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.faults import ProgramFault
from morfax.motion.usual import INCREMENT_MM
from morfax.player.gcode.hpgl_reader import read_hpgl
from morfax.recorder.gcode.machine import machine

ROUNDED = 1e-9  # mm: what float64 leaves of 100 mm


def lines(file: Path, text: str) -> list[Array]:
    """What the pen draws, mm."""
    file.write_text(text, encoding="latin-1")
    program = read_hpgl(file, machine("hpgl"))
    places = np.array([program.start_mm, *(move.end_mm for move in program.moves)])
    edges = np.flatnonzero(np.diff(np.r_[False, places[:, 2] <= 0, False].astype(int)))
    return [places[a:b, :2] for a, b in edges.reshape(-1, 2)]


def off_circle(line: Array, centre: tuple[float, float], radius: float) -> float:
    """How far the chords of a line are off a circle at the most, mm."""
    places = np.vstack([line, (line[1:] + line[:-1]) / 2])
    return float(np.abs(np.hypot(*(places - centre).T) - radius).max())


def test_places_and_distances_with_a_port_s_escapes_and_without_semicolons(
    tmp_path: Path,
) -> None:
    text = "\x1b.(;\x1b.I81;;17:IN;SP1;PU0,0PD400,0,400,400;PR-400,0PA0,0;PU;PA1000,1000;PD;PU;SP0;"
    square, hole = lines(tmp_path / "a.plt", text)
    assert square.tolist() == [[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]]
    assert hole.tolist() == [[25, 25]]


def test_units_of_the_user_s_own(tmp_path: Path) -> None:
    """100 mm from 10 mm on are 1000 units of 0.1 mm from -50 on; SC alone takes the plotter's again."""
    text = (
        "IN;IP400,400,4400,4400;SC-50,950,-50,950;PU-50,-50;PD950,-50;PR0,100;PU;"
        "PA450,450;CI100;SC;PU400,0;PD800,0;PU;"
    )
    square, circle, line = lines(tmp_path / "a.plt", text)
    assert square == pytest.approx(np.array([[10, 10], [110, 10], [110, 20]]), abs=ROUNDED)
    assert off_circle(circle, (60, 60), 10) <= INCREMENT_MM + ROUNDED
    assert line.tolist() == [[10, 0], [20, 0]]


@pytest.mark.parametrize(("code", "about"), [("AA", (0, 0)), ("AR", (-4000, 0))])
@pytest.mark.parametrize("turned_deg", [360, -270, 90, 200])
def test_arcs_are_within_a_micrometre(
    tmp_path: Path, code: str, about: tuple[int, int], turned_deg: int
) -> None:
    text = f"IN;PU4000,0;PD;{code}{about[0]},{about[1]},{turned_deg},5;PU;"
    (arc,) = lines(tmp_path / "a.plt", text)
    end = 100 * math.cos(math.radians(turned_deg)), 100 * math.sin(math.radians(turned_deg))
    assert off_circle(arc, (0, 0), 100) <= INCREMENT_MM + ROUNDED
    assert arc[-1] == pytest.approx(end, abs=ROUNDED)
    length = float(np.hypot(*np.diff(arc, axis=0).T).sum())
    assert length == pytest.approx(100 * math.radians(abs(turned_deg)), rel=1e-4)


def test_a_circle_is_drawn_about_the_pen_which_comes_back(tmp_path: Path) -> None:
    circle, line = lines(tmp_path / "a.plt", "IN;PU8000,8000;CI2000;PD8000,8400;PU;")
    assert off_circle(circle, (200, 200), 50) <= INCREMENT_MM + ROUNDED
    assert circle[-1] == pytest.approx(circle[0], abs=ROUNDED)
    assert line == pytest.approx(np.array([[200, 200], [200, 210]]))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("IN;SC0,100,0,100;PU;", "line 1: SC without IP"),
        ("IN;IP0,0,4000,4000;SC0,100,0,200;PU;", "SC has no one unit in X and Y"),
        ("IN;IP0,0,4000,4000;SC0,0,0,100;PU;", "SC has no one unit in X and Y"),
        ("IN;IP0,0,4000;PU;", "is no IP of 4 numbers"),
        ("IN;PE<=abc;PU;", "is not played; this control reads IN SP"),
        ("IN;LBM6\x03;PU;", "is not played"),
        ("IN;AA0,0;PU;", "line 1: '0,0' is no AA of 3 numbers"),
        ("IN;CI;PU;", "line 1: '' is no CI of 1 numbers"),
        ("IN;PD1,1e999;PU;", "is not played"),
        ("words", "line 1: .* is not played"),
    ],
)
def test_what_is_not_read_is_refused(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(ProgramFault, match=says):
        lines(tmp_path / "a.plt", text)
