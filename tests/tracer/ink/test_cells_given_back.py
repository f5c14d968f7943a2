"""What a sheet is in while it is looked at is given back: what cells saw, masks, what distances are in."""

from __future__ import annotations

import tracemalloc
import weakref
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from morfax.tracer.drawing.narrow import Strips, narrow_gaps
from morfax.tracer.drawing.shapes_among_lines import has_lines
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.program import trace_ink as trace_ink_module
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.sensing import photocell
from tests.tracer.ink.test_all_ink import BAR, SPUR, SQUARE
from tests.tracer.inked import WIDTH_MM, arc, inked, polyline


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


def test_memory_is_given_back_before_the_cells_see_and_before_what_is_left_is_looked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of a page with solid areas 50 and 35 MB were free by then, and still held."""
    done = list[str]()

    def noted(name: str) -> None:
        made = getattr(trace_ink_module, name)

        def told(*args: Any, **named: Any) -> Any:
            done.append(name)
            return made(*args, **named)

        monkeypatch.setattr(trace_ink_module, name, told)

    for name in ("ink_left", "_letters", "struck_off", "put_down_again", "give_back"):
        noted(name)
    trace_ink(inked(SQUARE, BAR, SPUR))
    given = [k for k, name in enumerate(done) if name == "give_back"]
    assert any(done.index("ink_left") < k < done.index("_letters") for k in given)
    assert any(done.index("struck_off") < k < done.index("put_down_again") for k in given)


def test_newest_strokes_are_given_back_when_they_are_in_a_file(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    given = list[int]()
    monkeypatch.setattr(trace_ink_module, "give_back", lambda: given.append(1))
    ways = [np.zeros((300_000, 2))] * 4
    kept = trace_ink_module._kept(
        trace_ink_module.InkStroke(way, 1.0, False, WIDTH_MM) for way in ways
    )
    assert [len(stroke.way_mm) for stroke in kept] == [300_000] * 4
    assert len(given) == 2


def bytes_a_pixel(done: Callable[[], Any], pixels: int) -> float:
    """The most memory that something takes while it is done, bytes a pixel of the sheet."""
    tracemalloc.start()
    try:
        done()
        return tracemalloc.get_traced_memory()[1] / pixels
    finally:
        tracemalloc.stop()


def test_narrow_gaps_and_the_widths_of_lines_take_little_beside_the_sheet() -> None:
    """Labels and distances of the whole sheet took 8 and 9 bytes a pixel, and the ridge 14."""
    ways = [arc((90.0, 90.0), radius_mm) for radius_mm in (80.0, 80.67)]
    drawing = inked(*ways, polyline((3.0, 3.0), (176.0, 177.0)), dpi=300.0)
    pixels = drawing.darkness.size
    assert pixels > 3e6
    assert bytes_a_pixel(lambda: Strips.of(drawing), pixels) < 6
    assert len(drawing.narrow_strips.rows)
    assert bytes_a_pixel(lambda: narrow_gaps(drawing, [(ways[0], WIDTH_MM)]), pixels) < 6
    assert bytes_a_pixel(lambda: has_lines(drawing), pixels) < 10


def test_masks_that_last_take_a_bit_for_each_pixel() -> None:
    left = ink_left(inked(SQUARE, BAR, SPUR).sheet)
    assert left.ink.any() and left.ink.shape == left.solid.shape
    for packed, mask in ((left.packed_ink, left.ink), (left.packed_solid, left.solid)):
        assert packed.bits.nbytes <= mask.size / 8 + len(mask)
        assert packed.shape == mask.shape and packed.any() == mask.any()
        rows, columns = np.indices(mask.shape).reshape(2, -1)
        assert np.array_equal(packed.at(rows, columns), mask.ravel() > 0)
