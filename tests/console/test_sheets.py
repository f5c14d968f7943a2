"""Sheets from phones, viewers and scanners: pages and scales as a user gives them."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image

from tests.console.conftest import SAMPLES, Morfax

CURVE = SAMPLES / "curve.png"


@pytest.fixture
def pages(here: Path) -> Path:
    """A PDF of two pages: the second holds the curve, 300 dpi."""
    with Image.open(CURVE) as curve:
        grey = curve.convert("L")
    blank = Image.new("L", grey.size, 255)
    blank.save(here / "pages.pdf", resolution=300, save_all=True, append_images=[grey])
    return here / "pages.pdf"


def test_the_second_page_of_a_pdf_is_traced(pages: Path, morfax: Morfax) -> None:
    answer = morfax("trace", pages, "--page", 2, "--path", "second.csv", "--json")
    assert answer.exit_code == 0
    plain = morfax("trace", CURVE, "--path", "curve.csv", "--json")
    # the PDF's JPEG ripples by 6 % of a pixel of 85 um
    assert answer.figures["length_mm"] == pytest.approx(plain.figures["length_mm"], abs=0.02)


def test_the_first_page_is_taken_and_it_is_said(pages: Path, morfax: Morfax) -> None:
    answer = morfax("trace", pages, "--path", "first.csv")
    assert "no line on the drawing" in answer.fault and answer.exit_code == 3
    pages.rename("turned.pdf")
    with Image.open(CURVE) as curve:
        grey = curve.convert("L")
        grey.save("two.tif", dpi=(300, 300), save_all=True, append_images=[grey])
    told = morfax("trace", "two.tif", "--path", "first.csv")
    assert told.exit_code == 0
    assert "two.tif has 2 pages; page 1 is taken; for another one give --page" in told.err


def test_a_page_that_is_not_there(pages: Path, morfax: Morfax) -> None:
    answer = morfax("trace", pages, "--page", 3, "--path", "x.csv")
    assert answer.exit_code == 3 and "has no page 3; it has pages 1 to 2" in answer.fault
    assert not Path("x.csv").exists()


def test_two_places_and_the_length_between_them(here: Path, morfax: Morfax) -> None:
    """The curve's sheet, whose file says 300 dpi, is said to be half as large."""
    with Image.open(CURVE) as curve:
        width = curve.width
        curve.convert("L").save("bare.png")
    half_mm = width / 300 * 25.4 / 2
    words = ("--known", "0,10", f"{width},10", f"{half_mm}mm")
    answer = morfax("trace", "bare.png", *words, "--path", "half.csv", "--json")
    assert answer.exit_code == 0
    whole = morfax("trace", CURVE, "--path", "whole.csv", "--json").figures["length_mm"]
    assert answer.figures["length_mm"] == pytest.approx(whole / 2, abs=0.02)
    told = morfax("trace", "bare.png", *words, "--path", "half.csv", "-o", "half.wav").err
    assert f"--known gives 600 dpi, a sheet of {half_mm:.2f} x " in told


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("0,10", "500,10", "0mm"), "must be above zero"),
        (("0,10", "500mm,10", "90mm"), "is no place in pixels; give column and row"),
        (("0,10", "500", "90mm"), "is no place in pixels; give column and row"),
        (("0,10", "500,10"), "requires 3 arguments"),
    ],
)
def test_what_is_no_known_length(
    here: Path, morfax: Morfax, words: tuple[str, ...], said: str
) -> None:
    answer = morfax("trace", CURVE, "--path", "x.csv", "--known", *words)
    assert answer.exit_code == 2 and said in answer.fault


def test_only_one_way_to_give_a_scale(here: Path, morfax: Morfax) -> None:
    words = ("--known", "0,10", "500,10", "90mm", "--width", "90mm")
    answer = morfax("trace", CURVE, "--path", "x.csv", *words)
    assert answer.exit_code == 2
    assert "--width and --known were both given; give one of them" in answer.fault
