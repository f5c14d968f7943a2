"""The drawing on its table: an image file becomes darkness 0..1 on a sheet in mm.

Signals: an image file in (PNG, JPEG, TIFF, …; any depth, grey or colour, with or without alpha), darkness
out: float32 (rows from the top, columns), 0 = paper, 1 = the ink of the drawing's lines, on square pixels of
`pitch_mm`. Uneven paper and the darkness of the ink are seen to by `levelling`.

Sheet coordinates: mm from the lower-left corner, X right, Y up; pixel i covers [i, i+1) pitches, so the
centre of pixel 0 is at half a pitch.

A sheet may have a thousand million pixels: a large one is worked on strip by strip, and of its darkness only
the tiles with ink are kept (see `large` and `tiles`).

Questions: the patent takes the drawing for granted. If the file states no resolution, the operator is asked;
it is never guessed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing import inks, raster
from morfax.tracer.drawing.blocks import BLOCK_PX, darkest
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.known_edges import KnownEdges
from morfax.tracer.drawing.narrow import Strips
from morfax.tracer.drawing.noise import Noise, measured
from morfax.tracer.drawing.reading import AS_LINES, Reading
from morfax.tracer.drawing.scale import Scale, on_square_pixels
from morfax.tracer.drawing.scan import Scan
from morfax.tracer.drawing.tiles import Tiles

if TYPE_CHECKING:
    from morfax.tracer.corrections.on_sheet import OnSheet, StopAt, TurnAt
    from morfax.tracer.drawing.strokes import Sheet
    from morfax.tracer.flatten.flat import Flattening

# of a scan of 300 dpi, for which the head's legs are made; a head slowed five times loses edges; by trial
EDGE_PITCH_MM, SMALLEST = 0.0847, 0.2
LEAST_RADIUS_MM, MOST_ENLARGED = 1.3, 4  # of an edge; by trial on round holes

Darkness = NDArray[np.float32]


@dataclass(frozen=True)
class Drawing:
    """A drawing as the cells see it: `darkness` (rows from the top, columns) on pixels of `pitch_mm`.

    Of filled shapes whose edges are asked for: the darkness is a line along these, so many times `enlarged`;
    `edges_mm` are closed polylines (n, 2) to which a run keeps; and the `shade` is what the head's cells see,
    paper 0 and shape 1, on the picture's own pixels. Otherwise `shapes` tells where filled shapes are no ink,
    on the picture reduced by a whole number; a scan that `has_shapes` may have them as ink. `notes` on the
    file are for the operator; `flattening` is how well a photograph was made flat; `corrected` what the
    operator put right, `bare` the drawing before that. A coarse scan's pixels are made so many times `finer`.
    Of `both` solid areas are as dark as lines. Lines look `seen_px` wide on the picture's own pixels, paper
    or ink alone if it `is_hard`, or with rims laid through their steps if it `has_rims`; a `grainy` one is
    seen through a slit. `paper_noise` is the deviation of the paper's darkness, if that was measured before
    it was made 0. Drawn lines of a PDF that `is_rendered` have any resolution that is asked for. A drawing
    `of_colour` holds one ink alone.
    """

    darkness: Darkness  # of a large sheet Tiles, which hand out the same
    pitch_mm: float
    file: Path | None = None
    enlarged: int = 1
    edges_mm: tuple[NDArray[np.float64], ...] = ()
    shade: Darkness | None = None
    shapes: NDArray[np.bool_] | None = None
    has_shapes: bool = False
    notes: tuple[str, ...] = ()
    flattening: Flattening | None = None
    corrected: OnSheet | None = None
    bare: Drawing | None = None
    finer: int = 1
    both: bool = False
    seen_px: float = math.inf
    is_hard: bool = False
    has_rims: bool = False
    grainy: bool = False
    paper_noise: float | None = None
    is_rendered: bool = False
    of_colour: bool = False
    drawn: Darkness | None = None
    narrow_strips = cached_property(Strips.of)  # of paper, between lines; none on a large sheet

    @cached_property
    def edge_cells(self) -> dict[float, Any]:
        """What cells see of the shade, by their aperture, mm: the same from every edge."""
        return {}

    @cached_property
    def known_edges(self) -> KnownEdges:
        """The edges of filled shapes, to be asked for by place."""
        return KnownEdges(self.edges_mm)

    @cached_property
    def as_drawn(self) -> Drawing:
        """The drawing without the slit that it is seen through, with the same noise."""
        if self.drawn is None:
            return self
        drawing = replace(self, darkness=self.drawn, drawn=None, grainy=False)
        vars(drawing)["noise"] = self.noise
        return drawing

    def times_at(self, place_mm: NDArray[np.float64]) -> float:
        """How many times enlarged the head follows the edge nearest to a place; 1 on a drawing of lines.

        A short edge bends more than the head can follow as it is. Where pixels are large, edges are followed
        on a smaller scale: there the head's legs are as many pixels long as corners and tips ask for.
        """
        if not self.edges_mm:
            return 1.0
        edge = self.known_edges.nearest(place_mm)
        radius_mm = float(np.hypot(*np.diff(edge, axis=0).T).sum()) / math.tau
        if radius_mm < LEAST_RADIUS_MM:
            return float(min(MOST_ENLARGED, math.ceil(LEAST_RADIUS_MM / radius_mm)))
        as_fine = EDGE_PITCH_MM / (self.pitch_mm * self.enlarged)
        return min(1.0, max(as_fine, LEAST_RADIUS_MM / radius_mm, SMALLEST))

    @property
    def told_turns(self) -> tuple[TurnAt, ...]:
        """The turns of the operator's corrections."""
        return () if self.corrected is None else self.corrected.turns

    @property
    def told_stops(self) -> tuple[StopAt, ...]:
        """The stops of the operator's corrections."""
        return () if self.corrected is None else self.corrected.stops

    @property
    def width_mm(self) -> float:
        """Width of the sheet, mm."""
        return self.darkness.shape[1] * self.pitch_mm

    @property
    def height_mm(self) -> float:
        """Height of the sheet, mm."""
        return self.darkness.shape[0] * self.pitch_mm

    @cached_property
    def sheet(self) -> Sheet:
        """The patches of ink on it."""
        from morfax.tracer.drawing.strokes import Sheet

        return Sheet.of(self)

    @cached_property
    def ink_px(self) -> int:
        """How many pixels are darker than half."""
        if isinstance(self.darkness, Tiles):
            return self.darkness.darker_px(INK)
        count = 0
        for i, dark in enumerate(self.darkest > INK):
            places = np.flatnonzero(dark)
            if len(places):
                rows = slice(BLOCK_PX * i, BLOCK_PX * (i + 1))
                columns = slice(BLOCK_PX * places[0], BLOCK_PX * (places[-1] + 1))
                count += int(np.count_nonzero(self.darkness[rows, columns] > INK))
        return count

    @cached_property
    def darkest(self) -> Darkness:
        """The darkest pixel of each block of `BLOCK_PX`: it tells quickly where nothing is drawn."""
        return darkest(self.darkness)

    @cached_property
    def noise(self) -> Noise:
        """What the picture is like: noise of paper and ink, softness of edges, width of the pen."""
        return measured(self.darkness, self.pitch_mm, self.paper_noise)

    @classmethod
    def open(
        cls,
        file: str | Path,
        dpi: float | None = None,
        width_mm: float | None = None,
        ink: str | None = None,
        edge: bool = False,
    ) -> Drawing:
        """Read an image file; its scale from `dpi`, or from the sheet's `width_mm`, or from the file.

        With `ink` only that ink of a coloured drawing is read, with `edge` the edges of filled shapes. Raises
        DrawingFault if the file is no image, states no resolution, or holds no line; FileFault if it
        cannot be read.
        """
        wanted = None if ink is None else inks.parsed(ink)
        scan = raster.read(Path(file), coloured=inks.is_colour(ink), dpi=dpi)
        return cls.of(scan, Scale(dpi, width_mm), wanted, Reading(edge))

    @classmethod
    def of(
        cls,
        scan: Scan,
        scale: Scale,
        ink: inks.Ink | None = None,
        reading: Reading = AS_LINES,
    ) -> Drawing:
        """Make a drawing of a scan that was opened; in colours where an ink is asked for.

        Raises DrawingFault for a missing scale, for a scan that holds no line, and for printed lines that are
        not there.
        """
        pitch = scale.pitches_mm(scan)
        grey = inks.grey_of(scan.pixels, ink, None if reading.edge else pitch[0])
        grey = on_square_pixels(grey, pitch)
        notes = (*scan.notes, *scale.notes(scan))
        if reading.edge:
            return cls._of_shapes(scan, np.asarray(grey), pitch[0], notes)
        reading = reading._replace(
            polarity=inks.polarity_of(ink), of_colour=isinstance(ink, tuple)
        )
        return cls._of_lines(scan, grey, pitch[0], notes, reading)

    @classmethod
    def _of_shapes(
        cls, scan: Scan, grey: NDArray[Any], pitch_mm: float, notes: tuple[str, ...]
    ) -> Drawing:
        """The edges of the filled shapes in grey levels on square pixels."""
        from morfax.tracer.drawing.shapes import outlined

        rims = outlined(grey, pitch_mm)
        return cls(
            rims.darkness,
            pitch_mm / rims.finer,
            scan.file,
            rims.finer,
            rims.edges_mm,
            rims.shade,
            notes=(*notes, *rims.notes),
            is_rendered=scan.is_rendered,
        )

    @classmethod
    def _of_lines(
        cls, scan: Scan, grey: Any, pitch_mm: float, notes: tuple[str, ...], reading: Reading
    ) -> Drawing:
        """The lines of a scan in grey levels on square pixels."""
        from morfax.tracer.drawing.lines_read import lines_read

        lines = lines_read(grey, pitch_mm, reading)
        drawing = cls(
            lines.darkness,
            lines.pitch_mm,
            scan.file,
            shapes=lines.shapes,
            has_shapes=lines.has_shapes,
            notes=(*notes, *lines.notes),
            finer=lines.finer,
            seen_px=lines.seen_px,
            is_hard=lines.is_hard,
            has_rims=lines.has_rims,
            grainy=lines.grainy,
            paper_noise=lines.paper_noise,
            is_rendered=scan.is_rendered,
            of_colour=reading.of_colour,
            drawn=lines.drawn,
        )
        vars(drawing).update(lines.measured)
        return drawing
