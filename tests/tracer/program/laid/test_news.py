"""After a bay was mended only what is near to it is looked at again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

from morfax.tracer.program.against_ink.unexplained import Unexplained
from morfax.tracer.program.laid import narrow_bays
from morfax.tracer.program.laid.bay_run import Bay
from morfax.tracer.program.laid.news import News
from morfax.tracer.program.laid.way_ink import Relaid
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import WIDTH_MM, inked
from tests.tracer.program.laid.ways import run_along

PLATE = np.array(shapely.box(4, 4, 24, 20).exterior.coords)
BAY = shapely.box(14.0, 17.0, 14.0 + 1.1 * WIDTH_MM, 21.0)
NOTCHED = np.array(shapely.box(4, 4, 24, 20).difference(BAY).exterior.coords)
FAR = np.array(shapely.box(60, 4, 80, 20).exterior.coords)


def test_a_line_far_from_a_mended_bay_is_looked_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The line with the bay is looked at until nothing more changes on it."""
    asked, mended = list[int](), narrow_bays._Bays.mended
    monkeypatch.setattr(
        narrow_bays._Bays, "mended", lambda it: asked.append(it.line.number) or mended(it)
    )
    lines = [run_along(PLATE), replace(run_along(FAR), number=2)]
    told = list[tuple[float, float]]()
    setup = Setup(
        inked(NOTCHED, FAR, seed=1).sheet, progress=lambda come, of: told.append((come, of))
    )
    (notched, far), left = narrow_bays.explained(setup, lines)
    assert notched is not lines[0] and far is lines[1] and not left
    assert asked.count(1) > 1 and asked.count(2) == 1
    assert told[:2] == [(1, 2), (2, 2)]  # the bar moves with each line


def test_what_is_new_concerns_lines_near_to_it() -> None:
    """A line that was laid anew, and a place that is no longer left unexplained."""
    line, far = run_along(PLATE), run_along(FAR)
    place = Unexplained((70.0, 21.0), 2.0, "ink")
    as_they_are = [Relaid(each, np.empty((0, 2))) for each in (line, far)]
    same = News.of(as_they_are, [], [])
    moved = News.of([Relaid(run_along(NOTCHED), NOTCHED), as_they_are[1]], [], [])
    told = News.of(as_they_are, [place], [])
    assert [same.concerns(it, []) for it in (line, far)] == [False, False]
    assert [moved.concerns(it, []) for it in (line, far)] == [True, False]
    assert [told.concerns(it, [place]) for it in (line, far)] == [False, True]
    # ink left between them may be a bar that reaches from the one to the other
    between = Unexplained((54.0, 12.0), 30.0, "ink")
    assert moved.concerns(far, [between])


def test_a_stretch_far_from_what_was_laid_anew_is_asked_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of one line with two bays: when the first was laid, the other is not looked at again, in vain."""
    asked, bay = list[tuple[int, float]](), narrow_bays._Bays._bay
    rounds = list[int]()

    def heard(it: narrow_bays._Bays, suspect: narrow_bays.Suspect) -> Bay | None:
        place = it.way[suspect.first % len(it.way)]
        asked.append((len(rounds), float(place[0])))
        return bay(it, suspect) if place[0] < 20 else None

    once = narrow_bays._once_mended
    monkeypatch.setattr(narrow_bays._Bays, "_bay", heard)
    monkeypatch.setattr(
        narrow_bays, "_once_mended", lambda *a, **k: (rounds.append(1), once(*a, **k))[1]
    )
    far_bay = shapely.box(44.0, 17.0, 44.0 + 1.1 * WIDTH_MM, 21.0)
    long = shapely.box(4, 4, 64, 20)
    truth = np.array(long.difference(BAY).difference(far_bay).exterior.coords)
    setup = Setup(inked(truth, seed=1).sheet)
    narrow_bays.explained(setup, [run_along(np.array(long.exterior.coords))])
    assert len(rounds) > 1
    assert {number for number, x_mm in asked if x_mm > 40} == {1}
