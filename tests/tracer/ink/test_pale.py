"""Pale lines: in the balance and told, on clean paper and on noisy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.ink.pale import pale_lines
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import arc, inked, polyline

SQUARE = polyline((6, 6), (36, 6), (36, 36), (6, 36), (6, 6))
BAR = polyline((6, 20), (36, 20))
RIM_MM = 2.0  # of the bar lies within the rims of the square's ink


def with_pale_bar(darkness: float, noise: float = 0.04) -> Drawing:
    """A square with a bar that is paler; noise is a standard deviation."""
    square, bar = inked(SQUARE, arc((20, 10), 3)), inked(BAR, SQUARE)
    pale = np.maximum(square.darkness, darkness * bar.darkness)
    rough = np.random.default_rng(1).normal(0, noise, pale.shape)
    return replace(square, darkness=np.asarray(pale + rough, np.float32))


@pytest.mark.parametrize("darkness", [0.25, 0.4])
def test_a_pale_line_is_found_with_its_place_and_length(darkness: float) -> None:
    (line,) = pale_lines(with_pale_bar(darkness))
    assert line.length_mm == pytest.approx(30 - 2 * 0.25, abs=RIM_MM)
    # the place is on the bar, within its width
    assert abs(line.y_mm - 20) < 0.5 and 6 < line.x_mm < 36


@pytest.mark.parametrize("noise", [0.0, 0.04, 0.1])
def test_paper_and_the_rims_of_ink_are_no_pale_lines(noise: float) -> None:
    assert pale_lines(with_pale_bar(0.0, noise)) == []


def test_the_share_that_was_followed_counts_pale_lines() -> None:
    ink = trace_ink(with_pale_bar(0.3)).ink
    assert ink is not None
    drawn_mm = 120 + 2 * np.pi * 3
    assert ink.followed_share == pytest.approx(drawn_mm / (drawn_mm + 30), abs=0.02)
