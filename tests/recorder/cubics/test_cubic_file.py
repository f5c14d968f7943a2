"""Files of cubics: written and read, garbled ones, and the bounds of their format."""

from __future__ import annotations

from pathlib import Path as FilePath

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.faults import ProgramFault
from morfax.motion.motion import thin
from morfax.motion.polyline import UM
from morfax.player.cubics.cubic import play_cubic
from morfax.recorder.cubics.cubics import (
    record_cubics,
)
from morfax.recorder.cubics.file import (
    CubicFormat,
    CubicProgram,
    read_program,
    write_program,
)
from tests.recorder.steps.paths import circle

# the file


def test_a_program_comes_back_from_its_file(tmp_path: FilePath) -> None:
    fmt = CubicFormat(0.05, 32, 4, 1000, 150)
    words = np.random.default_rng(1).integers(-(10**12), 10**12, (5, 3, 3))
    write_program(
        CubicProgram(fmt, words, {0: (1, -2, 3), 3: (4, 5, 6), 5: (7, 8, 9)}),
        tmp_path / "a.cubic",
    )
    read = read_program(tmp_path / "a.cubic")
    assert read.format == fmt and (read.words == words).all()
    assert read.checks == {0: (1, -2, 3), 3: (4, 5, 6), 5: (7, 8, 9)}
    assert read.lines == [11, 12, 13, 15, 16]


GOOD = (
    "morfax cubic 1\ninterval_s 0.064\npoints 16\nlinear 1\ncounts_per_mm 2000\nmodulus_per_s "
    "50\naxes x y z\n"
    "intervals 1\n\nat 0 0 0\n46000 84000 -12000  0 0 0  0 0 0\nat 1000 0 0\nend\n"
)
BAD = [
    ("", "must begin with", 1),
    (GOOD.replace("cubic 1", "cubic 7"), "version 7; this program reads 1", 1),
    (GOOD.replace("points 16", "points 17"), "power of two", None),
    (GOOD.replace("points 16", "dots 16"), "instead of points", 3),
    (GOOD.replace("linear 1", "linear 3"), "divisor", None),
    (GOOD.replace("linear 1", "linear 1.5"), "whole number", None),
    (GOOD.replace("2000", "many"), "is no number", 5),
    (GOOD.replace("2000", "2000 1"), "has 2 numbers; it must have one", 5),
    (GOOD.replace("axes x y z", "axes x y"), "instead of axes x y z", 7),
    (GOOD.replace("at 0 0 0\n", ""), "no 'at' with a start", 10),
    (GOOD.replace("46000", "46000.5"), "9 whole numbers", 11),
    (GOOD.replace("46000", "9" * 30), "below 2\\^63", 11),
    (GOOD.replace("46000 ", ""), "9 whole numbers", 11),
    (GOOD.replace("intervals 1", "intervals 2"), "1 of the 2 intervals", None),
    (GOOD.replace("intervals 1", "intervals 0"), "more than the 0", 11),
    (GOOD.replace("intervals 1", "intervals 10000001"), "a whole number up to 10000000", None),
    (GOOD.replace("end\n", ""), "cut short", None),
    (GOOD[:140], "9 whole numbers", 11),
    (GOOD.replace("46000", "46001"), "comes to 1000", 11),
    (GOOD.replace("at 1000", "at 999"), "the program states 999 0 0", 11),
    (GOOD.replace("46000 84000 -12000", "256000 0 0"), "a corner there", 11),
    (
        GOOD.replace("at 0 0 0", "at 4000000 0 0").replace("at 1000", "at 4001000"),
        "X goes to 2000.50 mm",
        11,
    ),
    (GOOD.replace("-12000", str(2**60)), "too large for the registers", 11),
    ("\xff", "no ASCII text", None),
]


@pytest.mark.parametrize(("text", "told", "line"), BAD, ids=range(len(BAD)))
def test_a_garbled_file_is_one_line_with_its_place(
    tmp_path: FilePath, text: str, told: str, line: int | None
) -> None:
    (tmp_path / "a.cubic").write_text(text, encoding="latin-1")
    with pytest.raises(ProgramFault, match=told) as met:
        play_cubic(tmp_path / "a.cubic")
    assert "\n" not in str(met.value)
    assert met.value.line == line or told.startswith("line")


def test_the_good_file_is_good(tmp_path: FilePath) -> None:
    (tmp_path / "a.cubic").write_text(GOOD.replace("\nat 1000", "\n# a remark\n\nat 1000"))
    assert thin(play_cubic(tmp_path / "a.cubic")).positions_mm[-1] == pytest.approx(
        [0.5, 0, 0], abs=1 * UM
    )


@given(st.binary(max_size=200), st.integers(0, len(GOOD)), st.integers(0, 60))
def test_whatever_stands_in_a_file_is_played_or_refused_in_one_line(
    tmp_path_factory: pytest.TempPathFactory, junk: bytes, at: int, over: int
) -> None:
    file = tmp_path_factory.mktemp("junk") / "a.cubic"
    good = GOOD.encode()
    for content in (junk, good[:at] + junk + good[at + over :]):
        file.write_bytes(content)
        try:
            play_cubic(file)
        except ProgramFault as fault:
            assert "\n" not in str(fault)


def test_a_loop_that_ends_where_it_began_is_no_further_off_there(tmp_path: FilePath) -> None:
    ring = circle(10, 10)
    ring.positions_mm[-1, 2] += (
        0.25 * UM
    )  # the tool is about to rise: the first place is nearer than the last
    report = record_cubics(ring, tmp_path / "a.cubic", tolerance_mm=1 * UM)
    assert report.deviation_mm <= 1 * UM
    assert (
        report.format.interval_s
        == record_cubics(
            circle(10, 10, 0.9), tmp_path / "b.cubic", tolerance_mm=1 * UM
        ).format.interval_s
    )


@pytest.mark.parametrize(
    ("name", "least", "most", "below", "above"),
    [
        ("interval_s", 1e-4, 3600.0, 0.9e-4, 3601.0),
        ("points", 2, 4096, 1, 8192),  # the cube of 4096 with places of 67 m fits a register
        ("linear", 1, 64, 0, 128),
        ("counts_per_mm", 1.0, 1e6, 0.9, 1.1e6),
        ("modulus_per_s", 1e-9, 1e5, 0.0, 1.1e5),
    ],
)
def test_a_format_is_refused_beyond_its_bounds_and_taken_at_them(
    name: str, least: float, most: float, below: float, above: float
) -> None:
    for value in (least, most):
        assert getattr(CubicFormat(**{"points": 64, name: value}), name) == value  # type: ignore[arg-type]
    for value in (below, above):
        with pytest.raises(ValueError, match=name):
            CubicFormat(**{"points": 64, name: value})  # type: ignore[arg-type]


@pytest.mark.parametrize(("points", "digits"), [(2, 3), (64, 18), (4096, 36)])
def test_differences_are_exact_in_three_binary_digits_for_each_doubling(
    points: int, digits: int
) -> None:
    assert CubicFormat(points=points).digits == digits


def test_a_word_fills_its_register_and_no_more(tmp_path: FilePath) -> None:
    """63 digits, and the sign."""
    for word, is_whole in ((2**63 - 1, True), (2**63, False)):
        (tmp_path / "a.cubic").write_text(GOOD.replace("46000", str(word)))
        with pytest.raises(ProgramFault, match="too large for" if is_whole else "below 2"):
            play_cubic(tmp_path / "a.cubic")
