"""What is advised for the drawn lines of a PDF: a resolution to read the page at, and no finer scan."""

import re
from pathlib import Path

import numpy as np

import morfax as package
from morfax.jobs.settings.on_pages import FINER, fault_of_page, of_page
from morfax.motion.faults import LineFault
from morfax.tracer.drawing.drawing import Drawing
from tests.console.conftest import Morfax
from tests.tracer.drawing.test_pdf import written

PIXELS = np.zeros((4, 4), np.float32)
PAGE = Drawing(PIXELS, 25.4 / 1200, finer=4, is_rendered=True)  # of 300 dpi
SCAN = Drawing(PIXELS, 25.4 / 300)


def test_a_page_is_read_finer_and_a_scan_is_made_finer() -> None:
    text = "look there, or scan at a higher resolution; scan at 450 dpi or more"
    assert of_page(text, PAGE) == "look there, or give --dpi 600; give --dpi 450 or more"
    assert of_page(text, SCAN) == text
    fault = LineFault(f"line lost; {FINER}", x_mm=1.0)
    assert str(fault_of_page(fault, PAGE)) == "line lost; give --dpi 600" and fault.x_mm == 1.0


def test_every_finer_scan_is_advised_in_the_words_that_a_page_changes() -> None:
    for room in ("tracer", "jobs"):
        for file in (Path(package.__file__).parent / room).rglob("*.py"):
            for line in file.read_text().splitlines():
                if re.search(r"\b(scan|finer)\b.*\bat a higher resolution", line):
                    assert FINER in line, file


def test_a_page_on_which_no_line_can_be_begun_is_to_be_read_finer(
    here: Path, morfax: Morfax
) -> None:
    """Three millimetres of a broad line, of a page that is read at 600 dpi."""
    square = written(here / "square.pdf", "50 50 3 3 re f", (100.0, 100.0))
    answer = morfax("trace", square, "--lines", "all", "--path", "square.csv")
    assert "no line can be begun" in answer.fault and "give --dpi 1200" in answer.fault


def test_what_is_told_while_a_page_is_opened_is_that_page(here: Path, morfax: Morfax) -> None:
    """A frame of 0.8 mm, drawn filled, of a page that is read at 40 dpi: little more than a pixel."""
    page = written(
        here / "thin.pdf", "20 20 60 60 re 20.8 20.8 58.4 58.4 re f*", (100.0, 100.0)
    )
    answer = morfax("trace", page, "--dpi", "40", "--path", "thin.csv")
    assert "pixels wide" in answer.err and "give --dpi" in answer.err
    assert "scan at" not in answer.err
