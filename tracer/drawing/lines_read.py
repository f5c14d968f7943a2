"""Lines read: a sheet's grey levels become the darkness of a drawing of lines.

Signals: grey levels on square pixels, and how they are read, in; the darkness of the lines, what was seen of
them on the way, and notes for the operator out.

Source: our own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing import coarse, grain, large, speckled
from morfax.tracer.drawing.blocks import darkest
from morfax.tracer.drawing.cleared import cleared
from morfax.tracer.drawing.deepening import deepened, deepened_note
from morfax.tracer.drawing.levelling import BOLD_MM, Levelled, levelled
from morfax.tracer.drawing.noise import Within, within
from morfax.tracer.drawing.reading import Reading
from morfax.tracer.drawing.tiles import Tiles


@dataclass(frozen=True)
class LinesRead:
    """The darkness of a drawing of lines, and what else `drawing.Drawing` tells of it; `measured` is what of
    that darkness is known already, by the names of the drawing's properties.
    """

    darkness: Any
    pitch_mm: float
    notes: tuple[str, ...]
    shapes: NDArray[np.bool_] | None
    has_shapes: bool
    finer: int
    seen_px: float
    is_hard: bool
    has_rims: bool
    grainy: bool
    paper_noise: float
    drawn: NDArray[np.float32] | None
    measured: dict[str, Any]


def lines_read(grey: Any, pitch_mm: float, reading: Reading) -> LinesRead:
    """The lines in grey levels on square pixels of a pitch: bold ones as such, and lines of pixels that are
    smaller than their specks on larger ones.
    """
    # 1. darkness, without what is printed and the scan's border
    sheet = _levelled(grey, pitch_mm, reading)
    darkness, ink, told = cleared(
        sheet.darkness, pitch_mm, reading.printed, reading.pale_is_ink
    )
    sheet = sheet._replace(darkness=darkness, paper_noise=sheet.paper_noise / ink)
    lines = within(darkness, sheet.paper_noise)
    # 2. read in another way
    if lines.width_px * pitch_mm >= BOLD_MM and not reading.bold:
        return lines_read(grey, pitch_mm, reading._replace(polarity=sheet.polarity, bold=True))
    times = speckled.times_larger(darkness, lines, pitch_mm)
    if times > 1:
        larger = speckled.on_larger_pixels(np.asarray(grey), times)
        read = lines_read(larger, times * pitch_mm, reading)
        return replace(read, notes=(speckled.note(times, pitch_mm), *read.notes))
    read = _read(sheet, lines, pitch_mm, reading)
    return replace(read, notes=(*sheet.polarity.notes, *told, *read.notes))


def _read(sheet: Levelled, lines: Within, pitch_mm: float, reading: Reading) -> LinesRead:
    """The lines of a levelled sheet: pale ones deepened, grain averaged, and steps of pixels made even."""
    darkness, paper_noise, shapes = sheet.darkness, sheet.paper_noise, sheet.shapes
    drawn_grain, pale_mm = lines.grain, 0.0
    # 1. pale lines
    if reading.pale_is_ink and not isinstance(darkness, Tiles):
        is_pencil = grain.slit_for(drawn_grain, lines.width_px, pitch_mm) is not None
        pale_mm = deepened(darkness, pitch_mm, paper_noise, shapes, is_pencil=is_pencil)
        lines = within(darkness, paper_noise) if pale_mm else lines
    notes = tuple(grain.notes_of_few_pixels(lines, drawn_grain, pitch_mm))
    most = None if isinstance(darkness, Tiles) else darkest(np.asarray(darkness))
    hard = most is not None and coarse.is_hard(np.asarray(darkness), most)
    # 2. grain, of lines as they are drawn
    averaged = grain.averaged(darkness, drawn_grain, lines.width_px, pitch_mm)
    if averaged is not None:
        darkness, notes = averaged.darkness, (*notes, averaged.note)
    # 3. steps of pixels, and too large pixels
    steps = most if hard and averaged is None else None
    darkness, finer, has_rims = coarse.without_steps(darkness, lines, steps)
    if finer > 1 and reading.pale_is_ink:  # a line of a pixel is paler now
        pale_mm += deepened(darkness, pitch_mm / finer, None, shapes)
    measured = dict[str, Any]()
    if averaged is None and finer == 1 and not has_rims:  # the darkness that was measured
        measured = {} if most is None else {"darkest": most}
        measured["noise"] = lines.found.noise(pitch_mm)
    return LinesRead(
        darkness,
        pitch_mm / finer,
        (*notes, deepened_note(pale_mm)) if pale_mm else notes,
        shapes,
        sheet.has_shapes,
        finer,
        lines.seen_px,
        hard and not has_rims,
        has_rims,
        averaged is not None,
        paper_noise,
        averaged.drawn if averaged is not None and finer == 1 else None,
        measured,
    )


def _levelled(grey: Any, pitch_mm: float, reading: Reading) -> Levelled:
    """The sheet as darkness, one of bold lines as if it were half as large; a large one as tiles of it."""
    seen_mm = pitch_mm / 2 if reading.bold else pitch_mm
    if grey.size >= large.LARGE_PX:
        return large.levelled(grey, seen_mm, reading.polarity)
    return levelled(grey, seen_mm, reading.shapes_are_ink, reading.polarity)
