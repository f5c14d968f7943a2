"""Lines that run together for a while keep their partners, and stay in the ink that they share."""

from __future__ import annotations

import numpy as np

from morfax.motion.contour import distance
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.felt import feel_along
from morfax.tracer.ink.shared_ink import SLACK, SharedInk, kept_in_ink
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, Points, inked, polyline

ACROSS = np.linspace(-12.0, 12.0, 400)


def bow(aside_mm: float) -> Points:
    """An arc of 30 mm radius about, its lowest place so far to one side."""
    return np.column_stack([20 + ACROSS, 10 + (ACROSS - aside_mm) ** 2 / 60])


def test_a_way_beside_the_ink_is_moved_into_it() -> None:
    line = polyline((5, 10), (35, 10))
    view = View(photocell.behind_aperture(inked(line, seed=1), 0.1), WIDTH_MM)
    felt = feel_along(view, polyline((6, 10), (34, 10)))
    # a bow that leaves the ink by 0.3 mm half way
    at = np.linspace(8, 32, 500)
    way = np.column_stack([at, 10 + 0.3 * np.sin(np.pi * (at - 8) / 24)])
    kept = kept_in_ink(way, SharedInk([felt]), WIDTH_MM)
    inner = np.abs(at - 20) < 10
    assert np.abs(kept[inner, 1] - 10).max() < SLACK * WIDTH_MM + 15 * UM
    assert np.array_equal(kept[[0, -1]], way[[0, -1]])
    # ink across the way says nothing
    crossing = feel_along(view, polyline((6, 10), (34, 10)))
    steep = np.column_stack([20 + 0.5 * (at - 20), 10 + 0.5 * (at - 20)])
    assert np.array_equal(kept_in_ink(steep, SharedInk([crossing]), WIDTH_MM), steep)


def test_two_bows_that_share_their_ink_are_two_strokes_each_near_its_own_line() -> None:
    one, other = bow(-1.5), bow(1.5)
    run = trace_ink(inked(one, other, seed=1), Settings())
    assert len(run.lines) == 2
    assert run.ink is not None and run.ink.followed_share > 0.99
    for truth in (one, other):
        off = min(
            (distance(line.xy_mm[::4], truth).path_to_reference for line in run.lines),
            key=lambda summary: summary.rms_mm,
        )
        assert off.rms_mm < 60 * UM and off.max_mm < 0.5 * WIDTH_MM
