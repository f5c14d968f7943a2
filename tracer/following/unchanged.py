"""Unchanged: what the operator's rubber and pen leave as it was for a head that stands elsewhere.

Signals: a drawing whose ink was changed, and a stance on the drawing before that, in; whether the head is put
down there as it was, out.

The width and the darkness with which the head is put down are measured on all the ink of its line. Ink that
is changed at one end of a line is not to move the head at the other: where the change is far, the head is put
down by the ink as it was before, and runs the same way up to the change (see `knots`).

Source: our own; the patent's operator rubs out and draws while the head stands on the line.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.knots import changes_mm
from morfax.tracer.head.stance import Stance
from morfax.tracer.sensing.photocell import Cells

FAR_MM = 12.0  # to changed ink: as far as a head sees that feels for legs and tangles; by trial


def changed_of(drawing: Drawing) -> Array | None:
    """Where the operator has changed the ink of a drawing: boxes (n, 4) mm; None if nowhere."""
    if drawing.bare is None:
        return None
    changed_mm = changes_mm(drawing.bare, drawing)
    return None if changed_mm is None or not len(changed_mm) else changed_mm


def is_far(stance: Stance, changed_mm: Array) -> bool:
    """Whether all changed ink is far from a stance."""
    place = stance.place_mm
    beyond = np.maximum(changed_mm[:, :2] - place, place - changed_mm[:, 2:])
    return bool(np.hypot(*np.maximum(beyond, 0.0).T).min() > FAR_MM)


def on_ink(stance: Stance, now: Cells) -> Stance:
    """The same stance on other ink, as cells see it now."""
    cells = stance.view.cells._replace(darkness=now.darkness, beyond=now.beyond)
    return replace(stance, view=replace(stance.view, cells=cells))
