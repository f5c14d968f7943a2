"""The slow cell: it follows tight bends by itself, and what was felt only checks it.

The wave bends up to 0.73 per mm, twice what a fast cell may follow unasked. Broken on purpose, with `lead_mm`
of `slowly` left at the fast head's: the cell's share of a wave falls to a half; with `square` left at False,
the path of a hole of 0.85 mm is not the cell's.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.contour import distance, distances_mm
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.following.follower import Follower
from morfax.tracer.following.start import put_down
from morfax.tracer.head import slow_cell
from morfax.tracer.head.leaders import CELL, STATIONS
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.slow_cell import (
    FeltStretch,
    Tried,
    TunedPiece,
    along,
    heads_along,
    keeps_mm,
    keeps_to,
    pieces,
)
from morfax.tracer.head.state import DRUM, MORE, Home, put_on_drum
from morfax.tracer.head.windows import Ahead, narrowest
from morfax.tracer.program.trace import trace
from tests.tracer.inked import UM, WIDTH_MM, arc, inked

NEVER_HOME = Home(0.0, 0.0, 0.0, 1e9)
RADIUS_MM = 2.0  # a fast cell stops here: 0.5 per mm


def wave() -> Array:
    """A sine of 1.5 mm and 9 mm wavelength: its bends change throughout, up to 0.73 per mm."""
    x = np.linspace(0, 36, 3600)
    return np.column_stack([x + 4, 6 + 1.5 * np.sin(2 * np.pi * x / 9)])


@pytest.fixture(scope="module")
def head() -> Follower:
    """A head put down on a small circle."""
    stance, _ = next(iter(put_down(inked(arc((8, 8), RADIUS_MM), seed=1))))
    return Follower(stance, Settings(), MOTION_RATE_HZ)


def ahead(head: Follower, radius_mm: float, length_mm: float = 1.5) -> Array:
    """A way along the circle from where the head stands, on a circle of another radius, (n, 2) mm."""
    place, heading = head.carriage.stands()
    out = place - (8.0, 8.0)
    c, s = np.cos(heading), np.sin(heading)
    side = np.sign(out[0] * s - out[1] * c)
    at = np.arctan2(out[1], out[0]) + side * np.linspace(0, length_mm / RADIUS_MM, 80)
    return 8.0 + radius_mm * np.column_stack([np.cos(at), np.sin(at)])


def tried(head: Follower, radius_mm: float, within_mm: float) -> Tried | None:
    """The slow cell along such a way."""
    way = FeltStretch(ahead(head, radius_mm), within_mm)
    return along(head.view.cells, head.carriage.state, course(head, way), NEVER_HOME, way)


def course(head: Follower, way: FeltStretch) -> list[TunedPiece]:
    """The slow cell's narrow window along a way."""
    felt = Ahead(way.way, WIDTH_MM)
    return pieces(head.carriage.tuning, felt, narrowest(head.carriage.tuning, felt))


def test_the_cell_steers_and_not_what_was_felt(head: Follower) -> None:
    """A way 15 um outside of the line is kept to within 30 um, and the head is on the line all the same."""
    went = tried(head, RADIUS_MM + 15 * UM, 30 * UM)
    assert went is not None and went.felt_mm == 0
    off_mm = distances_mm(went.positions[::8], arc((8, 8), RADIUS_MM))
    assert len(off_mm) > 100 and off_mm.max() < 10 * UM


def test_a_way_beside_the_line_is_not_the_cell_s(head: Follower) -> None:
    """60 um off what was felt it has lost the line; then the head has not moved."""
    before = head.carriage.state.copy()
    assert tried(head, RADIUS_MM + 60 * UM, 30 * UM) is None
    assert (
        head.carriage.state.x_mm == before.x_mm and head.carriage.state.places == before.places
    )


def test_a_cell_that_has_lost_the_line_begins_on_what_was_felt(head: Follower) -> None:
    """Its sweep nearly a mm off the line: the drum is filled with what was felt."""
    carriage = head.carriage
    state = carriage.state.copy()
    state.middle_mm += 4.0
    way = FeltStretch(ahead(head, RADIUS_MM), 20 * UM)
    run = course(head, way)
    went = along(head.view.cells, state, run, NEVER_HOME, way)
    tuning = run[0].tuning
    assert went is not None and went.felt_mm == pytest.approx(tuning.lead_mm - tuning.point_mm)


def test_a_drum_that_is_filled_with_too_much_remembers_the_last_of_it(head: Follower) -> None:
    """A broad line is felt for more places than the drum has: 5 mm broad it was a traceback."""
    state = head.carriage.state.copy()
    places = np.column_stack([np.arange(DRUM + 31.0), np.zeros(DRUM + 31)])
    put_on_drum(state, places[:9])
    assert state.places == 9 and np.array_equal(state.drum_mm[:9], places[:9])
    put_on_drum(state, places)
    assert state.places == DRUM and np.array_equal(state.drum_mm, places[31:])


def test_the_mount_slides_out_again_without_a_gap_in_the_drum(head: Follower) -> None:
    """After a stretch with a short lead, places on the drum are no further apart than two sweeps' way."""
    went = tried(head, RADIUS_MM, 30 * UM)
    assert went is not None
    fast, state = head.carriage.tuning, went.state
    assert state.lead_mm < 0.75 * fast.lead_mm
    first = state.places
    state.trusted_mm = np.inf
    slow_cell.kernel.follow(head.view.cells, state, fast, NEVER_HOME, np.empty((1200, 2)))
    places = state.drum_mm[first - 1 : state.places]
    two_sweeps_mm = 2 * fast.speed_mm_s * fast.sweep_periods * fast.period_s
    assert state.lead_mm == fast.lead_mm
    assert (
        np.hypot(*np.diff(places, axis=0).T).max() < 1.3 * two_sweeps_mm
    )  # the bend's outside


def test_a_rough_line_may_be_seen_further_off(head: Follower) -> None:
    """Three standard deviations of the middle: half of those of the width. 0.2 pixels are 17 um."""
    widths = 0.5 + 40 * UM * np.random.default_rng(1).normal(size=400)
    seen = np.column_stack([np.zeros((400, 2)), widths])
    assert keeps_mm(head.view, seen) == pytest.approx(3 * 20 * UM, rel=0.15)
    seen[:, 2] = 0.5
    assert keeps_mm(head.view, seen) == pytest.approx(17 * UM, abs=1 * UM)


def test_a_cell_on_a_dry_marker_may_go_beside_what_was_felt_by_8_percent_of_its_width(
    head: Follower,
) -> None:
    """Its stations show the grain of a slit, and not how far that moves the ink's middle over some mm."""
    seen = np.column_stack([np.zeros((400, 2)), np.full(400, 1.2)])
    dry = replace(head.view, width_mm=1.2, grainy=True)
    assert keeps_mm(dry, seen) == pytest.approx(96 * UM)
    assert keeps_mm(replace(dry, grainy=False), seen) == pytest.approx(24 * UM)


def test_tight_bends_are_the_cell_s() -> None:
    """95 % of a wave whose every crest stopped the fast cell; 31 % of it were the cell's before."""
    line = trace(inked(wave(), seed=1)).lines[0]
    led = line.led.lengths_mm(line.xy_mm)
    assert led[CELL] > 0.95 * (led[CELL] + led[STATIONS])
    assert distance(line.xy_mm, wave()).path_to_reference.rms_mm < 8 * UM


@pytest.mark.parametrize("radius_mm", [0.85, 1.2])
def test_a_small_circle_is_not_cut(radius_mm: float) -> None:
    """The lens moves its line inward by 2 um. With a sweep across the heading the cell's path lies 11 um
    inside a circle of 1.2 mm, and one of 0.85 mm is not its own: the sweep stands square to the bend.
    """
    line = trace(inked(arc((8, 8), radius_mm), seed=1)).lines[0]
    led = line.led.lengths_mm(line.xy_mm)
    assert led[CELL] > led[STATIONS]
    beside_mm = np.hypot(*(line.xy_mm - 8).T).mean() - radius_mm
    assert abs(beside_mm) < 4 * UM


def hard(line: Array, width_mm: float, dpi: float) -> Drawing:
    """The drawing of a line in black and white, without any grey."""
    ink = inked(line, width_mm=width_mm, dpi=dpi, seed=1).darkness
    grey = np.where(ink > 0.5, 0, 255).astype(np.uint8)
    return Drawing.of(Scan(Path("made.png"), grey, Stated((dpi, dpi))), Scale())


@pytest.mark.parametrize(("width_mm", "dpi"), [(0.6, 100), (0.35, 120)])
def test_the_stairs_of_hard_pixels_do_not_stop_the_cell(width_mm: float, dpi: float) -> None:
    """On lines of two pixels its narrow parabola bends by their stairs; a wide one goes on: 92 and 88 % of a
    circle of 12 mm are the cell's, 74 and 72 % without. A quarter of a pixel RMS is what such pixels know.
    """
    circle = arc((16, 16), 12)
    line = trace(hard(circle, width_mm, dpi)).lines[0]
    led = line.led.lengths_mm(line.xy_mm)
    assert line.ending == "closed"
    assert led[CELL] > 0.85 * (led[CELL] + led[STATIONS]), led
    off = distance(line.xy_mm[::4], circle).path_to_reference
    assert off.rms_mm < 0.25 * 25.4 / dpi


@pytest.mark.parametrize(("turned_rad", "is_kept"), [(0.0, True), (0.2, True), (0.3, False)])
def test_a_head_that_has_turned_away_does_not_keep_to_the_way(
    head: Follower, turned_rad: float, is_kept: bool
) -> None:
    """A tick turns the head before it is off the way; also where it has stopped on the way."""
    way = ahead(head, RADIUS_MM)
    for last in (len(way) // 2, len(way)):
        dx, dy = way[min(last, len(way) - 1)] - way[last - 3]
        state = head.carriage.state.copy()
        state.heading_rad = math.atan2(dy, dx) + turned_rad
        assert heads_along(Tried(way[:last], state, MORE), way) is is_kept


@pytest.mark.parametrize("off_mm", [0.0, 0.004, 0.0099, 0.0101, 0.05])
def test_positions_keep_to_a_way_by_their_distance_from_its_nearest_piece(
    off_mm: float,
) -> None:
    """The way comes by at its beginning again at its end, as round a loop."""
    angle = np.linspace(0.0, 2 * np.pi + 0.5, 700)
    way = 3.0 * np.column_stack([np.cos(angle), np.sin(angle)])
    there = np.linspace(0.0, 2 * np.pi + 0.5, 9000)
    positions = (3.0 + off_mm) * np.column_stack([np.cos(there), np.sin(there)])
    stretch = FeltStretch(way, within_mm=0.01)
    expected = float(distances_mm(positions[:: slow_cell.CHECKED], [way]).max()) < 0.01
    assert keeps_to(positions, stretch) == expected == (off_mm < 0.01)
    assert not keeps_to(positions[:0], stretch)


def test_the_wide_window_is_only_sought_where_the_cell_does_not_keep_to_the_way(
    head: Follower, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = list[Array]()
    monkeypatch.setattr(
        slow_cell, "widest", lambda t, felt: asked.append(felt.way) or narrowest(t, felt)
    )
    view, carriage = head.view, head.carriage
    way = ahead(head, RADIUS_MM)
    stretch = FeltStretch(
        way, keeps_mm(view, np.column_stack([way, np.full(len(way), WIDTH_MM)]))
    )
    args = view, carriage.state, carriage.tuning, NEVER_HOME
    assert slow_cell.follow(*args, stretch) is not None and not asked
    assert slow_cell.follow(*args, stretch._replace(within_mm=0.0)) is None and len(asked) == 1
