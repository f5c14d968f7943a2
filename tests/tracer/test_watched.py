"""Whoever watches the head sees all of its motion, and may end the run."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.watched import watching
from morfax.tracer.program.trace import trace

CAM = Path(__file__).parents[2] / "samples" / "cam.png"


class Onlooker:
    """A watcher that keeps what it sees, and ends the run after so many mm."""

    def __init__(self, until_mm=float("inf")):
        self.runs, self.words, self.until_mm = [], set(), until_mm

    def put_down(self, carriage):
        self.runs.append([carriage.positions_mm])

    def moved(self, carriage, positions):
        self.runs[-1].append(positions / carriage.enlarged)
        if carriage.travel_mm > self.until_mm:
            raise KeyboardInterrupt

    def says(self, what):
        self.words.add(what)


def test_a_watcher_sees_every_position_of_the_run_that_became_the_line():
    onlooker = Onlooker()
    with watching(onlooker):
        seen = trace(Drawing.open(CAM))
    own = seen.lines[0].places_mm
    ways = [np.vstack(run) for run in onlooker.runs]
    # the line is cut out of one run: each of its places is one that was watched
    assert any(np.isin(own[:: len(own) // 50], way).all() for way in ways)
    assert "following" in onlooker.words


def test_a_watcher_ends_the_run_where_it_likes():
    onlooker = Onlooker(until_mm=20.0)
    with watching(onlooker), pytest.raises(KeyboardInterrupt):
        trace(Drawing.open(CAM))
    assert len(onlooker.runs) == 1
    # a second of motion at 10 mm/s is told at a time
    assert len(np.vstack(onlooker.runs[0])) < 6000 * 4


def test_nobody_watches_after_the_watching():
    onlooker = Onlooker()
    with watching(onlooker):
        pass
    trace(Drawing.open(CAM))
    assert not onlooker.runs
