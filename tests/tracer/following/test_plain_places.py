"""Plain places: a kernel tells their order, and what the head sees there is made out for those asked for."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following import plain_places
from morfax.tracer.following.plain_places import places_of, plainest_first, view_of
from tests.tracer.inked import arc, inked, polyline

WAVE_MM = np.linspace(0.0, 24.0, 400)
LINES = {
    "circle": [arc((12, 12), 4.0)],
    "wave": [np.column_stack([WAVE_MM + 4, 10 + 2 * np.sin(WAVE_MM / 2)])],
    "corners and a crossing": [polyline((4, 4), (24, 4), (24, 18), (10, 2))],
}


@pytest.mark.parametrize("name", LINES)
def test_the_kernel_puts_places_in_the_order_of_what_is_felt_there(name: str) -> None:
    sheet = Sheet.of(inked(*LINES[name], seed=5))
    stroke = sheet.longest()
    view = view_of(sheet, None, stroke.width_mm)
    places = places_of(stroke, None)
    felt = [plain_places._stance_at(view, place) for place in places]
    clean = [each for each in felt if each is not None]
    clean.sort(key=lambda each: each[1:], reverse=True)
    found = list(plainest_first(view, places))
    assert len(clean) > 10
    assert [stance.place_mm.tolist() for stance in found] == [
        stance.place_mm.tolist() for stance, _, _ in clean
    ]


def test_a_place_is_made_out_only_when_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    sheet = Sheet.of(inked(*LINES["circle"], seed=5))
    stroke = sheet.longest()
    view, made_out = view_of(sheet, None, stroke.width_mm), list[Array]()
    whole = plain_places._stance_at
    monkeypatch.setattr(
        plain_places,
        "_stance_at",
        lambda view, place: made_out.append(place) or whole(view, place),
    )
    assert next(plainest_first(view, places_of(stroke, None))) is not None
    assert len(made_out) == 1
