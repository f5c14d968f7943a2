"""Marks for ink that was left out: solid areas and letters, each in a colour of its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from morfax.reports import plate

if TYPE_CHECKING:
    from morfax.tracer.ink.left_out import Area

COLOURS = {"solid area": "#c77700", "letter": "#8a5cc7"}
ALPHA = 0.4  # the ink shines through


def marks(areas: Sequence[Area]) -> list[plate.TintedArea]:
    """Marks for solid areas and letters that were left out, in colours of their own."""
    named = set[str]()
    drawn = list[plate.TintedArea]()
    for area in (area for area in areas if area.what in COLOURS):
        left, bottom, right, top = area.box_mm
        box = (left, bottom), (right, bottom), (right, top), (left, top)
        corners = np.array(area.outline_mm or box)
        label = "" if area.what in named else f"{area.what}, left out"
        named.add(area.what)
        drawn.append(plate.TintedArea(corners, COLOURS[area.what], ALPHA, label=label))
    return drawn
