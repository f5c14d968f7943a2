"""Long lines: kept in files and looked at in blocks, they are traced as those in memory, to the last bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.jobs.settings import zero
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.zero import ZeroOnSheet, _part_mm
from morfax.jobs.trace import TraceJob, TraceOutputs
from morfax.motion import long_array
from morfax.motion.arrays import Array
from morfax.motion.long_array import is_mapped
from morfax.motion.motion import join
from morfax.motion.placement import Placement
from morfax.motion.polyline import lengths_mm
from morfax.tracer.cutter.contour import MET_MM, _closed
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head import loop
from morfax.tracer.head.trail import Trail
from morfax.tracer.operator.card import Card
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.passes import braking
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import arc, dot, inked, polyline

POSITIONS = np.array([[0.0, 0.0], [1.0, 2.0]])
CIRCLE = inked(arc((14, 14), 8), seed=1)
OPEN = inked(polyline((4, 4), (24, 4), (24, 12)), seed=1)  # ends at both ends
# a line that runs into a loop
STEM = inked(arc((20, 14), 7), polyline((4, 14), (13, 14)), seed=1)
DASHED = inked(polyline((4, 4), (16, 4)), polyline((18, 4), (30, 4)), seed=1)
MARKED = inked(arc((14, 14), 8), dot((14, 22), 0.8), polyline((20, 14), (24, 14)), seed=1)
DRAWINGS = {"circle": CIRCLE, "open": OPEN, "stem": STEM, "dashed": DASHED, "marked": MARKED}


def short(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have 500 positions, 0.8 mm, be a long line, and look at 301 of them together."""
    monkeypatch.setattr(long_array, "IN_MEMORY_BYTES", 16 * 500)
    monkeypatch.setattr(long_array, "BLOCK_ROWS", 301)


def traced(drawing: Drawing) -> Trace:
    """A line, with its marks taken for marks."""
    return trace(drawing, operator=Operator(card=Card(), marks="on"))


def figures(found: Trace) -> list[object]:
    """What a trace says of its lines."""
    return [
        (
            *(line.ending, line.length_mm, line.marks, line.breaks, line.loop_from),
            *(
                line.led,
                line.gap_mm,
                line.cell_share,
                line.place(100.5),
                line.places_mm.tolist(),
            ),
        )
        for line in found.lines
    ]


@pytest.mark.parametrize("name", DRAWINGS)
def test_a_line_in_a_file_is_traced_as_one_in_memory(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = traced(DRAWINGS[name])
    expected = join(whole).positions_mm
    assert not is_mapped(whole.lines[0].xy_mm)
    short(monkeypatch)
    filed = traced(DRAWINGS[name])
    assert is_mapped(filed.lines[0].xy_mm)
    assert np.array_equal(filed.xy_mm, whole.xy_mm) and figures(filed) == figures(whole)
    assert np.array_equal(join(filed).positions_mm, expected)


def test_all_the_ink_is_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = trace_ink(STEM)
    short(monkeypatch)
    filed = trace_ink(STEM)
    assert is_mapped(filed.lines[0].xy_mm) and np.array_equal(filed.xy_mm, whole.xy_mm)


@pytest.mark.parametrize("turn_rad", [0.0, 0.3])
def test_the_size_of_the_part_is_that_of_all_its_places(
    turn_rad: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    placement = Placement(turn_rad=turn_rad, about_mm=(3.0, 4.0))
    (places,) = _part_mm(trace(CIRCLE))
    expected = np.ptp(placement.places(places), axis=0)
    short(monkeypatch)
    wanted = ZeroOnSheet("lower-left", followed=trace(CIRCLE))
    # as good as equal: a product may be rounded otherwise
    assert wanted.part_size_mm(placement) == pytest.approx(expected.tolist(), abs=1e-12)
    low = placement.places(places).min(axis=0)
    assert wanted.origin_mm(placement) == pytest.approx(low.tolist(), abs=1e-12)


def test_the_size_of_the_part_is_made_out_for_programs_that_tell_it_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A path has no head; to bring its contours together took a tenth of a plate of holes."""
    asked = list[Trace]()
    monkeypatch.setattr(
        zero, "_part_mm", lambda followed: asked.append(followed) or (POSITIONS,)
    )
    for name, times in (("a.csv", 0), ("a.wav", 0), ("a.ngc", 1)):
        asked.clear()
        outputs = TraceOutputs(tmp_path / name)
        TraceJob(DrawingFile(Path("samples/cam.png")), outputs).run()
        assert len(asked) == times, name


@pytest.mark.parametrize("seed", range(3))
def test_a_contour_is_brought_together_by_what_is_left_to_its_ends(seed: int) -> None:
    places = way(seed) * 20
    come_mm = lengths_mm(places)
    after = np.clip(1 - come_mm / MET_MM, 0.0, 1.0)
    before = np.clip(1 - (come_mm[-1] - come_mm) / MET_MM, 0.0, 1.0)
    expected = places + (after - before)[:, None] * (0.5 * (places[-1] - places[0]))
    assert come_mm[-1] > 2 * MET_MM and (_closed(places) == expected).all()


def way(seed: int) -> Array:
    """A wavering way of 900 positions, on which the head stands now and then."""
    rng = np.random.default_rng(seed)
    steps = np.abs(np.cumsum(rng.normal(size=900))) * 1e-4
    steps[rng.integers(0, 900, 100)] = 0
    heading = np.cumsum(0.02 * rng.normal(size=900))
    return np.cumsum(steps * np.array([np.cos(heading), np.sin(heading)]), axis=1).T


@pytest.mark.parametrize("rows", [13, 97])
def test_stops_are_the_same_in_blocks(rows: int, monkeypatch: pytest.MonkeyPatch) -> None:
    halts = [0.0, 3.25, 3.75, 200.0, 200.0, 512.5, 899.0]
    for seed in range(5):
        monkeypatch.setattr(long_array, "BLOCK_ROWS", 240_000)
        whole = braking.pieces(way(seed), halts, 500.0, 6000.0)
        monkeypatch.setattr(long_array, "BLOCK_ROWS", rows)
        parts = braking.pieces(way(seed), halts, 500.0, 6000.0)
        assert all(np.array_equal(a, b) for a, b in zip(whole, parts, strict=True))


def test_a_long_trail_is_only_looked_at_near_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of rows of 0.5 m, 3 mm apart, no place is compared; where the way comes again, those near it are."""
    looked = list[int]()
    compare = loop.comes_again
    monkeypatch.setattr(loop, "comes_again", lambda *a: looked.append(1) or compare(*a))
    trail, step_mm = Trail(np.zeros(2), 0.05), 0.04
    x = np.arange(0, 500, step_mm)
    for row in range(20):
        trail.add(np.column_stack([x if row % 2 == 0 else x[::-1], np.full(len(x), 3.0 * row)]))
        assert not trail.comes_again(0.5)
    assert not looked
    trail.add(np.column_stack([x[:500], np.zeros(500)]))
    assert trail.comes_again(0.5) and len(looked) == 1
