"""Printed letters: their strokes swell, small loops end where they begin, and each stroke is one line."""

from __future__ import annotations

from pathlib import Path

import cv2
import matplotlib
import numpy as np
import pytest
from PIL import Image, ImageDraw, ImageFont

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink import solving
from morfax.tracer.ink.chains import Junctions
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.net import net_of
from morfax.tracer.ink.solving import solved
from morfax.tracer.ink.stretches import FeltSheet
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import DPI, NOISE, arc, inked, polyline

FONTS = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
LINE_PX, LEFT_PX = 110, 40
LENS_PX = 0.6  # standard deviation of the spot
# of the middle lines of ink; what is left are tips of serifs and stumps beside stems
SHARE = 0.97


def printed(font: str, size_px: int, *texts: str) -> Drawing:
    """A page of lines of print, scanned with noise."""
    page = Image.new("L", (900, LINE_PX * len(texts) + 20), 255)
    letters = ImageFont.truetype(str(FONTS / font), size_px)
    for k, text in enumerate(texts):
        ImageDraw.Draw(page).text((LEFT_PX, 20 + LINE_PX * k), text, font=letters, fill=0)
    clean = cv2.GaussianBlur(1 - np.asarray(page, np.float32) / 255, (0, 0), LENS_PX)
    noise = np.random.default_rng(1).normal(0, NOISE, clean.shape)
    return Drawing(np.asarray(clean + noise, np.float32), 25.4 / DPI)


@pytest.mark.parametrize(
    ("font", "size_px"),
    [
        ("DejaVuSerif.ttf", 72),
        ("DejaVuSerif-Bold.ttf", 48),
        ("DejaVuSerif-Bold.ttf", 72),
        ("DejaVuSans-Bold.ttf", 36),
        ("STIXGeneral.ttf", 72),
    ],
)
def test_letters_whose_strokes_swell_are_followed(font: str, size_px: int) -> None:
    """Bowls and stems were taken for two lines that run together, and a fifth of a page was lost; and of an 8
    half a loop, of a g half a bowl, of an E the stem.
    """
    ink = trace_ink(printed(font, size_px, "DRAWING 3986", "SEGa Rg Bead")).ink
    assert ink is not None
    assert ink.lost == ()
    assert ink.followed_share > SHARE


def test_a_small_loop_is_run_round() -> None:
    """A nine of a clean pen: the head stands as near to the loop's end as to its beginning."""
    nine = arc((12.0, 20.0), 1.7), polyline((13.7, 20), (13.7, 14))
    ink = trace_ink(inked(*nine, polyline((5, 5), (30, 5)), width_mm=0.4, seed=1)).ink
    assert ink is not None and ink.followed_share > 0.995


def test_no_stretch_is_left_without_a_way_when_the_rounds_are_used_up(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Ways that joined the lines about such stretches led over bare paper."""
    drawing = printed("DejaVuSerif-Bold.ttf", 48, "REARED")
    felt = FeltSheet.of(drawing, Settings(), ink_left(drawing.sheet).ink)
    first = Junctions(net_of(felt, set()), Settings())
    assert not all(first.covers(inner) for inner in first.net.inner)
    monkeypatch.setattr(solving, "ROUNDS", 0)
    junctions = solving.solved(felt)
    assert all(junctions.covers(inner) for inner in junctions.net.inner)


def test_lines_that_are_found_elsewhere_do_not_undo_what_was_solved(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Stretches that no way goes along become lines; two lines told far away left them without any again."""
    drawing = printed("DejaVuSerif-Bold.ttf", 48, "REARED", "| | | | |")
    felt = FeltSheet.of(drawing, Settings(), ink_left(drawing.sheet).ink)
    before = {line.stretch for line in net_of(felt, set()).lines}
    alone = [n for n, ends in enumerate(felt.ends) if ends == (True, True)]
    told = dict[int, int]()  # by whom

    def one_more(junctions: Junctions, number: int, _: float) -> float | None:
        """The width of one of the lines that stand alone, first and whenever others have become lines."""
        lines = junctions.net.lines
        stretch, more = lines[number].stretch, {line.stretch for line in lines} - before
        is_new = stretch in alone and stretch not in told
        if not is_new or (told and not more) or id(junctions) in told.values():
            return None
        told[stretch] = id(junctions)
        return felt.widths_mm[stretch]

    monkeypatch.setattr(Junctions, "single_mm", one_more)
    after = {line.stretch for line in solved(felt).net.lines}
    assert len(told) > 1
    assert after > before
