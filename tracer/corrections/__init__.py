"""What the operator has put right on a drawing: ink rubbed out or drawn, turns, stops, start; and its file.

The room asks the ground floor only. The drawing takes the ink from it, the lines take turns and stops, and
the jobs read and write its file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

SUFFIX = ".morfax.toml"  # in the place of the drawing's own


def beside(drawing: Path) -> Path:
    """The name of a drawing's file of corrections; most drawings have none, and nothing else is loaded."""
    return drawing.with_name(f"{drawing.stem}{SUFFIX}")
