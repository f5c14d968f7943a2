"""What cells have seen of a sheet is given back when no head needs it any more."""

from __future__ import annotations

import weakref
from typing import Any

import pytest

from morfax.tracer.following.plain_places import view_of
from morfax.tracer.program import trace_ink as trace_ink_module
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.sensing import photocell
from tests.tracer.ink.test_all_ink import BAR, SPUR, SQUARE
from tests.tracer.inked import WIDTH_MM, inked


def test_what_the_cells_saw_is_gone_when_the_strokes_are_held_against_the_ink(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each sheet behind an aperture is as large as the drawing."""
    drawing, seen, alive = inked(SQUARE, BAR, SPUR), list[Any](), dict[str, int]()
    behind = photocell.behind_aperture

    def kept(*args: Any, **named: Any) -> photocell.Cells:
        cells = behind(*args, **named)
        seen.append(weakref.ref(cells.darkness))
        return cells

    def counted(name: str) -> None:
        made = getattr(trace_ink_module, name)

        def told(*args: Any) -> Any:
            alive[name] = sum(each() is not None for each in seen)
            # a head is put down on the sheet, as on a line that is mended
            if name == "as_contours":
                view_of(args[0].sheet, None, WIDTH_MM)
            return made(*args)

        monkeypatch.setattr(trace_ink_module, name, told)

    monkeypatch.setattr(photocell, "behind_aperture", kept)
    for name in ("as_contours", "strokes_off_ink"):
        counted(name)
    lines = trace_ink(drawing).lines
    assert len(lines) > 1 and len(seen) > 1
    assert alive == {"as_contours": 0, "strokes_off_ink": 0}
