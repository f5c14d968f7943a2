"""What closed lines do not explain: ink of theirs along which no line runs, and ways without ink.

Signals: the sheet and the lines that were followed in; out the places at which the head's own pen would not
have drawn what is there.

    ───╮  ╭───     a tip that the head passed by: its ink lies more than a width and a half beside every way
       │──│
       ╰──╯        a way over bare paper, longer than a gap that the head may cross

A line that comes round may still be another than the one that was drawn, where tips and bays are narrower
than two lines.

Source: our own; the operator of patent ES 361967 looks at the drawing and at the part. Questions: whether ink
beside a line belongs to it, or is another line that touches it, the pen cannot know.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import lengths_mm, nearest_mm
from morfax.tracer.drawing.components import joined
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.photocell import darkness_along, without_aperture

BEYOND_WIDTHS = 1.5  # beyond the edge of a line ink is no longer that line's
BARE = 0.25  # darkness: paler places are paper


class Unexplained(NamedTuple):
    """A place that the ways do not explain: where, how much (mm), and whether it is ink.

    Of ink how far it reaches beside the ways, of a way over bare paper its length.
    """

    place_mm: tuple[float, float]
    length_mm: float
    is_ink: bool


def unexplained(setup: Setup, lines: Sequence[Line]) -> tuple[Unexplained, ...]:
    """What the closed ones of some lines leave unexplained, the longest first.

    Of a drawn program nothing: its guide lines, ticks and dots are beside the way, and so meant.
    """
    closed = [line for line in lines if line.ending == "closed"]
    if not closed or setup.operator.reads_marks(lines):
        return ()
    sheet, gap_mm = setup.sheet, setup.settings.gap_mm
    found = [*_ink_beside(sheet, closed, lines), *_bare_ways(sheet, closed, gap_mm)]
    return tuple(sorted(found, key=lambda place: -place.length_mm))


def _ink_beside(
    sheet: Sheet, closed: Sequence[Line], lines: Sequence[Line]
) -> Iterator[Unexplained]:
    """Ink of the closed lines' patches that lies beside all ways."""
    patches = sheet.patches
    # 1. the patches on which closed lines run
    own = np.zeros(patches.count, bool)
    own[[sheet.patch_at(line.loop_mm[0]) for line in closed]] = True
    runs = np.flatnonzero(own[patches.patch] & ~sheet.are_solid[patches.patch])
    if not len(runs):
        return
    # 2. how far both ends of their runs are from the ways
    ways = np.vstack([line.places_mm for line in lines])
    ends = np.vstack([sheet.run_begins_mm(runs), sheet.run_ends_mm(runs)])
    away_mm = nearest_mm(ends, ways).reshape(2, -1)
    width_mm = np.array([line.width_mm for line in closed]).max()
    widths_mm = np.maximum(sheet.widths_mm[patches.patch[runs]], width_mm)
    far = away_mm.max(axis=0) > (0.5 + BEYOND_WIDTHS) * widths_mm
    # 3. those that lie together, where each reaches furthest
    runs, away_mm, ends = runs[far], away_mm[:, far], ends.reshape(2, -1, 2)[:, far]
    group, count = joined(patches.row[runs], patches.begin[runs], patches.end[runs], True)
    for number in range(count):
        mine = np.flatnonzero(group == number)
        furthest = np.unravel_index(np.argmax(away_mm[:, mine]), (2, len(mine)))
        x, y = ends[:, mine][furthest]
        yield Unexplained((float(x), float(y)), float(away_mm[:, mine].max()), True)


def _bare_ways(sheet: Sheet, closed: Sequence[Line], gap_mm: float) -> Iterator[Unexplained]:
    """Stretches of closed lines over bare paper."""
    for line in closed:
        places = line.loop_mm
        come_mm, bare = lengths_mm(places), _darkness(sheet, places) < BARE
        edges = np.flatnonzero(np.diff(np.r_[False, bare, False])).reshape(-1, 2)
        for begin, end in edges:
            long_mm = float(come_mm[end - 1] - come_mm[begin])
            if long_mm > gap_mm + BEYOND_WIDTHS * line.width_mm:
                x, y = places[(begin + end) // 2]
                yield Unexplained((float(x), float(y)), long_mm, False)


def _darkness(sheet: Sheet, places_mm: Array) -> Array:
    """Darkness of the drawing at places (n, 2) mm, under a cell as small as a point."""
    cells = without_aperture(sheet.drawing, BARE)
    return np.asarray(darkness_along(cells, places_mm))
