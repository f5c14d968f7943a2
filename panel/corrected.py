"""Corrections at the panel: what a page marks on the sheet becomes words of `morfax correct`, and the file
beside the drawing.

Signals in: a kind and places in pixels of the picture, from its upper left corner. Signals out: words; the
text of the file `NAME.morfax.toml`, which the history keeps with each step, so that undo lays the former
one beside the drawing again.
"""

from __future__ import annotations

import math
from pathlib import Path as FilePath
from typing import Any

from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import FileFault
from morfax.motion.files import written_beside

ALONG = {
    "rub": ("--rub", "--rubber"),
    "bridge": ("--bridge", "--pen"),
}  # and the option of their width
TURNS = ("straight", "left", "right")
AT_PLACES = ("stop", "drill", "not-stop")
KINDS = (*ALONG, *TURNS, *AT_PLACES)
MOST_PLACES = 200  # of one stroke of the rubber
LONGEST_WIDTH = 20  # characters


def asked_words(action: dict[str, Any]) -> list[str]:
    """The words of a correction that a page asks for; raises WrongUse for one that is none."""
    if "remove" in action:
        return ["--remove", str(_number(action["remove"]))]
    kind = action.get("as")
    at = _places(action.get("at"))
    width = action.get("width")
    if kind in TURNS:
        return ["--turn", str(kind), at[0]]
    if kind in AT_PLACES:
        return [f"--{kind}", at[0]]
    if kind not in ALONG:
        raise WrongUse(
            f"there is no correction {str(kind)[:40]!r}; it may be {', '.join(KINDS)}"
        )
    option, of_width = ALONG[kind]
    if width is None:
        return [option, " ".join(at)]
    if not isinstance(width, str) or len(width) > LONGEST_WIDTH or width.startswith("-"):
        raise WrongUse(f"{str(width)[:40]!r} is no width; give one such as 2mm")
    return [option, " ".join(at), of_width, width]


def corrections_text(drawing: FilePath | None) -> str:
    """The text of the corrections beside a drawing; empty without any."""
    if drawing is None:
        return ""
    try:
        return _file(drawing).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return ""


def lay_corrections(drawing: FilePath, text: str) -> None:
    """Have the file beside a drawing hold this text; without text there is no file."""
    file = _file(drawing)
    if text == corrections_text(drawing):
        return
    if text:
        with written_beside(file) as beside:
            beside.write_text(text, encoding="utf-8")
        return
    try:
        file.unlink(missing_ok=True)
    except OSError as error:
        raise FileFault(
            f"cannot take {file} away: {error.strerror}; check the folder"
        ) from None


def _file(drawing: FilePath) -> FilePath:
    """The name of the file of corrections."""
    from morfax.tracer.corrections import beside

    return beside(drawing)


def _places(at: Any) -> list[str]:
    """Places as the command line takes them; raises WrongUse where there are none, or too many."""
    if not isinstance(at, list) or not 0 < len(at) <= MOST_PLACES:
        came = len(at) if isinstance(at, list) else "none"
        raise WrongUse(
            f"a correction has 1 to {MOST_PLACES} places, and {came} came; drag a shorter way"
        )
    return [_place(place) for place in at]


def _place(place: Any) -> str:
    """A place in pixels."""
    is_pair = isinstance(place, list) and len(place) == 2
    if not is_pair or not all(isinstance(v, int | float) and math.isfinite(v) for v in place):
        raise WrongUse(f"{str(place)[:40]} is no place; it has a column and a row in pixels")
    return ",".join(f"{v:.1f}px" for v in place)


def _number(number: Any) -> int:
    """The number of a correction."""
    if isinstance(number, bool) or not isinstance(number, int) or number < 1:
        raise WrongUse(
            f"{str(number)[:40]!r} is no number of a correction; they are counted from 1, as in the list"
        )
    return number
