"""On pages: what is said of the drawn lines of a PDF. It has any resolution: instead of a finer scan --dpi is
advised, with twice the resolution that the page was read at.

Signals: a drawing, and texts and faults in; the same for its page out.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from morfax.motion.faults import LineFault
    from morfax.tracer.drawing.drawing import Drawing

FINER = "scan at a higher resolution"
TIMES = 2  # as fine


def of_page(text: str, drawing: Drawing) -> str:
    """A text that may advise a finer scan, as the drawing's file can be had finer."""
    if not drawing.is_rendered:
        return text
    from morfax.tracer.drawing.coarse import at_dpi, finer_dpi

    text = re.sub(r"scan at (\d+) dpi", r"give --dpi \1", text)
    dpi = finer_dpi(drawing.pitch_mm * drawing.finer * drawing.enlarged, TIMES)
    return text.replace(FINER, at_dpi(dpi, is_rendered=True))


def fault_of_page(fault: LineFault, drawing: Drawing) -> LineFault:
    """The fault, which says what helps for the drawing's file."""
    fault.args = (of_page(str(fault), drawing), *fault.args[1:])
    return fault
