"""A stretch along which no way goes is one line, or two where its ink is broad enough for two."""

from __future__ import annotations

import pytest

from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.net import net_of
from morfax.tracer.ink.stretches import FeltSheet
from tests.tracer.inked import inked, polyline

INK_MM = 0.6
BAR = polyline((5, 10), (30, 10))


@pytest.mark.parametrize(("of_width", "lines"), [(1.0, 1), (1.15, 1), (1.5, 2)])
def test_ink_hardly_broader_than_a_line_is_not_run_as_two(of_width: float, lines: int) -> None:
    """On fetched sheets letters and blots were, and both lines ran within 0.3 widths of each other."""
    left = ink_left(inked(BAR, width_mm=INK_MM, seed=1).sheet)
    felt = FeltSheet.of(left.drawing, Settings(), left.ink, None, are_strokes=True)
    felt.widths_mm[0] = INK_MM / of_width
    assert len(net_of(felt, {0}).lines) == lines
    felt.together.add(0)  # it is known to be two lines: they only touch, or change sides
    assert len(net_of(felt, {0}).lines) == 2
