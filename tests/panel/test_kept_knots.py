"""Knots on disk: a run that was cut off goes on from there, and a folder from anybody does no harm."""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from morfax.panel.kept_knots import KeptKnots
from morfax.tracer.following.follower import Follower
from morfax.tracer.following.knots import Memory, remembering
from morfax.tracer.head import watched
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.following.test_knots import COMB, START, same
from tests.tracer.inked import inked, polyline


class CutOff(Exception):
    """What ends a run in the middle, as a killed worker does."""


class Cuts:
    """A watcher that ends the run after so much travel."""

    def __init__(self, mm: float) -> None:
        self.mm = mm

    def put_down(self, carriage: Carriage) -> None:
        pass

    def taken_up(self, carriage: Carriage) -> None:
        pass

    def moved(self, carriage: Carriage, positions: np.ndarray) -> None:
        if carriage.travel_mm > self.mm:
            raise CutOff

    def says(self, what: str) -> None:
        pass


def cut_off(
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    run: Callable[[], object] = lambda: trace(COMB, START),
    after_mm: float = 40.0,
) -> KeptKnots:
    """A run that was cut off after so much of a line, with its knots in a folder."""
    monkeypatch.setattr("morfax.panel.kept_knots.EVERY_S", 0.0)
    monkeypatch.setattr("morfax.panel.kept_knots.SHARE", np.inf)
    kept = KeptKnots(folder)
    kept.begin("as set")
    with (
        pytest.raises(CutOff),
        remembering(Memory(kept.keep)),
        watched.watching(Cuts(after_mm)),
    ):
        run()
    return kept


def test_a_run_that_was_cut_off_goes_on_and_comes_to_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cut_off(tmp_path / "knots", monkeypatch)
    again, memory = KeptKnots(tmp_path / "knots"), Memory()
    assert again.take_up("otherwise", Memory()) == 0.0
    come_mm = again.take_up("as set", memory)
    assert come_mm > 30.0
    with remembering(memory):
        went_on = trace(COMB, START)
    assert memory.replayed_mm == come_mm  # not from the beginning
    assert same(went_on, trace(COMB, START))
    again.end()
    assert not (tmp_path / "knots").exists()


def test_a_line_beside_one_that_was_cut_goes_on_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plate = inked(  # the hole of 36 mm is cut first, and the head goes onto its ink no more
        polyline((6, 6), (60, 6), (60, 30), (6, 30), (6, 6)),
        polyline((20, 14), (30, 14), (30, 22), (20, 22), (20, 14)),
        seed=6,
    )
    cut_off(tmp_path / "knots", monkeypatch, lambda: trace_lines(plate), 100.0)
    again, memory = KeptKnots(tmp_path / "knots"), Memory()
    assert again.take_up("as set", memory) > 90.0  # mm; the outline's, and the hole's
    with remembering(memory):
        went_on = trace_lines(plate)
    assert memory.replayed_mm > 90.0
    assert same(went_on, trace_lines(plate))


def test_what_is_kept_calls_nothing_when_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cut_off(tmp_path / "knots", monkeypatch)
    (file,) = (tmp_path / "knots").glob("*.knot")
    whole = file.read_bytes()

    class Harm:
        def __reduce__(self) -> tuple[object, tuple[str]]:
            return os.mkdir, (str(tmp_path / "harm"),)

    reached = b"\x80\x04\x8c\x1cmorfax.tracer.head.settings\x94\x8c\x0bchoose\x94\x93."
    for content in (b"", whole[:-20], b"nonsense", pickle.dumps(Harm()), reached):
        file.write_bytes(content)
        assert KeptKnots(tmp_path / "knots").take_up("as set", Memory()) == 0.0
    assert not (tmp_path / "harm").exists()


def test_knots_are_written_twice_a_second_at_most(tmp_path: Path) -> None:
    kept, came = KeptKnots(tmp_path / "knots"), list[float]()

    def keep(key: object, at: object, head: Follower) -> None:
        before = {f: f.stat().st_mtime_ns for f in (tmp_path / "knots").glob("*.knot")}
        kept.keep("one", (), head)
        after = {f: f.stat().st_mtime_ns for f in (tmp_path / "knots").glob("*.knot")}
        came.append(float(before != after))

    with remembering(Memory(keep)):
        trace(COMB, START)
    assert 1.0 <= sum(came) <= max(2, len(came) / 2)
