"""SVG read: paths and shapes of a drawing, as an outline in mm.

Signals in: an SVG. Signals out: an Outline; X to the right, Y up, from the lower left corner of the sheet, or
from where the file says its zero is.

What is hidden (display, visibility), neither stroked nor filled, or only filled in white (paper) is left out.
So are words and pictures, and it is said.

Source: SVG 1.1, 8.3 paths; how large a drawing is, see `svg_sheet`. Questions: clip paths are not applied.
"""

from __future__ import annotations

import copy
import io
import math
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault, FileFault
from morfax.motion.usual import INCREMENT_MM
from morfax.recorder.drawings.curve_chords import bezier, chords_of
from morfax.recorder.drawings.drawn_units import overruled
from morfax.recorder.drawings.outline import CadOutline
from morfax.recorder.drawings.svg_sheet import sheet_of, stated_mm

if TYPE_CHECKING:
    from svgelements import Arc, Path

SVG = "http://www.w3.org/2000/svg"
# what svgelements meets in damaged files
DAMAGE = (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError)
WORDS = ("text", "image", "foreignObject")
HREF = "{http://www.w3.org/1999/xlink}href"
# elements that `use` makes of fewer: each costs 6 kB and 0.3 ms; no sheet has room for as many parts
MOST_REPEATED = 100_000


def read_svg(file: FilePath, unit: str | None = None) -> CadOutline:
    """Read an SVG; raises DrawingFault for one that is damaged, empty or without a unit, FileFault."""
    root = _root(file)
    sheet = sheet_of(file, root, unit)
    try:
        _demand_few(file, root)
        off = INCREMENT_MM / max(sheet.x_mm, sheet.y_mm)
        pieces = [
            sheet.placed(places) for shape in _shapes(root) for places in _flattened(shape, off)
        ]
    except DrawingFault:
        raise
    except DAMAGE as error:
        why = " ".join(str(error).split())[:80] or type(error).__name__
        raise DrawingFault(f"{file} is a damaged SVG ({why}); save it again") from None
    if not pieces:
        raise DrawingFault(f"{file} holds no lines; turn words into paths, and save it again")
    count = Counter(tag for tag in map(_tag, root.iter()) if tag in WORDS)
    told = ", ".join(f"{n} {tag}" for tag, n in sorted(count.items()))
    left = [f"{file}: {told} are no lines, and left out"] if told else []
    return CadOutline.of(pieces, [*overruled(file, unit, stated_mm(file, root)), *left])


def _root(file: FilePath) -> ElementTree.Element:
    """The root of the file."""
    ElementTree.register_namespace("", SVG)
    try:
        root = ElementTree.fromstring(file.read_bytes())
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from None
    except (ElementTree.ParseError, ValueError, RecursionError) as error:
        raise DrawingFault(f"{file} is a damaged SVG ({error}); save it again") from None
    if _tag(root) != "svg":
        got = repr(_tag(root)[:40])
        raise DrawingFault(f"{file} is no SVG: it begins with {got}; give another")
    return root


def _tag(element: ElementTree.Element) -> str:
    """The name of an element without its namespace."""
    return str(element.tag).rpartition("}")[2]


def _demand_few(file: FilePath, root: ElementTree.Element) -> None:
    """Raise DrawingFault for a drawing in which `use` repeats too many elements, or one within itself."""
    named = {name: element for element in root.iter() if (name := element.get("id"))}
    count = _elements(root, named, {})
    if count <= max(MOST_REPEATED, sum(1 for _ in root.iter())):
        return
    if not math.isfinite(count):
        raise DrawingFault(
            f"{file} has a `use` that repeats what it stands in, without end; take it out"
        )
    raise DrawingFault(
        f"{file} repeats its elements with `use`: {count:.3g} of them, at most {MOST_REPEATED} are read; "
        "save the part alone"
    )


def _elements(
    element: ElementTree.Element,
    named: dict[str, ElementTree.Element],
    known: dict[ElementTree.Element, float],
) -> float:
    """How many elements one is, with those that it holds and repeats; infinite for one within itself."""
    if element in known:
        return known[element]
    known[element] = math.inf
    href = element.get("href") or element.get(HREF) or ""
    again = named.get(href.removeprefix("#")) if _tag(element) == "use" else None
    within = [*element, *([] if again is None else [again])]
    known[element] = 1 + sum(_elements(one, named, known) for one in within)
    return known[element]


def _shapes(root: ElementTree.Element) -> Iterator[Path]:
    """What is drawn and shown, as paths in the drawing's units."""
    import svgelements

    bare = copy.copy(root)
    for name in ("width", "height", "viewBox"):
        bare.attrib.pop(name, None)
    source = io.BytesIO(ElementTree.tostring(bare))
    for element in svgelements.SVG.parse(source, reify=True, on_error="raise").elements():
        if isinstance(element, svgelements.Shape) and _is_shown(element):
            yield abs(svgelements.Path(element))


def _is_shown(shape: Any) -> bool:
    """Whether a shape is seen on white paper."""
    if shape.values.get("visibility") in ("hidden", "collapse"):
        return False
    stroked = shape.stroke is not None and shape.stroke.value is not None
    filled = shape.fill is not None and shape.fill.value is not None
    return stroked or (filled and shape.fill.rgb != 0xFFFFFF)


def _flattened(path: Path, off: float) -> Iterator[Array]:
    """The lines of a path, (n, 2) each, curves flattened."""
    from svgelements import Arc, Close, CubicBezier, Line, Move, QuadraticBezier

    places: list[Array] = []
    for segment in path:
        if isinstance(segment, Move):
            yield from _line(places)
            places = [_points([segment.end])]
            continue
        if isinstance(segment, Line | Close):
            if segment.end is not None:
                places.append(_points([segment.end]))
        elif isinstance(segment, Arc):
            places.append(_arc(segment, off))
        elif isinstance(segment, CubicBezier):
            through = [segment.start, segment.control1, segment.control2, segment.end]
            places.append(bezier(_points(through), off))
        elif isinstance(segment, QuadraticBezier):
            places.append(bezier(_points([segment.start, segment.control, segment.end]), off))
        if isinstance(segment, Close):
            yield from _line(places)
            places = [_points([segment.end])] if segment.end is not None else []
    yield from _line(places)


def _line(places: Sequence[Array]) -> Iterator[Array]:
    """A line of some places, if it is more than a place to go on from; no place twice in a row."""
    if len(places) < 2:
        return
    whole = np.vstack(places)
    if not np.isfinite(whole).all():
        raise ValueError("a place that is no number")
    yield whole[np.r_[True, (np.diff(whole, axis=0) != 0).any(axis=1)]]


def _arc(arc: Arc, off: float) -> Array:
    """Places on an arc of an ellipse after its beginning."""
    across = max(abs(arc.rx), abs(arc.ry))
    count = chords_of(across, arc.sweep, off)
    angles = arc.get_start_t() + arc.sweep * np.arange(1, count) / count
    places = _points([arc.point_at_t(angle) for angle in angles.tolist()])
    return np.vstack([places, _points([arc.end])])


def _points(points: Sequence[Any]) -> Array:
    """Points as places (n, 2)."""
    return np.array([(point.x, point.y) for point in points], float).reshape(-1, 2)
