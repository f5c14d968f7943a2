"""How marks are drawn: sizes and limits of ticks, dots and reference points.

Lengths are mm on the sheet, or widths of the line, or of its pen, which counts as `USUAL_WIDTH_MM` where it
is thinner.

Source: patent ES 361967 shows the marks and gives no sizes. Chosen by trial on the test drawings, so that a
mark drawn by hand is found, and lettering, dashes and branches are not.
"""

from __future__ import annotations

import math

from morfax.motion.plane import CORNER_RAD
from morfax.tracer.limits import AHEAD_RAD

# a tick: a short stroke across the line or beside it
LEAST_PENS = 1.2  # it reaches at least this far beyond the line's edge
LONGEST_PENS = 10.0  # and at most, across the line, on each side
# a tick that touches the line on one side: a longer stroke is a line that begins there
BESIDE_PENS = 7.0
FARTHEST_MM = 1.5  # from the line's edge to a tick beside it
SLANT = math.tan(AHEAD_RAD)  # from square to the line, at most
BENT_MM = 0.1  # root mean square distance from a straight line, at most
# width, of the line's, of ink that is looked at: a line that crosses may show half
SEEN = (0.3, 2.0)
INK = (0.65, 1.4)  # darkness, of the line's: one pen draws both
# widths from the line's middle: nearer, the ink of tick and line runs together
CLEAR_OF_LINE = 0.9
# share that may be ink of the paper to both sides of a tick: `limits.CLEAR_WIDTHS` of one that touches the
# line, `limits.ABOUT_WIDTHS` of the pen of one that does not, for lettering stands there
SOILED, APART_SOILED = 0.15, 0.03
CLEAR_OF_EDGE = 0.4  # widths from the tick's edge to where that paper begins
SAME_WIDTHS = 0.6  # feet on both sides that are nearer along the line are one tick's
# so far the line is straight about a tick, widths aside
CORNER_WIDTHS, CORNER_MM, CORNER_ASIDE = 1.2, 0.5, 0.25
LEAST_PX = 2.5  # a line's width: of a thinner one the cells cannot tell a mark from a burr

# a dot: a round of ink, wider than the line
DOT_LEAST_WIDTHS, DOT_LARGEST_WIDTHS = 0.85, 6.0  # its radius
DOT_FULL = 0.65  # its area over that of its box, at least; a disc has 0.785
DOT_ROUND = 0.15  # its spokes differ by less than this share
DOT_EVEN = 0.6  # share of the spokes that are alike, at least: the line covers the others
DOT_ALONG = AHEAD_RAD  # the line leaves it within this of its heading

# a reference point: a cross or a ring
CROSS_MM = (1.5, 10.0)  # across
SQUARE = math.sin(CORNER_RAD)  # its arms are this near to square
INKED = 0.85  # share of an arm's length that is ink, at least
ALIKE = 0.4  # its arms differ by less than this share
BOX = 0.7  # the shorter side of its box over the longer, at least
RING_LIKE = 0.6  # the ring's line differs in width by less than this share of the line's
RING_SEEN = 0.75  # share of the spokes that cross it, at least
RING_ROUND = 0.1  # misfit to a circle over the radius, at most
