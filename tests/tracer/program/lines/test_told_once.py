"""What a sheet's lines are is asked by many rooms, of several views of the sheet; it is looked for once."""

from __future__ import annotations

import pytest

from morfax.tracer.drawing import strokes
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.program.lines import selection
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import arc, inked, polyline

PART = arc((12.0, 12.0), 8.0), arc((12.0, 12.0), 2.0), polyline((24, 4), (24, 20))


@pytest.mark.parametrize("traced", [trace_lines, trace_ink])
def test_lengths_and_numbers_are_told_once_a_sheet(
    traced: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They were made anew for each view: 20 ms and five times on a plate of 100 holes."""
    times = {"told": 0, "lines": 0}
    told, lines_of = strokes.told, selection._lines

    def counted(sheet: Sheet) -> object:
        times["told"] += 1
        return told(sheet)

    def numbered(sheet: Sheet) -> object:
        times["lines"] += 1
        return lines_of(sheet)

    monkeypatch.setattr(strokes, "told", counted)
    monkeypatch.setattr(selection, "_lines", numbered)
    assert callable(traced)
    traced(inked(*PART))
    assert times == {"told": 1, "lines": 1}


def test_a_sheet_whose_nets_count_otherwise_has_numbers_of_its_own() -> None:
    """Rings that may be reference points, or not, are other lines; so are nets as long as their outlines."""
    sheet = inked(*PART).sheet
    numbers = selection.lines_of(sheet)
    longer = sheet.told.lengths_mm.copy()
    longer[numbers[-1]] = 1000.0
    counted = sheet.counting(sheet.lengths_mm, longer)
    assert selection.lines_of(counted)[0] == numbers[-1]
    bare = strokes.replace(sheet, bare_rings=True)
    assert selection.lines_of(bare) is not selection.lines_of(sheet)
    assert selection.lines_of(sheet)[0] == numbers[0]
