"""SVG read: paths and shapes of a drawing, as an outline in mm.

Signals in: an SVG. Signals out: an Outline; X to the right, Y up, from the lower left corner of the sheet, or
from where the file says its zero is (`data-lower-left-mm`, which morfax writes).

    width="210mm" viewBox="0 0 210 297"     one unit of the drawing is 210 mm / 210
    width="210mm", no viewBox               one unit is 1/96 inch (CSS)
    width="794", in px or in percent        says nothing: refused, unless the unit is given

What is hidden (display, visibility), neither stroked nor filled, or only filled in white (paper) is left out.
So are words and pictures, and it is said.

Source: SVG 1.1, 7.7 viewBox, 7.8 preserveAspectRatio, 8.3 paths; CSS 2.1, 4.3.2 lengths. Questions: clip
paths are not applied. A drawing on a sheet of another shape is in its middle (xMidYMid), whatever it says.
"""

from __future__ import annotations

import copy
import io
import math
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, NamedTuple
from xml.etree import ElementTree

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault, FileFault
from morfax.recorder.drawings.curve_chords import FLAT_MM, bezier, chords_of
from morfax.recorder.drawings.drawn_units import INCH_MM, NO_UNIT, UNITS_MM, ZERO, unit_mm
from morfax.recorder.drawings.outline import Outline

if TYPE_CHECKING:
    from svgelements import Arc, Path

SVG = "http://www.w3.org/2000/svg"
LENGTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-zA-Z%]*)\s*")
PHYSICAL_MM = {"mm": 1.0, "cm": 10.0, "in": INCH_MM, "pt": INCH_MM / 72, "pc": INCH_MM / 6,
               "q": 0.25}  # fmt: skip
SHAPED = 1e-6  # width and height that differ in scale by a smaller share are rounded
# what svgelements meets in damaged files
DAMAGE = (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError)
WORDS = ("text", "image", "foreignObject")
HREF = "{http://www.w3.org/1999/xlink}href"
# elements that `use` makes of fewer: each costs 6 kB and 0.3 ms; no sheet has room for as many parts
MOST_REPEATED = 100_000


class _Sheet(NamedTuple):
    """How the drawing lies on its sheet: mm per unit in X and Y, and where its zero comes to lie, mm."""

    x_mm: float
    y_mm: float
    left_mm: float
    top_mm: float

    def placed(self, places: Array) -> Array:
        """Places of the drawing, in its units and Y down, on the sheet, mm and Y up."""
        x, y = places.T
        return np.column_stack([self.left_mm + self.x_mm * x, self.top_mm - self.y_mm * y])


def read_svg(file: FilePath, unit: str | None = None) -> Outline:
    """Read an SVG; raises DrawingFault for one that is damaged, empty or without a unit, FileFault."""
    root = _root(file)
    sheet = _sheet(file, root, unit)
    try:
        _demand_few(file, root)
        off = FLAT_MM / max(sheet.x_mm, sheet.y_mm)
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
    return Outline.of(pieces, [f"{file}: {told} are no lines, and left out"] if told else [])


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
        raise DrawingFault(
            f"{file} is no SVG: it begins with {_tag(root)[:40]!r}; give another"
        )
    return root


def _tag(element: ElementTree.Element) -> str:
    """The name of an element without its namespace."""
    return str(element.tag).rpartition("}")[2]


# how large it is


def _sheet(file: FilePath, root: ElementTree.Element, unit: str | None) -> _Sheet:
    """How the drawing lies on its sheet; raises DrawingFault if the file does not say how large it is."""
    box = _view_box(file, root)
    width, height = (_length(root.get(name)) for name in ("width", "height"))
    if unit is not None:
        box = box or (0.0, 0.0, 0.0, height[0] if height else 0.0)
        return _from_zero(root, _in_units(box, unit_mm(unit)))
    width_mm, high_mm = _physical_mm(width), _physical_mm(height)
    if width_mm is None or not width_mm > 0:
        raise _without_width(file, root)
    if box is None:
        px_mm = UNITS_MM["px"]
        return _from_zero(root, _Sheet(px_mm, px_mm, 0.0, high_mm or 0.0))
    if high_mm is None:
        high_mm = width_mm * box[3] / box[2]
    if not high_mm > 0:
        raise DrawingFault(f"{file}: height is {root.get('height')!r}; it must be above zero")
    return _from_zero(root, _laid(root, box, width_mm, high_mm))


def _physical_mm(length: tuple[float, str] | None) -> float | None:
    """A length of the file, mm; None if there is none, or in a unit that is no length on paper."""
    known = length is not None and length[1] in PHYSICAL_MM
    return length[0] * PHYSICAL_MM[length[1]] if length and known else None


def _without_width(file: FilePath, root: ElementTree.Element) -> DrawingFault:
    """What is said of a file that does not tell how wide it is."""
    got = f"its width is {root.get('width')!r}" if root.get("width") else "it has no width"
    return DrawingFault(NO_UNIT.format(file=file, why=got))


def _in_units(box: tuple[float, float, float, float], one_mm: float) -> _Sheet:
    """How a view box lies on a sheet if one of its units is so long."""
    left, top, _, high = box
    return _Sheet(one_mm, one_mm, -left * one_mm, (top + high) * one_mm)


def _laid(
    root: ElementTree.Element,
    box: tuple[float, float, float, float],
    wide_mm: float,
    high_mm: float,
) -> _Sheet:
    """How a view box lies on a sheet."""
    left, top, wide, high = box
    x_mm, y_mm = wide_mm / wide, high_mm / high
    how = root.get("preserveAspectRatio", "")
    if "none" not in how and abs(x_mm / y_mm - 1) > SHAPED:
        x_mm = y_mm = max(x_mm, y_mm) if "slice" in how else min(x_mm, y_mm)
    aside_mm, down_mm = (wide_mm - wide * x_mm) / 2, (high_mm - high * y_mm) / 2
    return _Sheet(x_mm, y_mm, aside_mm - left * x_mm, high_mm - down_mm + top * y_mm)


def _from_zero(root: ElementTree.Element, sheet: _Sheet) -> _Sheet:
    """The sheet moved to where the file says that its lower left corner is."""
    try:
        left_mm, low_mm = (float(word) for word in root.get(ZERO, "").split())
    except ValueError:
        return sheet
    return sheet._replace(left_mm=sheet.left_mm + left_mm, top_mm=sheet.top_mm + low_mm)


def _length(text: str | None) -> tuple[float, str] | None:
    """A length and its unit, None if it is none."""
    found = LENGTH.fullmatch(text or "")
    return (float(found[1]), found[2].lower()) if found else None


def _view_box(
    file: FilePath, root: ElementTree.Element
) -> tuple[float, float, float, float] | None:
    """Left, top, width and height of the view box, None if there is none."""
    text = root.get("viewBox")
    if text is None:
        return None
    try:
        left, top, wide, high = (float(word) for word in text.replace(",", " ").split())
    except ValueError:
        left = top = wide = high = math.nan
    if not (math.isfinite(left + top) and 0 < wide < math.inf and 0 < high < math.inf):
        raise DrawingFault(
            f"{file}: viewBox is {text[:40]!r}; it must be four numbers, the last two above zero"
        )
    return left, top, wide, high


# what is on it


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
