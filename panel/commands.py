"""What the panel asks of the command line: its fields, and the jobs that words make.

Signals: options as text in ("--width": "120mm"); words as one would type them, and jobs, out. The parser is
the command line's own, handed in by the verb: what the page refuses is what a terminal refuses, in the same
words.

Questions: options that name files (--card, --settings, a machine's file) hold the name of a file that was
given to the page (see `own_files`), which is no path: it becomes one when words are made.
"""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Literal, Protocol

if TYPE_CHECKING:
    from morfax.jobs.correct import CorrectJob
    from morfax.jobs.lines import LinesJob
    from morfax.jobs.play import PlayJob
    from morfax.jobs.run import RunJob
    from morfax.jobs.trace import TraceJob

Options = Mapping[str, str | bool]

# the options that the page has, in the order of the work; the first of each group stand open
OFFERED: dict[str, tuple[str, ...]] = {
    "Drawing": (
        "--width",
        "--dpi",
        "--known",
        "--flatten",
        "--bar",
        "--page",
        "--ink",
        "--edge",
    ),
    "Line": (
        "--lines",
        "--start",
        "--direction",
        "--arrow",
        "--order",
        "--gap",
        "--recatch",
        "--line-width",
        "--reference-point",
    ),
    "Machine": ("--machine", "--feed", "--plunge", "--rapid", "--zero"),
    "Tool": ("--cutter", "--side", "--depth", "--clearance"),
    "Cutting": (
        *(
            "--climb",
            "--conventional",
            "--lead-in",
            "--lead-out",
            "--start-at",
            "--step-down",
            "--ramp",
        ),
        *("--tabs", "--tab-width", "--tab-height", "--peck"),
    ),
    "Head": ("--speed", "--head", "--settings"),
    "Card": ("--card", "--stop-override", "--marks"),
    "Placement": (
        "--mirror",
        "--scale",
        "--turn",
        "--about",
        "--pickup",
        "--plain",
        "--fit-tolerance",
        "--lines-only",
    ),
}
OF_DRAWING = (*OFFERED["Drawing"], "--line-width", "--gap")  # that `morfax lines` takes as well
# that only G-code and plotters take
FOR_MACHINES = "--machine", "--feed", "--plunge", "--rapid"
FOR_TAPES = ("--pickup", "--plain")
FOR_FITS = ("--fit-tolerance", "--lines-only")
PAIRS = ("--known",)  # several words in one field
MANY = ("--arrow",)  # several times, with ; between them in one field
OWN_FILES = ("--card", "--settings", "--machine")  # that a page may be given


@dataclass(frozen=True, slots=True)
class OptionField:
    """An option as the page shows it."""

    option: str
    group: str
    kind: Literal["text", "choice", "switch", "file"]
    help: str
    choices: tuple[str, ...] = ()


class CommandLine(Protocol):
    """The command line's parser: it raises WrongUse in one line for what a terminal would refuse."""

    def fields(self) -> list[OptionField]:
        """The options that the page offers, in their order."""

    def lines(self, words: list[str]) -> LinesJob:
        """The job of `morfax lines WORDS`."""

    def run(self, words: list[str]) -> RunJob:
        """The job of `morfax run WORDS`."""

    def trace(self, words: list[str]) -> TraceJob:
        """The job of `morfax trace WORDS`."""

    def correct(self, words: list[str]) -> CorrectJob:
        """The job of `morfax correct WORDS`."""

    def play(self, words: list[str]) -> PlayJob:
        """The job of `morfax play WORDS`."""


def lines_words(drawing: FilePath, options: Options) -> list[str]:
    """The words after `morfax lines`."""
    return [str(drawing), *_words(options, only=OF_DRAWING)]


def run_words(drawing: FilePath, options: Options, folder: FilePath) -> list[str]:
    """The words after `morfax run`; without a machine it makes a tape."""
    program = FilePath("x.ngc" if "--machine" in options else "x.wav")
    return [str(drawing), *_words(_fitting(options, program)), "-o", str(folder)]


def trace_words(drawing: FilePath, options: Options, program: FilePath) -> list[str]:
    """The words after `morfax trace` that write a program, without the options that it does not take."""
    return [str(drawing), *_words(_fitting(options, program)), "-o", str(program)]


def correct_words(drawing: FilePath, options: Options, asked: list[str]) -> list[str]:
    """The words after `morfax correct`: what is put right, on the drawing as it is read."""
    of_drawing = tuple(name for name in OFFERED["Drawing"] if name != "--edge")
    return [str(drawing), *_words(options, only=of_drawing), *asked]


def play_words(program: FilePath, made_by: list[str], override: float) -> list[str]:
    """The words after `morfax play` that run a program at an override, 1 being the program's own feed; the
    machine is that of the words that made it.
    """
    at = made_by.index("--machine") if "--machine" in made_by else None
    of_machine = [] if at is None else made_by[at : at + 2]
    return [str(program), *of_machine, "--feed-override", f"{100 * override:g}%"]


def as_typed(verb: str, words: list[str]) -> str:
    """The command as one types it."""
    return shlex.join(["morfax", verb, *words])


def _fitting(options: Options, program: FilePath) -> Options:
    """The options that this program takes."""
    suffix = program.suffix.lower()
    is_tape, is_drawn = suffix == ".wav", suffix in (".dxf", ".svg")
    out: tuple[str, ...] = ()
    if is_tape or is_drawn or suffix == ".csv":
        out += FOR_MACHINES
    if not is_tape:
        out += FOR_TAPES
    if is_tape or suffix == ".csv":
        out += FOR_FITS
    return {name: value for name, value in options.items() if name not in out}


def _words(options: Options, only: tuple[str, ...] | None = None) -> list[str]:
    """Options as words, in the order in which the page has them."""
    words = list[str]()
    for name in (name for group in OFFERED.values() for name in group):
        if only is None or name in only:
            words += _option_words(name, options.get(name))
    return words


def _option_words(name: str, value: str | bool | None) -> list[str]:
    """One option as words; none if it is not given."""
    if value is None or value is False:
        return []
    if value is True:
        return [name]
    if name in MANY:
        return [word for one in value.split(";") for word in (name, *one.split())]
    return [name, *(value.split() if name in PAIRS else [value])]
