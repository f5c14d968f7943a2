"""Limits of the tracer that several rooms share: one idea, one number. Those of one room stand there.

Widths are those of the line, or of the pen that drew it. Turns stand in `motion.plane`, the least length of a
stroke in `drawing.contrast`, the fewest stations in `sensing`. Chosen by trial, where nothing else is said.
"""

from __future__ import annotations

import math

from morfax.motion.plane import CORNER_RAD

AHEAD_RAD = 2 * CORNER_RAD  # what lies within this of a heading lies ahead; it goes straight on
TIP_RAD = 6 * CORNER_RAD  # a corner that turns by more is a tip
BACK_RAD = math.radians(150)  # what turns by more goes back
NEARLY_PARALLEL = 0.02  # sine of the angle between two legs that do not meet

PAPER = 0.25  # of the ink's darkness: paler places are paper
AS_WIDE = 0.15  # of a width: what differs by more is no line of the same pen ...
WIDER = 1 + AS_WIDE  # ... or two lines that share their ink
# square widths: a round of a width, as the two round ends of a line together
ROUND = math.pi / 4
# of a drawn line: what is told in widths is told in these where the line is thinner
USUAL_WIDTH_MM = 0.5
NEAR = 0.3  # widths from a line's middle: so near a place is on that line
OWN_WIDTHS = 0.7  # from a line's middle: ink and places that are nearer are that line's
CLEAR_WIDTHS = 1.5  # from a place where lines meet: further on, the ink is that of one line
ABOUT_WIDTHS = 3.0  # about a place: so far what belongs to it is looked for
LONGER_WIDTHS = 4.0  # what goes on beside a line for longer is no corner, crossing or blot
PIECE_MM = 3.0  # of line, which shows how it runs
DETAIL_PX = 6.0  # neither lens nor cells part places that are nearer
FOLLOWS = 0.1  # share by which what is usual follows what is seen, again and again
FADES = 3.0  # softnesses from its edge, ink is whole or none: erfc is within 1e-5 of that
