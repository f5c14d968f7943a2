"""The file of corrections, NAME.morfax.toml, beside the drawing: read, checked, and edited as a text.

Signals in: a text in TOML (`docs/reference/corrections.md` has the whole format). Signals out: Corrections;
or the text with one more, or fewer. A mistake is a CardFault that names line and field.

    [drawing]
    name = "scan.png"
    pixels = [2480, 3508]

    [[correction]]
    do = "bridge"
    at = ["812px,1004px", "850px,1010px"]
    why = "the pen skipped"

The text is edited and not written anew: an addition goes to its end, a removal takes the lines of one entry.
So what people have written beside the entries stays.

Source: our own. Questions: a library that edits TOML (tomlkit) keeps comments too; adding at the end and
taking whole entries needs none.
"""

from __future__ import annotations

import json
from pathlib import Path as FilePath
from typing import Literal, NoReturn, cast

from morfax.motion.faults import FileFault
from morfax.motion.files import written_beside
from morfax.motion.toml_fields import LARGEST_BYTES, Field, opened, parsed, read
from morfax.tracer.corrections.corrections import (
    KINDS,
    MOST_PLACES,
    Correction,
    Corrections,
    Kind,
    PictureFile,
    Place,
    Span,
)

CALLED = "the file of corrections"
HEAD = (
    "# Corrections of a drawing, which morfax trace uses: see docs/reference/corrections.md\n"
)
_KEYS = ("drawing", "correction")
_PICTURE_KEYS = ("name", "pixels", "sha256", "page")
_ENTRY_KEYS = ("do", "at", "width", "from", "direction", "why")
_SUM_DIGITS = 64  # of SHA-256


def read_corrections(file: FilePath) -> Corrections:
    """The corrections in a file; raises CardFault for a mistake, FileFault if it cannot be read."""
    return _corrections(opened(file, CALLED, "--corrections"), file.name)


def parse_corrections(text: str, name: str = "drawing.morfax.toml") -> Corrections:
    """The corrections in a text; raises CardFault for a mistake."""
    return _corrections(parsed(text, name, CALLED), name)


def as_toml(corrections: Corrections) -> str:
    """Corrections as a text that is read as the same corrections."""
    picture = "" if corrections.picture is None else _picture_toml(corrections.picture)
    return HEAD + picture + "".join(map(_entry_toml, corrections.each))


def with_added(text: str, more: tuple[Correction, ...], picture: PictureFile) -> str:
    """A text with more corrections at its end; an empty text gets the head and the picture before them."""
    if not text.strip():
        return as_toml(Corrections(more, picture))
    whole = text if text.endswith("\n") else text + "\n"
    return whole + "".join(map(_entry_toml, more))


def without(text: str, numbers: tuple[int, ...]) -> str:
    """A text without the corrections of some numbers, from 1; raises ValueError for a number it has not."""
    lines, begins = text.splitlines(keepends=True), _entry_lines(text)
    for number in numbers:
        if not 1 <= number <= len(begins):
            has = f"it has {len(begins)}" if begins else "it has none"
            raise ValueError(f"there is no correction {number}; {has}")
    ends = [*begins[1:], len(lines)]
    taken = {k for n in numbers for k in range(begins[n - 1], ends[n - 1])}
    left = [line for k, line in enumerate(lines) if k not in taken]
    return "".join(left).rstrip("\n") + "\n"


def write_text(file: FilePath, text: str) -> Corrections:
    """Check a text, and write it whole or not at all; what it holds. Raises CardFault and FileFault."""
    held = parse_corrections(text, file.name)
    if len(text.encode()) > LARGEST_BYTES:
        raise FileFault(
            f"cannot write {file}: it would have more than {LARGEST_BYTES} bytes; take corrections away"
        )
    with written_beside(file) as new:
        new.write_text(text, encoding="utf-8", newline="\n")
    return held


# reading


def _corrections(whole: Field, name: str) -> Corrections:
    """The file as a whole."""
    fields = whole.table(*_KEYS)
    each = read(fields, "correction", _entries, ())
    return Corrections(each, read(fields, "drawing", _picture, None), name)


def _picture(field: Field) -> PictureFile:
    """The picture that the corrections belong to."""
    fields = field.table(*_PICTURE_KEYS)
    for key in ("name", "pixels"):
        if key not in fields:
            field.refuse(
                f'it must hold {key}, such as name = "scan.png", pixels = [2480, 3508]'
            )
    allowed = "columns and rows, two whole numbers such as [2480, 3508]"
    pixels = fields["pixels"].elements(allowed)
    if len(pixels) != 2:
        fields["pixels"].refuse(f"it may hold {allowed}")
    columns, rows = (one.number() for one in pixels)
    checked = read(fields, "sha256", _sum, "")
    return PictureFile(
        _text(fields["name"]), columns, rows, checked, read(fields, "page", Field.number, 1)
    )


def _sum(field: Field) -> str:
    """The sum of the picture's file."""
    text = _text(field)
    if len(text) != _SUM_DIGITS or not set(text) <= set("0123456789abcdef"):
        field.refuse(f"it may hold the file's SHA-256, {_SUM_DIGITS} digits; or leave it out")
    return text


def _text(field: Field) -> str:
    """A text of one line."""
    if not isinstance(field.value, str) or not field.value.isprintable():
        field.refuse("it may hold a text of one line")
    return field.value


def _entries(field: Field) -> tuple[Correction, ...]:
    """All corrections."""
    return tuple(_entry(one) for one in field.elements("entries [[correction]]"))


def _entry(entry: Field) -> Correction:
    """One correction."""
    fields = entry.table(*_ENTRY_KEYS)
    for key in ("do", "at"):
        if key not in fields:
            entry.refuse(f'it must hold {key}, such as do = "rub", at = "345px,210px"')
    made = Correction(
        cast(Kind, fields["do"].choice(*KINDS)),
        _places(fields["at"]),
        read(fields, "width", _span, None),
        read(fields, "from", _place, None),
        read(fields, "direction", _direction, None),
        read(fields, "why", _text, ""),
    )
    try:
        made.check()
    except ValueError as refused:
        _refused(entry, fields, str(refused))
    return made


def _refused(entry: Field, fields: dict[str, Field], why: str) -> NoReturn:
    """Raise the fault of an entry, at the field that it is about."""
    words = {
        "places": "at",
        "width": "width",
        "from": "from",
        "direction": "direction",
        "why": "why",
    }
    about = (fields[key] for word, key in words.items() if word in why and key in fields)
    next(about, entry).refuse(why)


def _places(field: Field) -> tuple[Place, ...]:
    """One place, or a list of places."""
    if isinstance(field.value, str):
        return (_place(field),)
    allowed = f'a place such as "345px,210px", or a list of up to {MOST_PLACES} places'
    elements = field.elements(allowed)
    if len(elements) > MOST_PLACES:
        field.refuse(f"it may hold {allowed}", f"{len(elements)} places")
    return tuple(map(_place, elements))


def _place(field: Field) -> Place:
    """One place."""
    allowed = 'it may hold a place such as "345px,210px" or "40mm,62mm"'
    if not isinstance(field.value, str):
        field.refuse(allowed)
    try:
        return Place.parse(field.value)
    except ValueError:
        field.refuse(allowed)


def _span(field: Field) -> Span:
    """A width."""
    allowed = 'it may hold a width above zero such as "12px" or "3mm"'
    try:
        span = Span.parse(field.quantity(allowed))
    except ValueError:
        field.refuse(allowed)
    if not span.amount > 0:
        field.refuse(allowed)
    return span


def _direction(field: Field) -> Literal["cw", "ccw"]:
    """Which way round."""
    return cast(Literal["cw", "ccw"], field.choice("cw", "ccw"))


# editing


def _entry_lines(text: str) -> list[int]:
    """The lines, from 0, on which the entries begin; the file is known to be read."""
    entries = parsed(text, CALLED, CALLED).table(*_KEYS).get("correction")
    if entries is None:
        return []
    lines = text.splitlines()
    return [
        _with_remarks(lines, one.page.lines[one.path] - 1)
        for one in entries.elements("entries")
    ]


def _with_remarks(lines: list[str], line: int) -> int:
    """The first of the comments that stand right above a line, or the line itself."""
    while line > 0 and lines[line - 1].lstrip().startswith("#"):
        line -= 1
    return line


def _picture_toml(picture: PictureFile) -> str:
    """The picture as a table."""
    lines = [
        "\n[drawing]",
        f"name = {_quoted(picture.name)}",
        f"pixels = [{picture.columns}, {picture.rows}]",
    ]
    if picture.page != 1:
        lines.append(f"page = {picture.page}")
    if picture.sha256:
        lines.append(f'sha256 = "{picture.sha256}"')
    return "\n".join(lines) + "\n"


def _entry_toml(one: Correction) -> str:
    """One correction as a table."""
    places = ", ".join(f'"{place}"' for place in one.at)
    lines = ["\n[[correction]]", f'do = "{one.do}"']
    lines.append(f"at = {places}" if len(one.at) == 1 else f"at = [{places}]")
    held = {"width": one.width, "from": one.coming_from, "direction": one.direction}
    lines += [f'{key} = "{value}"' for key, value in held.items() if value is not None]
    if one.why:
        lines.append(f"why = {_quoted(one.why)}")
    return "\n".join(lines) + "\n"


def _quoted(text: str) -> str:
    """A text as TOML writes it: as JSON does."""
    return json.dumps(text, ensure_ascii=False)
