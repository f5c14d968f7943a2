"""The panel: the options of the head and the tool, which become the `Head` of a verb."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, NoReturn

import click
from click.core import ParameterSource

from morfax.console.options.types import (
    CLEARANCE,
    CUTTER,
    DEPTH,
    LENGTH,
    LINES,
    OVERRIDE,
    PLACE,
    REACH,
    SPEED,
)
from morfax.jobs import files as medium
from morfax.jobs.tracing import Head, Marks

if TYPE_CHECKING:
    from morfax.tracer.cutter.cutter import Cutter, CutterSide
    from morfax.tracer.operator.card import Card

_OF_MARKS = tuple(field.name for field in fields(Marks))
_OF_HEAD = tuple(
    field.name
    for field in fields(Head)
    if field.name not in ("card", "filed", "marks", "cutter")
)

# what is asked of the head and the tool, in the order of --help
_LINE = (
    click.option(
        "--start",
        "start_mm",
        type=PLACE,
        help="Where the head looks for the line, X,Y in mm from the sheet's lower-left corner.  [default: the longest "
        "line, at a smooth place]",
    ),
    click.option(
        "--lines",
        type=LINES,
        help="Several lines as one program, inner before outer: all, outer (what lies in no other), or numbers such as "
        "1,3; 1 is the longest.  [default: one line, the longest or that at --start]",
    ),
    click.option(
        "--speed",
        "speed_mm_s",
        type=SPEED,
        default="10mm/s",
        show_default=True,
        help="Tracing speed.",
    ),
)
_TOOL = (
    click.option(
        "--depth",
        "depth_mm",
        type=DEPTH,
        default="5mm",
        show_default=True,
        help="How deep the tool goes into the work along the line.",
    ),
    click.option(
        "--clearance",
        "clearance_mm",
        type=CLEARANCE,
        default="2mm",
        show_default=True,
        help="How far above the work the tool stands before and after.",
    ),
    click.option(
        "--cutter",
        "cutter_mm",
        type=CUTTER,
        help="Diameter of the cutter, such as 6mm: the tool runs beside the line, half of that away.  [default: the tool "
        "runs on the line]",
    ),
    click.option(
        "--side",
        type=click.Choice(["outside", "inside", "left", "right"]),
        default="outside",
        show_default=True,
        help="Of --cutter: outside or inside of the part (holes the other way round), or by the travel of the head.",
    ),
)
_GAPS = (
    click.option(
        "--line-width",
        "line_width_mm",
        type=LENGTH,
        help="Width of the line, such as 0.5mm.  [default: measured on the drawing]",
    ),
    click.option(
        "--gap",
        "gap_mm",
        type=REACH,
        default="0.5mm",
        show_default=True,
        help="Widest gap in the line that the head goes across; 0: none but what a scan loses of a line, some 3 pixels.",
    ),
    click.option(
        "--recatch",
        "recatch_mm",
        type=REACH,
        help="How far ahead the head looks for a line that it has lost or that has ended, such as 5mm, to go on there.  "
        "[default: it stops]",
    ),
)
_MARKS = (
    click.option(
        "--reference",
        "reference_mm",
        type=PLACE,
        help="The reference point, X,Y in mm.  [default: a small cross or ring from which a line comes, if there is one]",
    ),
    click.option(
        "--origin",
        type=click.Choice(["sheet", "reference"]),
        default="sheet",
        show_default=True,
        help="The machine's zero: the sheet's lower-left corner, or the reference point.",
    ),
    click.option(
        "--direction",
        type=click.Choice(["cw", "ccw", "left", "right"]),
        help="Which way round; or to which side the head turns where its lead line, or its way from --start, meets the "
        "line.  [default: as it comes; left from a lead line]",
    ),
    click.option(
        "--override",
        type=OVERRIDE,
        help="Stop marks that do not stop the head: none, all, or numbers such as 1,3.  [default: the card's, or none]",
    ),
    click.option(
        "--ask", is_flag=True, help="Stop at every mark and ask for the Z moves, at a terminal."
    ),
    click.option(
        "--card",
        "card_file",
        type=medium.FILE,
        help="The operator's card (.toml): depths, speeds, what to do at the stops, turns. Options given beside it go before it.",
    ),
)
_HEAD = (
    click.option(
        "--head",
        "kind",
        type=click.Choice(["precise", "historic"]),
        default="precise",
        show_default=True,
        help="The head: precise, or that of 1969, which steers straight by its cell and cuts corners.",
    ),
    click.option(
        "--set",
        "changes",
        multiple=True,
        metavar="NAME=VALUE",
        help="Change a setting of the head by name, such as sweep_hz=50; the unit is in the name.",
    ),
    click.option(
        "--settings",
        "settings_file",
        type=medium.FILE,
        help="Settings of the head from a file (.toml), one to a line, as --print-settings writes them. --set and other "
        "options go before it.",
    ),
    click.option(
        "--print-settings",
        is_flag=True,
        help="Print the settings that the head would follow with, and do nothing else.",
    ),
)


def head_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Give a verb the options of the head and the tool, and hand it the `head`."""

    @functools.wraps(verb)
    def with_head(*args: Any, **options: Any) -> Any:
        head = _as_set(_head(options), options.pop("settings_file"), options.pop("card_file"))
        if options.pop("print_settings"):
            _print_settings(head)
        return verb(*args, head=head, **options)

    given = with_head
    for option in reversed((*_LINE, *_TOOL, *_GAPS, *_MARKS, *_HEAD)):
        given = option(given)
    return given


def _head(options: dict[str, Any]) -> Head:
    """The head of the command line, its options taken out of all; raises UsageError for those that do not go
    together.
    """
    taken = {name: options.pop(name) for name in (*_OF_MARKS, *_OF_HEAD, "cutter_mm", "side")}
    if taken["lines"] is not None and taken["start_mm"] is not None:
        raise click.UsageError("--start picks one line, --lines several; give one of them")
    if taken["cutter_mm"] is None and _given("side"):
        raise click.UsageError(
            "--side is the side of the cutter; give its diameter with --cutter, such as 6mm"
        )
    marks = Marks(**{name: taken[name] for name in _OF_MARKS})
    cutter = None if taken["cutter_mm"] is None else _cutter(taken["cutter_mm"], taken["side"])
    return Head(**{name: taken[name] for name in _OF_HEAD}, marks=marks, cutter=cutter)


def _as_set(head: Head, settings_file: FilePath | None, card_file: FilePath | None) -> Head:
    """The head with what a file of settings and a card say, but for the options that were given."""
    if settings_file is not None:
        head = head.by_file(_settings_in(settings_file), _given)
    return head if card_file is None else head.by_card(_opened(card_file), _given)


def _cutter(diameter_mm: float, side: CutterSide) -> Cutter:
    """The cutter."""
    from morfax.tracer.cutter.cutter import Cutter

    return Cutter(diameter_mm, side)


def _opened(card_file: FilePath) -> Card:
    """The card; raises CardFault for a mistake on it."""
    from morfax.tracer.operator.card import Card

    return Card.open(card_file)


def _settings_in(settings_file: FilePath) -> dict[str, float]:
    """Settings by name; raises CardFault for a mistake."""
    from morfax.tracer.operator.settings_file import read_changes

    return read_changes(settings_file)


def _print_settings(head: Head) -> NoReturn:
    """Print the settings of the head as a file that can be given again, and end."""
    from morfax.tracer.operator.settings_file import as_toml

    click.echo(as_toml(head.settings()), nl=False)
    raise click.exceptions.Exit


def _given(option: str) -> bool:
    """Whether an option was given on the command line."""
    return (
        click.get_current_context().get_parameter_source(option) is ParameterSource.COMMANDLINE
    )
