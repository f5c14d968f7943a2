"""The enlarger: a drawing too fine for the head is followed at a larger scale, and the path is reduced again,
as by a pantograph between the head and the screws.

Signals: a stance on the drawing in, the same on the enlarged drawing out; what the head did there in, the
same on the drawing out.

The head works in mm: it feels a leg of fixed length, and looks a fixed distance ahead. A detail finer than
that stays too fine at a higher resolution, but not at a larger scale. The head goes as fast on the enlarged
drawing, so the path takes longer by the same factor.

Source: our own; photographic enlargement and pantographs were a drawing office's means for this.
"""

from __future__ import annotations

from dataclasses import replace

from morfax.motion.long_array import LongArray, blocks
from morfax.tracer.following.followed import Followed
from morfax.tracer.head.stance import Stance
from morfax.tracer.sensing.view import View


def enlarged(stance: Stance, times: float) -> Stance:
    """The same stance on the enlarged drawing."""
    return replace(stance, place_mm=stance.place_mm * times, view=_scaled(stance.view, times))


def reduced(run: Followed) -> Followed:
    """What the head did on an enlarged drawing, in the drawing's own mm."""
    by = run.view.enlarged
    if by == 1:
        return run
    positions = LongArray()
    for block in blocks(run.positions_mm):
        positions.add(block / by)
    return replace(
        run,
        positions_mm=positions.whole(),
        travel_mm=run.travel_mm / by,
        view=_scaled(run.view, 1 / by),
        junctions_mm=tuple((x / by, y / by) for x, y in run.junctions_mm),
    )


def _scaled(view: View, times: float) -> View:
    """The view of a drawing at another scale. An edge has no width of its own that would grow."""
    if view.on_edge:
        cells = view.cells._replace(pitch_mm=view.pitch_mm * times)
        return replace(view, cells=cells, enlarged=view.enlarged * times)
    usual_mm = None if view.usual_mm is None else view.usual_mm * times
    return replace(
        view,
        cells=view.cells._replace(pitch_mm=view.pitch_mm * times),
        width_mm=view.width_mm * times,
        usual_mm=usual_mm,
        enlarged=view.enlarged * times,
    )
