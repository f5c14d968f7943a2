"""DXF and SVG read: every curve within 1 um, units, layers, blocks; what is written is read back."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from ezdxf import units

from morfax.motion.faults import DrawingFault
from morfax.motion.usual import INCREMENT_MM
from morfax.recorder.drawings.curve_chords import bezier, bulged, chords_of
from morfax.recorder.media import read_outline
from tests.recorder.dxf_files import UM, dxf, off_circle

ROUNDED = 1e-9  # of a micrometre's thousandth: what float64 leaves of 100 mm


# curves


@pytest.mark.parametrize("radius_mm", [0.5e-3, 0.1, 10, 1000])
def test_chords_of_an_arc_are_within_their_distance_and_no_more_than_it_takes(
    radius_mm: float,
) -> None:
    half = bulged(
        np.array([-radius_mm, 0.0]), np.array([radius_mm, 0.0]), -math.pi, INCREMENT_MM
    )
    whole = np.vstack([[-radius_mm, 0.0], half])
    assert off_circle(whole, (0, 0), radius_mm) <= INCREMENT_MM + ROUNDED
    assert len(half) == chords_of(radius_mm, math.pi, INCREMENT_MM)
    if radius_mm > 1:
        assert off_circle(whole, (0, 0), radius_mm) > 0.9 * INCREMENT_MM


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_chords_of_a_bezier_are_within_their_distance(degree: int) -> None:
    points = 40 * np.random.default_rng(degree).normal(size=(degree + 1, 2))
    flat = np.vstack([points[:1], bezier(points, INCREMENT_MM)])
    t = np.linspace(0, 1, 20_001)[:, None]
    curve = sum(
        math.comb(degree, k) * (1 - t) ** (degree - k) * t**k * points[k]
        for k in range(degree + 1)
    )
    from morfax.motion.contour import distances_mm

    assert (
        distances_mm(np.asarray(curve), [flat]).max() <= INCREMENT_MM + 0.01 * UM
    )  # of its sampling


# DXF


def test_a_dxf_s_curves_are_within_a_micrometre(tmp_path: Path) -> None:
    def draw(document: ezdxf.document.Drawing) -> None:
        space = document.modelspace()
        space.add_circle((50, 40), 100)
        space.add_arc((0, 0), 30, 10, 300)
        space.add_lwpolyline([(0, 0, 1), (20, 0, 0), (20, 5, 0)], format="xyb", close=True)
        space.add_polyline2d([(100, 0, -1), (140, 0, 0)], format="xyb")
        space.add_ellipse((0, 0), (50, 0), 0.3)

    circle, arc, bulge, old, ellipse = read_outline(dxf(tmp_path / "a.dxf", draw)).contours_mm
    allowed = INCREMENT_MM + ROUNDED
    assert off_circle(circle, (50, 40), 100) <= allowed and (circle[0] == circle[-1]).all()
    assert off_circle(arc, (0, 0), 30) <= allowed
    assert off_circle(bulge[:-2], (10, 0), 10) <= allowed and bulge[:, 1].min() < -9.9
    assert off_circle(old, (120, 0), 20) <= allowed and old[:, 1].max() > 19.9
    squeezed = np.column_stack([ellipse[:, 0], ellipse[:, 1] / 0.3])
    assert np.abs(np.hypot(*squeezed.T) - 50).max() < ROUNDED


def test_a_dxf_s_spline_is_within_a_micrometre(tmp_path: Path) -> None:
    places = [(0, 0), (10, 20), (30, -10), (50, 0), (60, 30), (20, 40)]
    file = dxf(tmp_path / "a.dxf", lambda d: d.modelspace().add_open_spline(places))
    flat = read_outline(file).contours_mm[0]
    space = ezdxf.readfile(file).modelspace()
    curve = np.array([(v.x, v.y) for v in space[0].construction_tool().approximate(20_000)])
    from morfax.motion.contour import distances_mm

    assert distances_mm(curve, [flat]).max() <= INCREMENT_MM + 0.01 * UM


@pytest.mark.parametrize(
    ("unit", "mm"), [(units.MM, 1), (units.IN, 25.4), (units.CM, 10), (units.M, 1000)]
)
def test_a_dxf_is_in_its_own_unit(tmp_path: Path, unit: int, mm: float) -> None:
    file = dxf(tmp_path / "a.dxf", lambda d: d.modelspace().add_line((1, 2), (3, 4)), unit)
    assert read_outline(file).contours_mm[0] == pytest.approx(mm * np.array([[1, 2], [3, 4]]))
    as_inches = read_outline(file, "in")
    assert as_inches.contours_mm[0] == pytest.approx(25.4 * np.array([[1, 2], [3, 4]]))
    said = [note for note in as_inches.notes if f"{25.4 / mm:.4g} times as large" in note]
    assert len(said) == (mm != 25.4)


@pytest.mark.parametrize("version", ["R12", "R2010"])
def test_a_dxf_without_a_unit_is_refused(tmp_path: Path, version: str) -> None:
    def draw(document: ezdxf.document.Drawing) -> None:
        document.modelspace().add_line((1, 2), (3, 4))

    file = dxf(tmp_path / "a.dxf", draw, unit=0, version=version)
    with pytest.raises(
        DrawingFault, match=r"a\.dxf does not say its unit \(.*\); give it with --unit"
    ):
        read_outline(file)
    assert read_outline(file, "mm").contours_mm[0].max() == 4


def test_blocks_are_read_where_they_are_put_in(tmp_path: Path) -> None:
    """A block in a block, turned, mirrored, and in two rows."""

    def draw(document: ezdxf.document.Drawing) -> None:
        inner = document.blocks.new("inner")
        inner.add_line((0, 0), (1, 0))
        document.blocks.new("outer").add_blockref("inner", (10, 0), {"rotation": 90})
        put = {"xscale": -2, "yscale": 2, "row_count": 2, "row_spacing": 100}
        document.modelspace().add_blockref("outer", (0, 5), put)

    low, high = read_outline(dxf(tmp_path / "a.dxf", draw)).contours_mm
    assert low == pytest.approx(np.array([[-20, 5], [-20, 7]]))
    assert high == pytest.approx(np.array([[-20, 105], [-20, 107]]))


def test_layers_that_are_off_or_frozen_are_left_out(tmp_path: Path) -> None:
    def draw(document: ezdxf.document.Drawing) -> None:
        document.layers.add("cut")
        document.layers.add("construction").off()
        document.layers.add("old").freeze()
        space = document.modelspace()
        block = document.blocks.new("B")
        block.add_line((0, 0), (1, 0), {"layer": "0"})
        block.add_line((0, 1), (1, 1), {"layer": "cut"})
        for x, layer in enumerate(("cut", "construction", "old")):
            space.add_line((x, 10), (x, 20), {"layer": layer})
            space.add_blockref("B", (100 * x, 0), {"layer": layer})
        space.add_line((9, 10), (9, 20), {"invisible": 1})

    lines = read_outline(dxf(tmp_path / "a.dxf", draw)).contours_mm
    begins = sorted(tuple(line[0]) for line in lines)
    # of the block on a layer that is off, what has a layer of its own is shown
    assert begins == [(0, 0), (0, 1), (0, 10), (100, 1)]


def test_what_is_no_line_is_left_out_and_it_is_said(tmp_path: Path) -> None:
    def draw(document: ezdxf.document.Drawing) -> None:
        space = document.modelspace()
        space.add_line((0, 0), (1, 0))
        space.add_text("M6")
        space.add_text("R3")
        space.add_hatch()

    outline = read_outline(dxf(tmp_path / "a.dxf", draw))
    assert outline.notes == (
        f"{tmp_path / 'a.dxf'}: 1 HATCH, 2 TEXT are no lines, and left out",
    )


def test_a_block_that_holds_itself_is_refused(tmp_path: Path) -> None:
    def draw(document: ezdxf.document.Drawing) -> None:
        document.blocks.new("B").add_blockref("B", (1, 0))
        document.modelspace().add_blockref("B", (0, 0))

    with pytest.raises(DrawingFault, match="blocks in one another, more than 16 deep"):
        read_outline(dxf(tmp_path / "a.dxf", draw))


def test_what_the_library_meets_in_a_file_does_not_stand_on_the_terminal(
    tmp_path: Path,
) -> None:
    """Two lines of one handle: both are read, and nothing is said. (Fails without the NullHandler.)"""
    document = ezdxf.new("R2010", units=ezdxf.units.MM)
    for y in (0, 10):
        document.modelspace().add_line((0, y), (20, y))
    file = tmp_path / "twice.dxf"
    document.saveas(file)
    first, second = (f"  5\n{line.dxf.handle}\n" for line in document.modelspace())
    file.write_text(file.read_text().replace(second, first))
    code = f"from morfax.recorder.media import read_outline; read_outline({str(file)!r})"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert done.stderr == ""
