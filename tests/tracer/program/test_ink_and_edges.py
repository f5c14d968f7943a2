"""`--lines all --edge`: lines along their middle, and solid areas among them round their edges."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.contour import distance
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.drawing.shapes_among_lines import drawing_of_both, has_lines
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import UM, Points, arc, inked, polyline

FRAME = polyline((6, 6), (36, 6), (36, 36), (6, 36), (6, 6))
WALL = polyline((6, 46), (40, 46), (40, 49), (6, 49), (6, 46))
TO_WALL = polyline((20, 36), (20, 47))
ENTRY = np.array([20.0, 46.0])
DISC = arc((44, 20), 2.0)
TO_DISC = polyline((36, 20), (44, 20))
SMALL = arc((44, 30), 0.6)
TO_SMALL = polyline((36, 30), (44, 30))
DPI = 300.0
PIXEL_MM = 25.4 / DPI


def levels(
    *lines: Points, shapes: tuple[Points, ...] = (), width_mm: float = 0.5
) -> np.ndarray:
    ink = inked(*lines, specks=shapes, width_mm=width_mm, seed=1).darkness
    return np.clip(np.round(235 - 195 * ink), 0, 255).astype(np.uint8)


def both(*lines: Points, shapes: tuple[Points, ...] = (), width_mm: float = 0.5) -> Drawing:
    grey = levels(*lines, shapes=shapes, width_mm=width_mm)
    return drawing_of_both(Scan(Path("made.png"), grey, Stated((DPI, DPI))), Scale())


def test_lines_by_their_middle_and_solid_areas_by_their_edge() -> None:
    run = trace_ink(both(FRAME, TO_WALL, TO_DISC, shapes=(WALL, DISC)))
    outlines = {round(line.length_mm): line for line in run.lines if line.on_edge}
    assert len(outlines) == 2 and all(line.ending == "closed" for line in outlines.values())
    disc, wall = (outlines[k] for k in sorted(outlines))
    # where a line enters the edge is not seen, half a width and the softness to both sides
    clear = np.hypot(*(wall.xy_mm - ENTRY).T) > 0.6
    off = distance(wall.xy_mm[clear][::4], WALL).path_to_reference
    assert off.rms_mm < 12 * UM
    # the disc that tells what is solid goes into the line's mouth by 0.6 pixels; with a pixel to both sides
    assert distance(wall.xy_mm[~clear], WALL).path_to_reference.max_mm < 2.6 * PIXEL_MM
    free = disc.xy_mm[:, 0] > 42.2
    assert distance(disc.xy_mm[free][::4], DISC).path_to_reference.rms_mm < 10 * UM
    assert run.ink is not None and run.ink.followed_share > 0.99
    assert run.ink.followed_mm == pytest.approx(120 + 10 + 6, rel=0.04)
    assert [area.what for area in run.ink.areas] == ["outlined area", "outlined area"]
    assert not run.ink.solids
    assert sorted(line.number for line in run.lines) == list(range(1, len(run.lines) + 1))


def test_an_area_too_small_for_an_edge_is_left_out_and_told() -> None:
    run = trace_ink(both(FRAME, TO_SMALL, shapes=(SMALL,), width_mm=0.3))
    assert run.ink is not None
    assert (
        not any(line.on_edge for line in run.lines) or run.ink.areas[0].what == "outlined area"
    )
    assert len(run.ink.areas) == 1


def test_silhouettes_are_gone_round_with_their_thin_parts() -> None:
    turns = np.linspace(0, 2 * np.pi, 11)
    radii = np.where(np.arange(11) % 2, 7.0, 15.0)
    star = (18, 18) + radii[:, None] * np.column_stack([np.cos(turns), np.sin(turns)])
    drawing = both(shapes=(star,))
    assert not has_lines(drawing)
    run = trace_ink(drawing)
    assert run.ink is None and len(run.lines) == 1
    assert run.lines[0].ending == "closed"
    assert distance(run.lines[0].xy_mm[::4], star).path_to_reference.rms_mm < 20 * UM


def test_a_long_wall_counts_as_outlined_wherever_it_lies_between_the_pixels() -> None:
    """Its edge is where the lens is half open, up to a pixel outside of the box of its pixels."""
    run = trace_ink(both(FRAME, shapes=(WALL + 0.04,)))
    assert run.ink is not None and [area.what for area in run.ink.areas] == ["outlined area"]
