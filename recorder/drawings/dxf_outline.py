"""DXF read: what a CAD program has drawn in its model space, as an outline in mm.

Signals in: a DXF, as text or binary. Signals out: an Outline; X and Y are those of the file.

    LINE, ARC, CIRCLE, ELLIPSE, SPLINE, LWPOLYLINE, POLYLINE     contours, curves flattened to 1 um
    POINT                                                        holes
    INSERT                                                       what its block holds, to any depth
    all else (TEXT, HATCH, DIMENSION, …)                         left out, and it is said

What is on a layer that is off or frozen is left out. The unit is the file's ($INSUNITS), or given by hand.

Source: Autodesk's DXF reference: HEADER ($INSUNITS), LAYER (flag 1 frozen, a negative colour off), LWPOLYLINE
(bulge = tan of a quarter of the angle). Questions: Z is left out. Entities on layer 0 of a block are on the
layer of its INSERT.
"""

from __future__ import annotations

import logging
import math
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.faults import DrawingFault, FileFault
from morfax.motion.usual import INCREMENT_MM
from morfax.recorder.drawings.curve_chords import bulged
from morfax.recorder.drawings.drawn_units import NO_UNIT, overruled, unit_mm
from morfax.recorder.drawings.outline import CadOutline

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.entities import DXFGraphic

DEEPEST = 16  # blocks in one another; one that holds itself is deeper
SPLINE_FRAME = 16  # flag of a vertex that only controls a curve
MOST = 1_000_000  # entities; some hundred would fill a sheet
# what ezdxf meets in damaged files, besides its own errors
DAMAGE = (
    ValueError,
    LookupError,
    TypeError,
    AttributeError,
    StopIteration,
    ArithmeticError,
    AssertionError,
    RecursionError,
)
# of a spline between two knots, and of an ellipse: what lies between is found from there
LEAST_CHORDS = 8


def read_dxf(file: FilePath, unit: str | None = None) -> CadOutline:
    """Read a DXF; raises DrawingFault for one that is damaged, empty or without a unit, FileFault."""
    from ezdxf.lldxf.const import DXFError

    try:
        document = _opened(file)
        stated_mm = _stated_mm(document)
        scale = _scale(file, document, stated_mm) if unit is None else unit_mm(unit)
        pieces, left_out = _pieces(file, document, scale)
    except OSError as error:
        if error.errno is not None:
            raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from None
        raise DrawingFault(f"{file} is no DXF; save it as one") from None
    except DrawingFault:
        raise
    except (DXFError, *DAMAGE) as error:
        why = " ".join(str(error).split())[:80] or type(error).__name__
        raise DrawingFault(f"{file} is a damaged DXF ({why}); save it again") from None
    if not pieces:
        raise DrawingFault(f"{file} holds no lines in its model space; save the part there")
    told = ", ".join(f"{count} {kind}" for kind, count in sorted(left_out.items()))
    left = [f"{file}: {told} are no lines, and left out"] if told else []
    return CadOutline.of(pieces, [*overruled(file, unit, stated_mm), *left])


def _pieces(
    file: FilePath, document: Drawing, scale: float
) -> tuple[list[Array], Counter[str]]:
    """The lines of a file, mm, and how many things of each kind are none."""
    pieces, left_out = list[Array](), Counter[str]()
    for count, entity in enumerate(_Shown.by(file, document).of(document.modelspace())):
        if count > MOST:
            raise DrawingFault(f"{file} holds more than {MOST} entities; save the part alone")
        places = _places(entity, INCREMENT_MM / scale)
        if places is None:
            left_out[entity.dxftype()] += 1
        elif len(places):
            if not np.isfinite(places).all():
                raise ValueError(f"a place of a {entity.dxftype()} is no number")
            pieces.append(scale * places)
    return pieces, left_out


def _opened(file: FilePath) -> Drawing:
    """The document in a file; one with mistakes is mended as far as it goes."""
    import ezdxf
    from ezdxf import recover
    from ezdxf.lldxf.const import DXFError

    # what it meets on its way would stand on the terminal, where no one has asked for it
    logging.getLogger("ezdxf").addHandler(logging.NullHandler())
    try:
        return ezdxf.readfile(file)
    except (DXFError, *DAMAGE):
        return recover.readfile(file)[0]


def _stated_mm(document: Drawing) -> float | None:
    """Length of the unit that the file states; None if it states none."""
    from ezdxf import units
    from ezdxf.enums import InsertUnits

    if document.units == 0:
        return None
    try:
        return float(
            units.conversion_factor(InsertUnits(document.units), InsertUnits.Millimeters)
        )
    except (KeyError, ValueError, TypeError):
        return None


def _scale(file: FilePath, document: Drawing, stated_mm: float | None) -> float:
    """Length of the file's unit, mm; raises DrawingFault if it states none."""
    if stated_mm is None:
        what = " or not there" if document.units == 0 else ", which is no unit"
        why = f"$INSUNITS is {document.units}{what}"
        raise DrawingFault(NO_UNIT.format(file=file, why=why))
    return stated_mm


@dataclass(frozen=True, slots=True)
class _Shown:
    """What a file shows, by its layers that are off (blocks on them are shown) and frozen."""

    file: FilePath
    off: frozenset[str]
    frozen: frozenset[str]

    @classmethod
    def by(cls, file: FilePath, document: Drawing) -> _Shown:
        """By the layers of a document."""
        off = [layer.dxf.name.lower() for layer in document.layers if layer.is_off()]
        frozen = [layer.dxf.name.lower() for layer in document.layers if layer.is_frozen()]
        return cls(file, frozenset(off), frozenset(frozen))

    def of(
        self, entities: Iterable[DXFGraphic], of_insert: str = "", depth: int = 0
    ) -> Iterator[DXFGraphic]:
        """What is shown of some entities, blocks as what they hold; `of_insert` is their block's layer."""
        if depth > DEEPEST:
            raise DrawingFault(
                f"{self.file} has blocks in one another, more than {DEEPEST} deep; explode them"
            )
        for entity in entities:
            own = entity.dxf.get("layer", "0").lower()
            layer = of_insert if own == "0" and of_insert else own
            if self._hides(entity, layer):
                continue
            if entity.dxftype() != "INSERT":
                yield entity
                continue
            for one in _each(entity):
                yield from self.of(one.virtual_entities(), layer, depth + 1)

    def _hides(self, entity: DXFGraphic, layer: str) -> bool:
        """Whether an entity of a layer is not to be seen."""
        is_off = layer in self.off and entity.dxftype() != "INSERT"
        return bool(entity.dxf.get("invisible", 0)) or layer in self.frozen or is_off


def _each(insert: Any) -> Iterable[Any]:
    """The places of a block that is put in, in rows and columns where it has several."""
    return insert.multi_insert() if insert.mcount > 1 else [insert]


def _places(entity: Any, off: float) -> Array | None:
    """Places of an entity in the file's unit, curves flattened; None if it is no line."""
    kind = entity.dxftype()
    if kind == "LINE":
        return _flat([entity.dxf.start, entity.dxf.end])
    if kind == "POINT":
        return _flat([entity.dxf.location])
    if kind in ("ARC", "CIRCLE"):
        radius = abs(entity.dxf.radius)
        return _flat(entity.flattening(min(off, radius / 2))) if radius else _flat([])
    if kind in ("ELLIPSE", "SPLINE"):
        return _flat(entity.flattening(off, LEAST_CHORDS))
    if kind == "LWPOLYLINE":
        corners = np.array(entity.get_points("xyb"), float).reshape(-1, 3)
        flat = _with_bulges(corners, entity.closed, off)
        z = entity.dxf.elevation
        return _flat(entity.ocs().points_to_wcs([(x, y, z) for x, y in flat]))
    if kind == "POLYLINE":
        return _polyline(entity, off)
    return None


def _polyline(entity: Any, off: float) -> Array | None:
    """Places of a polyline of the old kind; None if it is a mesh."""
    if not (entity.is_2d_polyline or entity.is_3d_polyline):
        return None
    vertices = [v for v in entity.vertices if not v.dxf.flags & SPLINE_FRAME]
    if entity.is_3d_polyline:
        places = [v.dxf.location for v in vertices]
        return _flat(places + places[:1] if entity.is_closed else places)
    corners = np.array(
        [(v.dxf.location.x, v.dxf.location.y, v.dxf.get("bulge", 0.0)) for v in vertices], float
    ).reshape(-1, 3)
    flat = _with_bulges(corners, entity.is_closed, off)
    return _flat(entity.ocs().points_to_wcs([(x, y, 0.0) for x, y in flat]))


def _with_bulges(corners: Array, closed: bool, off: float) -> Array:
    """The places of a polyline of corners (x, y, bulge), its arcs flattened."""
    if not len(corners):
        return np.empty((0, 2))
    around = np.vstack([corners, corners[:1]]) if closed and len(corners) > 1 else corners
    parts = [around[:1, :2]]
    for (*begin, bulge), (*end, _) in pairwise(around):
        if begin == end:
            continue
        is_arc = abs(bulge) > NOT_ZERO  # flatter than a millionth of 1 um in 1 m
        turned_rad = 4 * math.atan(bulge)
        parts.append(
            bulged(np.array(begin), np.array(end), turned_rad, off)
            if is_arc
            else np.array([end])
        )
    return np.vstack(parts)


def _flat(places: Iterable[Any]) -> Array:
    """X and Y of places, (n, 2)."""
    return np.array([(place[0], place[1]) for place in places], float).reshape(-1, 2)
