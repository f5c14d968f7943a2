"""Small loops: a closed line of few widths is held against its ink, and laid by the compass where it fails.

Between the bends of a small hole or slot the head finds no clean line that is as long as its legs. Its way
may cut such a loop short, or the head can nowhere be put down. The pen's ink along the way tells; the loop is
then the way that explains the ink (see `tangles.compass`), and the head runs along that from memory.

Signals: the sheet and a small closed way in; the way as the head ran along it, and who led, out.

Source: our own. Questions: only a loop that is all of its patch of ink is looked at; one that other lines
join is a tangle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.long_array import one_in
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import evenly, length_mm
from morfax.tracer.drawing.inner_rings import LEAST_PX
from morfax.tracer.drawing.lettering import lettering
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.followed import THINNED
from morfax.tracer.following.line import Line
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.leaders import REDRAWN, Led
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.program.own_ink import MOST_SPECKS, OVER
from morfax.tracer.program.selection import lines_of
from morfax.tracer.program.small_rings import MAYBE_BROAD, paper_within_px, pen_mm
from morfax.tracer.tangles.compass import Core, explained, filled_misfit
from morfax.tracer.tangles.seen_ink import GAIN, LIKE, SeenInk

SMALL_WIDTHS = 16.0  # a longer loop has sides as long as a leg, ...
# ... but one whose sides are no further apart than this, in the mean, has ends too narrow for the head; that
# is looked for on loops up to this long; chosen
NARROW_WIDTHS, LONG_WIDTHS = 3.0, 60.0
ONCE = 1.5  # of the length of its ink: a way that is longer goes round twice
# two lines whose ink runs together: times as broad as a line at the most, and how long at the least; so many
# are tried
BROADEST, SHORT_WIDTHS, MOST_BROAD = 2.7, 2.0, 100
NO_BROADER = 0.9  # times as broad as a line: in the mean a seam may make up for it
# for each width of the length: so much more the same shape leaves if it is filled, and more than it leaves
SEAM = 0.002
# widths between places of a way, and about each: there a pen draws no more on paper than that of a long line
# (see `own_ink`); of 22 right slots 21 leave 0.01 at most and one 0.08, lines that are open at one end 0.1
STATION, ABOUT_STATION = 0.25, 0.75
ABOUT_SOFT = 3.0  # softnesses: so far beyond the ink its edge is seen
MOST_PLACES = 900  # enough to place a circle within 5 um, and each end of a slot within 10
TEXT = 100  # letters on a sheet: on one with more nobody looks for small holes among them


class Loop(NamedTuple):
    """A loop as the head ran along it: its way (n, 2) mm at the motion rate, who led, the pen's width, mm."""

    way_mm: Array
    led: Led
    width_mm: float

    @property
    def length_mm(self) -> float:
        """The length of the way."""
        return length_mm(self.way_mm)

    def line(self, number: int) -> Line:
        """The loop as a line of the drawing with a number."""
        long_mm = self.length_mm
        return Line(self.way_mm, "closed", self.width_mm, long_mm, number=number, led=self.led)


@dataclass(frozen=True)
class SmallLoops:
    """The small loops of a sheet, and the head that runs along them."""

    sheet: Sheet
    settings: Settings

    @cached_property
    def passed_by(self) -> set[int]:
        """The patches that are no loops: on a page of text the letters."""
        return self._letters if len(self._letters) > TEXT else set()

    @cached_property
    def pen_mm(self) -> float:
        """The width of the lines along half of the sheet's ink."""
        return pen_mm(self.sheet)

    def mended(self, line: Line) -> Line:
        """A line as it is; a small one that should close and fails its own ink as the compass lays it."""
        is_marked = line.is_lead or line.reference_mm is not None or line.marks
        if is_marked or line.is_dot or line.on_edge:
            return line
        patch = self.sheet.patch_at(line.xy_mm[0])
        goes_once = line.length_mm < ONCE * float(self.sheet.lengths_mm[patch])
        if line.ending == "closed" and goes_once:
            loop = self.of_way(line.xy_mm, line.width_mm)
        else:
            loop = self.of_patch(patch, line.width_mm, line.xy_mm)
        if loop is None:
            return line
        return replace(
            line,
            xy_mm=loop.way_mm,
            ending="closed",
            width_mm=loop.width_mm,
            length_mm=loop.length_mm,
            fault=None,
            loop_from=None,
            junctions_mm=(),
            breaks=(),
            led=loop.led,
            roughness_mm=None,
        )

    def of_way(self, way: Array, width_mm: float) -> Loop | None:
        """The loop whose way (n, 2) mm fails its own ink, as the compass lays it; None if it does not fail,
        or no core explains its ink.
        """
        patch = self.sheet.patch_at(way[0])
        if not self._may_be(patch, width_mm):
            return self._narrow(patch, way)
        ink = self._ink(patch, width_mm)
        return self._laid(ink, ink.misfit_along(one_in(way, THINNED)))

    def of_patch(self, patch: int, width_mm: float, way: Array | None = None) -> Loop | None:
        """The loop that a patch of ink is, along which the head has found no closed way, but an open one."""
        if self._may_be(patch, width_mm):
            return self._laid(self._ink(patch, width_mm), math.inf)
        return self._narrow(patch, way)

    def _narrow(self, patch: int, way: Array | None) -> Loop | None:
        """The loop within which hardly any paper is seen, if it explains more than the head's way."""
        may_be = (
            self._is_broad(patch, NO_BROADER) and paper_within_px(self.sheet, patch) < LEAST_PX
        )
        return self._with_seam(patch, way) if may_be else None

    @cached_property
    def slots(self) -> dict[int, Loop]:
        """The loops that patches are whose sides run together, by the patch; the largest are looked at."""
        largest_first = np.argsort(-self.sheet.patches.areas, kind="stable").tolist()
        broad = [patch for patch in largest_first if self._is_broad(patch)][:MOST_BROAD]
        loops = {patch: self.slot(patch) for patch in broad}
        return {patch: loop for patch, loop in loops.items() if loop is not None}

    def slot(self, patch: int) -> Loop | None:
        """The loop that a patch is whose sides run together; None for another."""
        return self._with_seam(patch) if self._is_broad(patch) else None

    @cached_property
    def _letters(self) -> set[int]:
        """The patches that are likely letters."""
        return lettering(self.sheet)

    @cached_property
    def _shows_seams(self) -> bool:
        """Whether the scan shows seams, and a line whose pen is known; large pixels make seams of letters."""
        drawing = self.sheet.drawing
        is_clear = drawing.noise.softness_px > 0 and drawing.finer == 1
        return is_clear and len(lines_of(self.sheet)) > 0

    def _is_broad(self, patch: int, least: float = MAYBE_BROAD) -> bool:
        """Whether a patch is as broad as so many lines to two; no longer than a narrow loop, no letter."""
        if not self._shows_seams:
            return False
        long_mm, width_mm = self.sheet.lengths_mm[patch], self.sheet.widths_mm[patch]
        is_broad = least < width_mm / self.pen_mm < BROADEST
        is_between = SHORT_WIDTHS * self.pen_mm < long_mm < LONG_WIDTHS * self.pen_mm
        return bool(is_broad and is_between) and patch not in self._letters

    def _with_seam(self, patch: int, way: Array | None = None) -> Loop | None:
        """The loop that a broad patch is, if its ink shows the seam between two lines, and it explains more
        than the head's way.
        """
        ink = self._ink(patch, self.pen_mm)
        core = explained(ink)
        if core is None:
            return None
        widths = core.length_mm / ink.width_mm
        least = max(SEAM * widths, abs(core.misfit))
        own = math.inf if way is None else ink.misfit_along(one_in(way, THINNED))
        has_seam = filled_misfit(ink, core) - core.misfit > least
        is_better = core.misfit < min(own - GAIN * widths, LIKE * widths)
        return self._run(core) if has_seam and is_better and _is_drawn(ink, core) else None

    def _may_be(self, patch: int, width_mm: float) -> bool:
        """Whether a patch may be a short or a narrow loop: it has paper within, and the pen is known."""
        long_mm, pitch_mm = float(self.sheet.lengths_mm[patch]), self.sheet.drawing.pitch_mm
        if long_mm > LONG_WIDTHS * width_mm or patch in self.passed_by:
            return False
        within_px = paper_within_px(self.sheet, patch)
        within_mm2 = within_px * pitch_mm**2 + 0.5 * long_mm * width_mm
        is_narrow = 2 * within_mm2 < NARROW_WIDTHS * width_mm * long_mm
        is_small = long_mm < SMALL_WIDTHS * width_mm or is_narrow
        is_loop = is_small and within_px >= LEAST_PX
        return is_loop and self.sheet.drawing.noise.softness_px > 0

    def _ink(self, patch: int, width_mm: float) -> SeenInk:
        """The ink of a patch, and the paper about it and within, as far as that is no other patch's."""
        drawing, patches = self.sheet.drawing, self.sheet.patches
        rows, columns = drawing.darkness.shape
        about = 2 + math.ceil(ABOUT_SOFT * drawing.noise.softness_px)
        top, bottom, left, right = patches.boxes[patch].tolist()
        top, bottom = max(top - about, 0), min(bottom + about, rows)
        left, right = max(left - about, 0), min(right + about, columns)
        # what is nearer to this ink than so far, and to no other
        is_own: NDArray[np.bool_] = np.arange(patches.count) == patch
        reach = np.ones((2 * about + 1,) * 2, np.uint8)
        own, others = (
            cv2.dilate(patches.painted(chosen, top, bottom, left, right), reach)
            for chosen in (is_own, ~is_own)
        )
        i, j = np.nonzero((own > 0) & (others == 0))
        every = 1 + len(i) // MOST_PLACES
        i, j = i[::every] + top, j[::every] + left
        known_mm = np.full(len(i), math.inf)  # nothing else is drawn there
        return SeenInk.of(drawing, i, j, known_mm, width_mm, every)

    def _laid(self, ink: SeenInk, own: float) -> Loop | None:
        """The loop that explains some ink, if it leaves less unexplained than the head's own closed way."""
        core = explained(ink) if len(ink.places_mm) else None
        if core is None:
            return None
        widths = core.length_mm / ink.width_mm
        is_better = core.misfit < min(own - GAIN * widths, LIKE * widths)
        is_line = math.isfinite(own) or _is_drawn(ink, core)
        return self._run(core) if is_better and is_line else None

    def _run(self, core: Core) -> Loop:
        """The head's run along a core's way from memory."""
        stretches = core.stretches()
        heading = math.atan2(*(stretches[0][1] - stretches[0][0])[::-1])
        view = view_of(self.sheet, self.settings.aperture_mm, 2 * core.half_mm)
        stance = Stance(stretches[0][0], heading, view)
        carriage = Carriage(stance, self.settings, MOTION_RATE_HZ)
        carriage.run(stretches, leader=REDRAWN)
        return Loop(carriage.positions_mm, carriage.led, 2 * core.half_mm)


def _is_drawn(ink: SeenInk, core: Core) -> bool:
    """Whether there is ink wherever a pen along a core's way would leave it, but for specks of paper: a line
    that goes round but for its last side is no loop.
    """
    way = np.vstack(core.stretches())
    drawn = ink.drawn_along(way, core.half_mm)
    paper = np.maximum(drawn - ink.darkness, 0.0) ** 2 * ink.area_mm2 / ink.width_mm**2
    stations = evenly(way, STATION * ink.width_mm)
    away_mm = np.hypot(*(stations[:, None] - ink.places_mm[None]).transpose(2, 0, 1))
    most = float(((away_mm < ABOUT_STATION * ink.width_mm) @ paper).max())
    return most < max(OVER, MOST_SPECKS * ink.area_mm2 / ink.width_mm**2)
