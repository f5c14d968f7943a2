"""TODO."""

from __future__ import annotations

from typing import Literal

Direction = Literal["cw", "ccw", "left", "right"]
