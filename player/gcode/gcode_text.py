"""The text of a program in a file: its bytes as characters, its comments and its words told apart, its check
sum held against it.

Signals in: a file. Signals out: its text, whose words are ASCII; patterns of a word and of a comment.

Source: RS-274-D. Questions: none of the controls that we write for says in what code comments are; both
UTF-8 and one byte to a character are read.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path as FilePath

from morfax.motion.faults import FileFault, ProgramFault
from morfax.recorder.gcode.check_sum import demand_right

BYTE_ORDER_MARK = "\ufeff"
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)"
WORD = re.compile(f"([A-Z])({_NUMBER})")
# a line of its own before all words, as LinuxCNC and Fanuc have it
PROGRAM_NUMBER = re.compile(r"O\d+")
COMMENT = re.compile(r"\([^()]*\)|;.*")


def text_of(file: str | os.PathLike[str]) -> str:
    """The text of a program; raises ProgramFault (no text, a wrong check sum), FileFault (unreadable).

    Comments may hold what they like, in UTF-8 or with a byte to a character; all else is ASCII.
    """
    try:
        raw = FilePath(file).read_bytes()
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from error
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    if not text.isascii():
        _demand_ascii_words(text.split("\n"), str(file))
    demand_right(text, str(file))
    return text


def _demand_ascii_words(lines: Sequence[str], name: str) -> None:
    """Raise ProgramFault for the first character outside of comments that is not one of ASCII."""
    for number, line in enumerate(lines, 1):
        if line.isascii() or (words := COMMENT.sub("", line)).isascii():
            continue
        at = next(character for character in words if not character.isascii())
        if at == BYTE_ORDER_MARK:
            raise ProgramFault(
                f"{name} begins with a byte-order mark, which controls refuse; save it as UTF-8 without one",
                line=number,
            )
        raise ProgramFault(
            f"{name}, line {number}: this is no text: {at!r} stands outside a comment; a program is lines"
            " such as G1 X10 Y5 F600, and letters such as ä may stand in ( ) or behind ;",
            line=number,
        )
