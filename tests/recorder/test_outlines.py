"""DXF and SVG read: every curve within 1 um, units, layers, blocks; what is written is read back."""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from ezdxf import units

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault, FileFault
from morfax.recorder.drawings.curve_chords import FLAT_MM, bezier, bulged, chords_of
from morfax.recorder.drawings.cut_lines import CutLine, Piece
from morfax.recorder.drawings.drawings import _dxf, _svg
from morfax.recorder.drawings.outline import Outline
from morfax.recorder.media import read_outline

UM = 1e-3
ROUNDED = 1e-9  # of a micrometre's thousandth: what float64 leaves of 100 mm


def dxf(
    file: Path, draw: Callable[..., None], unit: int = units.MM, version: str = "R2010"
) -> Path:
    """A DXF with what is drawn in its model space."""
    document = ezdxf.new(version, units=unit)
    draw(document)
    document.saveas(file)
    return file


def svg(
    file: Path, body: str, head: str = 'width="100mm" height="50mm" viewBox="0 0 100 50"'
) -> Path:
    """An SVG of black lines."""
    file.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" {head}>'
        f'<g fill="none" stroke="black">{body}</g></svg>'
    )
    return file


def off_circle(contour: Array, centre: tuple[float, float], radius: float) -> float:
    """How far the chords of a contour are off a circle at the most, mm."""
    middles = (contour[1:] + contour[:-1]) / 2
    places = np.vstack([contour, middles])
    return float(np.abs(np.hypot(*(places - centre).T) - radius).max())


# curves


@pytest.mark.parametrize("radius_mm", [0.5e-3, 0.1, 10, 1000])
def test_chords_of_an_arc_are_within_their_distance_and_no_more_than_it_takes(
    radius_mm: float,
) -> None:
    half = bulged(np.array([-radius_mm, 0.0]), np.array([radius_mm, 0.0]), -math.pi, FLAT_MM)
    whole = np.vstack([[-radius_mm, 0.0], half])
    assert off_circle(whole, (0, 0), radius_mm) <= FLAT_MM + ROUNDED
    assert len(half) == chords_of(radius_mm, math.pi, FLAT_MM)
    if radius_mm > 1:
        assert off_circle(whole, (0, 0), radius_mm) > 0.9 * FLAT_MM


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_chords_of_a_bezier_are_within_their_distance(degree: int) -> None:
    points = 40 * np.random.default_rng(degree).normal(size=(degree + 1, 2))
    flat = np.vstack([points[:1], bezier(points, FLAT_MM)])
    t = np.linspace(0, 1, 20_001)[:, None]
    curve = sum(
        math.comb(degree, k) * (1 - t) ** (degree - k) * t**k * points[k]
        for k in range(degree + 1)
    )
    from morfax.motion.contour import distances_mm

    assert (
        distances_mm(np.asarray(curve), [flat]).max() <= FLAT_MM + 0.01 * UM
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
    allowed = FLAT_MM + ROUNDED
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

    assert distances_mm(curve, [flat]).max() <= FLAT_MM + 0.01 * UM


@pytest.mark.parametrize(
    ("unit", "mm"), [(units.MM, 1), (units.IN, 25.4), (units.CM, 10), (units.M, 1000)]
)
def test_a_dxf_is_in_its_own_unit(tmp_path: Path, unit: int, mm: float) -> None:
    file = dxf(tmp_path / "a.dxf", lambda d: d.modelspace().add_line((1, 2), (3, 4)), unit)
    assert read_outline(file).contours_mm[0] == pytest.approx(mm * np.array([[1, 2], [3, 4]]))
    as_inches = read_outline(file, "in").contours_mm[0]
    assert as_inches == pytest.approx(25.4 * np.array([[1, 2], [3, 4]]))


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


# joining


def test_pieces_whose_ends_meet_are_one_contour(tmp_path: Path) -> None:
    """A slot of two lines and two arcs, in any order and sense, and a cross whose ends no two share."""

    def draw(document: ezdxf.document.Drawing) -> None:
        space = document.modelspace()
        space.add_line((0, 10), (50, 10))
        space.add_arc((50, 5), 5, -90, 90)
        space.add_line((0, 0), (50, 0))
        space.add_arc((0, 5), 5, 90, 270)
        for end in ((90, 0), (110, 0), (100, 9)):
            space.add_line((100, 0), end)
        space.add_line((50, 10), (0, 10))  # there twice

    outline = read_outline(dxf(tmp_path / "a.dxf", draw))
    assert [len(contour) for contour in outline.contours_mm[1:]] == [2, 2, 2]
    slot = outline.contours_mm[0]
    assert (slot[0] == slot[-1]).all()
    from morfax.motion.polyline import area_mm2

    assert abs(area_mm2(slot)) == pytest.approx(500 + 25 * math.pi, abs=2 * math.pi * 5 * UM)
    assert outline.notes == ("1 lines are there twice, and taken once",)


def test_the_tool_is_up_before_between_and_after_the_contours() -> None:
    square = np.array([[0, 0], [10, 0], [10, 10], [0, 0]], float)
    path = Outline.of([square, np.array([[5.0, 3.0]])]).path(5.0)
    assert path.positions_mm[[0, -1], 2].tolist() == [2, 2]
    runs = path.runs()
    assert runs[0].tolist() == square.tolist() and runs[1].tolist() == [[5, 3]]
    # the way in the work takes as long as the feed says
    down = np.flatnonzero(path.tool)
    taken = path.t_s[down[3]] - path.t_s[down[0]]
    assert taken == pytest.approx((20 + math.hypot(10, 10)) / 5)


# SVG


def test_an_svg_s_curves_are_within_a_micrometre_and_y_is_up(tmp_path: Path) -> None:
    body = (
        '<circle cx="30" cy="20" r="10"/><path d="M 60 20 A 10 10 0 1 1 60 20.001"/>'
        '<g transform="translate(80 20) rotate(30) scale(2)"><circle r="5"/></g>'
        '<path d="M 0 0 L 10 0 M 5 5 h 0"/>'
    )
    outline = read_outline(svg(tmp_path / "a.svg", body))
    circle, arc, turned, line, hole = outline.contours_mm
    allowed = FLAT_MM + 0.01 * UM  # the file's own digits
    assert off_circle(circle, (30, 30), 10) <= allowed
    assert off_circle(arc[:-1], (70, 29.9995), 10) <= allowed
    assert off_circle(turned, (80, 30), 10) <= allowed
    assert line.tolist() == [[0, 50], [10, 50]] and hole.tolist() == [[5, 45]]


@pytest.mark.parametrize(
    ("head", "end"),
    [
        ('width="200mm" height="100mm" viewBox="0 0 100 50"', (20, 80)),
        ('width="20cm" viewBox="0 0 100 50"', (20, 80)),
        ('width="1in" height="1in" viewBox="10 10 20 20"', (0, 25.4)),
        ('width="254mm" height="127mm"', (10 * 25.4 / 96, 127 - 10 * 25.4 / 96)),
        # a sheet of another shape: in its middle, or drawn out
        ('width="100mm" height="200mm" viewBox="0 0 100 100"', (10, 140)),
        (
            'width="100mm" height="200mm" viewBox="0 0 100 100" preserveAspectRatio="none"',
            (10, 180),
        ),
        (
            'width="100mm" height="50mm" viewBox="0 0 100 50" data-lower-left-mm="5 -7"',
            (15, 33),
        ),
    ],
)
def test_an_svg_is_as_large_as_it_says(
    tmp_path: Path, head: str, end: tuple[float, float]
) -> None:
    outline = read_outline(svg(tmp_path / "a.svg", '<path d="M 0 0 L 10 10"/>', head))
    assert outline.contours_mm[0][1] == pytest.approx(end, abs=1e-9)


@pytest.mark.parametrize(
    "head",
    ["", 'width="794" height="1123"', 'width="100%" viewBox="0 0 10 10"', 'viewBox="0 0 9 9"'],
)
def test_an_svg_without_a_unit_is_refused(tmp_path: Path, head: str) -> None:
    file = svg(tmp_path / "a.svg", '<path d="M 0 0 L 10 10"/>', head)
    with pytest.raises(
        DrawingFault,
        match=r"a\.svg does not say its unit \(.*width.*\); give it with --unit mm",
    ):
        read_outline(file)
    line = read_outline(file, "in").contours_mm[0]
    assert line[1] - line[0] == pytest.approx((254, -254))


def test_what_an_svg_does_not_show_is_left_out(tmp_path: Path) -> None:
    body = (
        '<rect width="100" height="50" fill="white" stroke="none"/>'
        '<g display="none"><path d="M 0 0 L 1 1"/></g><path d="M 0 0 L 2 2" visibility="hidden"/>'
        '<path d="M 0 0 L 3 3" stroke="none"/><defs><path id="p" d="M 0 0 L 4 4"/></defs>'
        '<text>M6</text><path d="M 0 0 L 5 5"/>'
    )
    outline = read_outline(svg(tmp_path / "a.svg", body))
    assert [line[-1].tolist() for line in outline.contours_mm] == [[5, 45]]
    assert outline.notes == (f"{tmp_path / 'a.svg'}: 1 text are no lines, and left out",)


# what is written is read back


def cut() -> list[CutLine]:
    """Lines and arcs that turn both ways, narrow and wide, and a hole; closed where they end exactly."""
    angle = math.radians(170)
    around = (20 + 10 * math.cos(angle), 20 + 10 * math.sin(angle))
    half = (Piece((10.0, 20.0), math.pi), Piece((30.0, 20.0), math.pi))
    return [
        CutLine((3.0, 4.0), (Piece((33.3333, 4.0)), Piece((43.3333, 14.0), math.pi / 2))),
        CutLine((30.0, 20.0), half),
        CutLine((30.0, 20.0), (Piece(around, angle),)),
        CutLine((50.0, 40.0), (Piece((51.0, 40.0), -1.8 * math.pi), Piece((60.0, 45.0)))),
        CutLine((12.5, 12.5), ()),
    ]


def drawn_out(line: CutLine, off: float) -> Array:
    """The places of a cut line, arcs as chords."""
    places, begin = [np.array([line.begin_mm])], np.array(line.begin_mm)
    for piece in line.pieces:
        end = np.array(piece.end_mm)
        places.append(
            bulged(begin, end, piece.turned_rad, off) if piece.turned_rad else end[None]
        )
        begin = end
    return np.vstack(places)


@pytest.mark.parametrize(("suffix", "write"), [(".dxf", _dxf), (".svg", _svg)])
def test_what_is_written_is_read_back_within_a_micrometre(
    tmp_path: Path, suffix: str, write: Callable[[list[CutLine]], str]
) -> None:
    from morfax.motion.contour import distance

    file = tmp_path / f"part{suffix}"
    file.write_text(write(cut()), encoding="ascii")
    outline = read_outline(file)
    fine = [drawn_out(line, FLAT_MM / 100) for line in cut()]
    # the arc on the half circle is a line of its own
    assert len(outline.contours_mm) == len(fine)
    for contour, line in zip(outline.contours_mm, fine, strict=True):
        assert (
            distance([contour], [line]).hausdorff_mm <= 1.2 * UM
        )  # chords 1 um, digits 0.1 um


# bad files


@pytest.mark.parametrize("suffix", [".dxf", ".svg"])
def test_what_is_no_drawing_is_told(tmp_path: Path, suffix: str) -> None:
    file = tmp_path / f"bad{suffix}"
    for content in (
        b"",
        b"these are words",
        b"\0\xff\xfe" * 50,
        b"<svg",
        b"<a/>",
        b"0\nSECTION\n2\nHEADER\n",
    ):
        file.write_bytes(content)
        with pytest.raises(DrawingFault, match=rf"bad\{suffix}"):
            read_outline(file)
    with pytest.raises(FileFault, match="cannot read"):
        read_outline(tmp_path / f"missing{suffix}")


def test_a_drawing_without_lines_is_told(tmp_path: Path) -> None:
    with pytest.raises(DrawingFault, match="holds no lines in its model space"):
        read_outline(dxf(tmp_path / "a.dxf", lambda d: None))
    with pytest.raises(DrawingFault, match="holds no lines; turn words into paths"):
        read_outline(svg(tmp_path / "a.svg", "<text>part</text>"))


@pytest.mark.parametrize("path", ["M 0 0 L", "M 0 0 A 1 1 0 0 1", "M 0 0 L 1e999 0", "L x y"])
def test_a_damaged_path_of_an_svg_is_told(tmp_path: Path, path: str) -> None:
    with pytest.raises(DrawingFault, match=r"a\.svg"):
        read_outline(svg(tmp_path / "a.svg", f'<path d="{path}"/>'))


def repeated(times: int, deep: int) -> str:
    """A line in groups of `use`, each of which repeats the one before."""
    groups = '<path id="g0" d="M0 0L9 9"/>'
    for k in range(1, deep + 1):
        groups += f'<g id="g{k}">' + f'<use href="#g{k - 1}"/>' * times + "</g>"
    return f'<defs>{groups}</defs><use href="#g{deep}"/>'


def test_a_small_svg_of_very_many_elements_is_refused(tmp_path: Path) -> None:
    """2 kB that are 100 million lines took 40 s and 0.9 GB until they were interrupted."""
    many = svg(tmp_path / "many.svg", repeated(10, 8))
    with pytest.raises(
        DrawingFault, match=r"repeats its elements with `use`: 4.69e\+08 of them"
    ):
        read_outline(many)
    within = svg(tmp_path / "within.svg", '<g id="a"><path d="M0 0L9 9"/><use href="#a"/></g>')
    with pytest.raises(DrawingFault, match="repeats what it stands in, without end"):
        read_outline(within)
    some = svg(tmp_path / "some.svg", repeated(3, 2))
    assert "8 lines are there twice, and taken once" in read_outline(some).notes


def test_a_drawing_of_more_than_a_kilometre_is_refused(tmp_path: Path) -> None:
    """A circle of 1000 km was two million chords, and a program of 23 years, told after 17 s."""
    file = dxf(
        tmp_path / "far.dxf",
        lambda document: document.modelspace().add_line((0, 0), (1.1e6, 0)),
    )
    with pytest.raises(
        DrawingFault, match=r"reaches 1\.1e\+06 mm from its zero, at most 1e\+06"
    ):
        read_outline(file)


@pytest.mark.parametrize(
    ("head", "says"),
    [
        (
            'width="7mm" height="0mm" viewBox="0 0 7 7"',
            "height is '0mm'; it must be above zero",
        ),
        ('width="7mm" viewBox="0 0 7 7" data-lower-left-mm="-1 nan"', "reaches nan mm"),
    ],
)
def test_an_svg_without_height_or_place_is_refused(
    tmp_path: Path, head: str, says: str
) -> None:
    """Found by fuzzing: a division by zero, and a place that is no number."""
    with pytest.raises(DrawingFault, match=says):
        read_outline(svg(tmp_path / "a.svg", '<path d="M0 0L7 7"/>', head))


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
