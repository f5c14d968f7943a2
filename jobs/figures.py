"""Figures: what a job found out, by names that carry the unit (`rms_mm`, `duration_s`).

A value is a number, a text, a place, a list, or again such figures; None is left out when they are shown.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Figures = Mapping[str, Any]

MOST_PLACES = 30  # of one kind, the worst first, that a picture marks and a table lists; the figures have all
FEW_PLACES = 10  # the same of a kind of which a plan with two pens has many
