"""How a scan is read: what of it counts as the drawing's ink.

Signals: none; what the operator asked for, and what was seen of a scan before it is read once more.

Source: our own.
"""

from __future__ import annotations

from typing import NamedTuple

from morfax.tracer.drawing.polarity import Polarity
from morfax.tracer.drawing.ruling import PaperKind


class Reading(NamedTuple):
    """How a scan is read: the edges of filled shapes alone; printed lines of what kind of paper are left out;
    or filled shapes as ink, which is as dark as the lines that end at them; or pale lines as ink; lines of a
    polarity if it is known; bold ones, so that strokes are up to twice as broad as on other sheets; and the
    grey levels may be those of one ink alone, told by its colour.
    """

    edge: bool = False
    printed: PaperKind = "auto"
    shapes_are_ink: bool = False
    pale_is_ink: bool = False
    polarity: Polarity | None = None
    bold: bool = False
    of_colour: bool = False


AS_LINES = Reading()
