"""Small loops: a closed line of few widths is held against its ink, and laid by the compass where it fails.

Between the bends of a small hole or slot the head finds no clean line that is as long as its legs. Its way
may cut such a loop short, or the head can nowhere be put down. The pen's ink along the way tells; the loop is
then the way that explains the ink (see `tangles.compass`), and the head runs along that from memory. A loop
whose sides run together, however long and of whatever shape, is laid within the rim of its ink (see
`rim_loops`).

Signals: the sheet and a small closed way in; the way as the head ran along it, and who led, out.

Source: our own. Questions: only a loop that is all of its patch of ink is looked at; one that other lines
join is a tangle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.long_array import one_in
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import broad_mm, length_mm
from morfax.motion.usual import THINNED
from morfax.tracer.drawing.inner_rings import LEAST_PX
from morfax.tracer.drawing.lettering import lettering
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.effort import MANY
from morfax.tracer.following.line import Line
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.leaders import REDRAWN, Led
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.limits import ABOUT_WIDTHS, WIDER
from morfax.tracer.program.laid.line_parts import closed_anew
from morfax.tracer.program.laid.loop_ink import ink_of, is_drawn, is_single, leaves_none
from morfax.tracer.program.laid.rim_loops import (
    BROAD,
    core_within,
    felt_pen_mm,
    narrow_outline,
)
from morfax.tracer.program.lines.selection import lines_of
from morfax.tracer.program.lines.small_rings import paper_within_px, pen_mm
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.compass import Core, explained, filled_misfit, with_misfit
from morfax.tracer.tangles.seen_ink import GAIN, LIKE, SeenInk

SMALL_WIDTHS = 16.0  # a longer loop has sides as long as a leg, ...
# ... but one whose sides are no further apart than this, in the mean, has ends too narrow for the head; that
# is looked for on loops up to this long; chosen
NARROW_WIDTHS, LONG_WIDTHS = 3.0, 60.0
ONCE = 1.5  # of the length of its ink: a way that is longer goes round twice
# two lines whose ink runs together: times as broad as a line at the most, and how long at the least; so many
# are tried
BROADEST, SHORT_WIDTHS = 2.7, 2.0
NO_BROADER = 0.9  # times as broad as a line: in the mean a seam may make up for it
# for each width of the length: so much more the same shape leaves if it is filled, and more than it leaves
SEAM = 0.002
RIM_PLACES = 40  # for each width of the way round, of a loop of any shape


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
        return self._letters if len(self._letters) > MANY else set()

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
        return closed_anew(line, loop.way_mm, loop.led, loop.width_mm, loop.length_mm)

    def of_way(self, way: Array, width_mm: float) -> Loop | None:
        """The loop whose way (n, 2) mm fails its own ink, as the compass lays it; None if it does not fail,
        or no core explains its ink.
        """
        patch = self.sheet.patch_at(way[0])
        if not self._may_be(patch, width_mm):
            return self._narrow(patch, way)
        ink, thinned = ink_of(self.sheet, patch, width_mm), one_in(way, THINNED)
        loop = self._laid(ink, ink.misfit_along(thinned))
        is_narrow = broad_mm(thinned) < (BROAD[1] - 1) * width_mm
        return self._within_rim(patch, way) if loop is None and is_narrow else loop

    def of_patch(self, patch: int, width_mm: float, way: Array | None = None) -> Loop | None:
        """The loop that a patch of ink is, along which the head has found no closed way, but an open one."""
        if self._may_be(patch, width_mm):
            loop = self._laid(ink_of(self.sheet, patch, width_mm), math.inf)
            return loop or self._within_rim(patch, way)
        return self._narrow(patch, way)

    def _narrow(self, patch: int, way: Array | None) -> Loop | None:
        """The loop within which hardly any paper is seen, if it explains more than the head's way."""
        may_be = (
            self._is_broad(patch, NO_BROADER) and paper_within_px(self.sheet, patch) < LEAST_PX
        )
        loop = self._with_seam(patch, way) if may_be else None
        return loop or self._within_rim(patch, way)

    @cached_property
    def slots(self) -> dict[int, Loop]:
        """The loops that patches are whose sides run together, by the patch; the largest are looked at."""
        largest_first = np.argsort(-self.sheet.patches.areas, kind="stable").tolist()
        broad = [patch for patch in largest_first if self._is_broad(patch)][:MANY]
        loops = {patch: self.slot(patch) for patch in broad}
        return {patch: loop for patch, loop in loops.items() if loop is not None}

    def slot(self, patch: int) -> Loop | None:
        """The loop that a patch is whose sides run together; None for another."""
        loop = self._with_seam(patch) if self._is_broad(patch) else None
        is_broad = self.sheet.widths_mm[patch] > WIDER * self.pen_mm
        return self._within_rim(patch) if loop is None and is_broad else loop

    @cached_property
    def _letters(self) -> set[int]:
        """The patches that are likely letters."""
        return lettering(self.sheet)

    @cached_property
    def _shows_seams(self) -> bool:
        """Whether the scan shows seams, and a line whose pen is known; large pixels make seams of letters."""
        drawing = self.sheet.drawing
        is_clear = drawing.noise.softness_px > 0 and drawing.finer == 1
        return is_clear and not drawing.edges_mm and len(lines_of(self.sheet)) > 0

    def _is_broad(self, patch: int, least: float = WIDER) -> bool:
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
        ink = ink_of(self.sheet, patch, self.pen_mm)
        own = math.inf if way is None else ink.misfit_along(one_in(way, THINNED))
        return self._run_if_two_lines(ink, explained(ink), own)

    def _within_rim(self, patch: int, way: Array | None = None) -> Loop | None:
        """The loop of any shape that a patch is, by the rim of its ink, where the head's way fails that."""
        if not self._shows_seams or patch in self._letters:
            return None
        outline = narrow_outline(self.sheet, patch, self.pen_mm)
        if outline is None:
            return None
        widths = length_mm(outline) / self.pen_mm
        ink = ink_of(self.sheet, patch, self.pen_mm, round(RIM_PLACES * widths))
        core = core_within(self._view(patch, self.pen_mm), outline, self._felt_pen_mm)
        if core is None or not is_single(core) or not leaves_none(ink, core):
            return None
        own = math.inf
        if way is not None:
            thinned = one_in(way, THINNED)
            # longer by a width: a piece of the line is run twice
            goes_back = length_mm(thinned) > core.length_mm + self.pen_mm
            own = math.inf if goes_back else ink.misfit_along(thinned)
        return self._run_if_two_lines(ink, with_misfit(ink, core), own)

    def _run_if_two_lines(self, ink: SeenInk, core: Core | None, own: float) -> Loop | None:
        """The run along a core, if its ink shows the seam between two lines, and it explains more than the
        head's own way.
        """
        if core is None:
            return None
        widths = core.length_mm / ink.width_mm
        least = max(SEAM * widths, abs(core.misfit))
        has_seam = filled_misfit(ink, core) - core.misfit > least
        is_better = core.misfit < min(own - GAIN * widths, LIKE * widths)
        return self._run(core) if has_seam and is_better and is_drawn(ink, core) else None

    def _view(self, patch: int, width_mm: float) -> View:
        """What is about a patch through cells for a line of a width: of a sheet no more than that is made."""
        near = self.sheet.about(patch, ABOUT_WIDTHS * width_mm)
        return view_of(near, self.settings.aperture_mm, width_mm)

    @cached_property
    def _felt_pen_mm(self) -> float:
        """The pen's width as cells for it feel it."""
        return felt_pen_mm(self.sheet, self.settings.aperture_mm, self.pen_mm)

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

    def _laid(self, ink: SeenInk, own: float) -> Loop | None:
        """The loop that explains some ink, if it leaves less unexplained than the head's own closed way."""
        core = explained(ink) if len(ink.places_mm) else None
        if core is None:
            return None
        widths = core.length_mm / ink.width_mm
        is_better = core.misfit < min(own - GAIN * widths, LIKE * widths)
        is_line = math.isfinite(own) or is_drawn(ink, core)
        return self._run(core) if is_better and is_line else None

    def _run(self, core: Core) -> Loop:
        """The head's run along a core's way from memory."""
        stretches = core.stretches()
        heading = math.atan2(*(stretches[0][1] - stretches[0][0])[::-1])
        begin, width_mm = stretches[0][0], 2 * core.half_mm
        view = self._view(self.sheet.patch_at(begin), width_mm)
        stance = Stance(begin, heading, view)
        carriage = Carriage(stance, self.settings, MOTION_RATE_HZ)
        carriage.run(stretches, leader=REDRAWN)
        return Loop(carriage.positions_mm, carriage.led, width_mm)
