"""Contours of joined pieces, SVG files, and files that are no drawing."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import ezdxf
import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault, FileFault
from morfax.motion.usual import INCREMENT_MM
from morfax.recorder.drawings.curve_chords import bulged
from morfax.recorder.drawings.cut_lines import CutLine
from morfax.recorder.drawings.drawings import _dxf, _svg
from morfax.recorder.drawings.outline import CadOutline
from morfax.recorder.media import read_outline
from tests.recorder.dxf_files import UM, cut, dxf, off_circle


def svg(
    file: Path, body: str, head: str = 'width="100mm" height="50mm" viewBox="0 0 100 50"'
) -> Path:
    """An SVG of black lines."""
    file.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" {head}>'
        f'<g fill="none" stroke="black">{body}</g></svg>'
    )
    return file


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
    path = CadOutline.of([square, np.array([[5.0, 3.0]])]).path(5.0)
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
    allowed = INCREMENT_MM + 0.01 * UM  # the file's own digits
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
    fine = [drawn_out(line, INCREMENT_MM / 100) for line in cut()]
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
