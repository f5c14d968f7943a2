"""Figures: what a job found out, by names that carry the unit (`rms_mm`, `duration_s`).

A value is a number, a text, a place, a list, or again such figures; None is left out when they are shown.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Figures = Mapping[str, Any]
