"""After a bay was mended only what is near to it is looked at again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

from morfax.tracer.program.against_ink.unexplained import Unexplained
from morfax.tracer.program.laid import narrow_bays
from morfax.tracer.program.laid.news import News
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
    """A line that lies elsewhere than before, and a place that is no longer left unexplained."""
    line, far = run_along(PLATE), run_along(FAR)
    place = Unexplained((70.0, 21.0), 2.0, "ink")
    same = News.between(([line, far], []), ([line, replace(far)], []))
    moved = News.between(([line, far], []), ([run_along(NOTCHED), far], []))
    told = News.between(([line, far], [place]), ([line, far], []))
    assert [same.concerns(it, []) for it in (line, far)] == [False, False]
    assert [moved.concerns(it, []) for it in (line, far)] == [True, False]
    assert [told.concerns(it, [place]) for it in (line, far)] == [False, True]
    # ink left between them may be a bar that reaches from the one to the other
    between = Unexplained((54.0, 12.0), 30.0, "ink")
    assert moved.concerns(far, [between])
