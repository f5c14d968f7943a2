"""A cleared sheet: without the lines that are printed on its paper, and without the border of a scan.

Signals: darkness of a sheet in; the same without both out, and what the operator should know.

Source: our own.
"""

from __future__ import annotations

from morfax.tracer.drawing import ruling
from morfax.tracer.drawing.border import border_note, without_border
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.deepening import LEAST
from morfax.tracer.drawing.tiles import Kept


def cleared(
    darkness: Kept, pitch_mm: float, printed: ruling.PaperKind, pale_is_ink: bool
) -> tuple[Kept, float, tuple[str, ...]]:
    """The darkness without both, how dark what is drawn was before it was made 1, and notes of both."""
    found = ruling.left_out(darkness, pitch_mm, printed)
    edges = without_border(found.darkness, LEAST if pale_is_ink else INK)
    notes = tuple(filter(None, (found.note, border_note(edges) if edges else None)))
    return found.darkness, found.ink, notes
