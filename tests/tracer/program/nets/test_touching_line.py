"""A ragged closed line whose spikes and bays touch each other: all of it, as one closed path."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import shapely

from morfax.motion.faults import LineFault
from morfax.motion.polyline import length_mm
from morfax.tracer.following import lost
from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program import head_runs, trace
from morfax.tracer.program.nets.net_outline import of_net
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import WIDTH_MM, Points, inked
from tests.tracer.program.left_by import left_by

SIZE_MM, EDGE_MM, ROUGH = 22.0, 1.6, 0.5
# in a tuft of spikes the ink of one line is that of the next; further off is told
AWAY_MM = 1.5 * WIDTH_MM


def ragged(seed: int) -> Points:
    """A closed line of edges up to `EDGE_MM`, as coasts are: midpoints put aside until all are short."""
    random = np.random.default_rng(seed)
    for _ in itertools.count():
        angles = np.linspace(0, 2 * np.pi, 7)[:-1]
        line = np.column_stack([np.cos(angles), np.sin(angles)])
        line *= SIZE_MM / 2 * random.uniform(0.7, 1, (6, 1))
        while np.hypot(*(along := np.roll(line, -1, 0) - line).T).max() >= EDGE_MM:
            aside = random.normal(0, ROUGH / 1.6, (len(line), 1)).clip(-0.6, 0.6)
            middles = line + 0.5 * along + aside * along[:, ::-1] * (-1, 1)
            line = np.stack([line, middles], 1).reshape(-1, 2)
        if shapely.LinearRing(line).is_simple:
            break
    return np.vstack([line, line[:1]]) - line.min(axis=0) + 6


def share_on(line: Points, way: Points) -> float:
    """The share of a true line along which a way runs."""
    near = shapely.buffer(shapely.LineString(way[::10]), 0.6 * WIDTH_MM)
    truth = shapely.LineString(line)
    return float(shapely.intersection(truth, near).length / truth.length)


def away_mm(line: Points, way: Points) -> float:
    """How far a way goes from a true line, mm."""
    return float(shapely.distance(shapely.points(way), shapely.LineString(line)).max())


def test_the_head_goes_through_bays_that_the_outline_passes() -> None:
    line = ragged(103)
    drawing = inked(line, seed=103)
    outline = of_net(Setup(drawing.sheet, Settings(), Operator(), None))
    assert outline.line is not None and outline.leaves_out
    assert share_on(line, outline.line.xy_mm) < 0.95
    found = trace.trace(drawing).lines[0]
    assert found.ending == "closed"
    assert share_on(line, found.xy_mm) > 0.99 and away_mm(line, found.xy_mm) < AWAY_MM


def test_where_the_head_is_lost_the_junctions_show_the_way_round(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    line = ragged(119)
    setup = Setup(inked(line, seed=119).sheet, Settings(), Operator(), None)
    half = line[: len(line) // 2]
    head = Line(half, "lost", WIDTH_MM, length_mm(half))
    monkeypatch.setattr(head_runs, "best_of", lambda *_: (head, []))
    found = head_runs.followed(setup, None, number=3)
    assert found.ending == "closed" and found.number == 3
    # spikes narrower than two lines are left out, and said
    assert share_on(line, found.xy_mm) > 0.85 and away_mm(line, found.xy_mm) < AWAY_MM
    assert left_by(setup, [found])


def test_an_open_line_on_which_the_head_is_lost_stays_lost(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    line = ragged(119)[:-8]
    setup = Setup(inked(line, seed=119).sheet, Settings(), Operator(), None)
    head = Line(line, "lost", WIDTH_MM, length_mm(line))
    monkeypatch.setattr(head_runs, "best_of", lambda *_: (head, []))
    assert head_runs.followed(setup, None) is head


@pytest.mark.parametrize("run_mm, ending", [(5.0, "lost"), (30.0, "closed")])
def test_a_head_whose_cell_fails_at_once_is_shown_no_way(
    run_mm: float, ending: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = ragged(119)
    setup = Setup(inked(line, seed=119).sheet, Settings(), Operator(), None)
    fault = LineFault(f"line lost: {lost.CONTRADICT}")
    head = Line(line[:9], "lost", WIDTH_MM, run_mm, fault=fault)
    monkeypatch.setattr(head_runs, "best_of", lambda *_: (head, []))
    assert head_runs.followed(setup, None).ending == ending
