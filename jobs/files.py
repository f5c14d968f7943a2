"""The files that lie on the desk: which kind each is, how it is opened, and where results may go.

A file's kind is read off its first bytes, and off its name where they say nothing:

    tape      RIFF, RF64, fLaC, FORM, riff  or  .wav .rf64 .flac .aiff .w64
    program   any other text              and .steps .cubic .ngc
    drawing   PNG, JPEG, TIFF, BMP, …     or  .png .jpg .tif …
    path      any other text              or  .csv

A name that was given for a result is written over; a name that morfax made up is not, unless --force says so.
A result never goes over the file that it is made from.
"""

from __future__ import annotations

import os
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Literal

import click

from morfax.motion.faults import FileFault
from morfax.reports.table import Figures

if TYPE_CHECKING:
    from morfax.recorder.media import Report

Kind = Literal["tape", "program", "drawing", "path"]

TAPES = (".wav", ".rf64", ".flac")

FILE = click.Path(path_type=FilePath)

_FIRST_BYTES: dict[bytes, Kind] = {
    b"RIFF": "tape",
    b"RF64": "tape",
    b"fLaC": "tape",
    b"FORM": "tape",
    b"riff": "tape",
    b"\x89PNG": "drawing",
    b"\xff\xd8\xff": "drawing",
    b"II*\0": "drawing",
    b"MM\0*": "drawing",
    b"BM": "drawing",
    b"GIF8": "drawing",
}
_SUFFIXES: dict[str, Kind] = {
    **dict.fromkeys((".wav", ".rf64", ".flac", ".w64", ".aiff", ".aif"), "tape"),
    **dict.fromkeys((".steps", ".cubic", ".ngc"), "program"),
    **dict.fromkeys(
        (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".gif", ".webp", ".pgm"), "drawing"
    ),
    **dict.fromkeys((".csv", ".txt", ".tsv"), "path"),
}


def kind_of(file: FilePath) -> Kind:
    """Tell which kind of file this is; raises FileFault if it cannot be read or is of no kind that is known."""
    try:
        with file.open("rb") as opened:
            first = opened.read(1024)
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from error
    if first[:4] == b"RIFF" and first[8:12] == b"WEBP":
        return "drawing"
    by_bytes = next(
        (kind for magic, kind in _FIRST_BYTES.items() if first.startswith(magic)), None
    )
    kind = by_bytes or _SUFFIXES.get(file.suffix.lower())
    if kind is None and b"\0" in first:
        raise FileFault(
            f"{file} is no path file, no tape and no image that is known; give a .csv, a .wav or a .png"
        )
    return kind or "path"


def outgoing(file: FilePath, *made_from: FilePath) -> FilePath:
    """Make sure, before the work starts, that a result can go under this name; raises FileFault if not."""
    folder = file.parent
    if not folder.is_dir():
        raise FileFault(
            f"cannot write {file}: there is no folder {folder}; make it first, or give another name"
        )
    if file.is_dir():
        raise FileFault(f"cannot write {file}: it is a folder; give the name of a file")
    if not os.access(folder, os.W_OK):
        raise FileFault(
            f"cannot write {file}: the folder {folder} may not be written to; give another name"
        )
    if any(file.exists() and source.exists() and file.samefile(source) for source in made_from):
        raise FileFault(
            f"cannot write {file}: the result would go over the file it is made from; give another name"
        )
    return file


def made_up(name: FilePath, *made_from: FilePath, force: bool) -> FilePath:
    """A name that nobody gave, for a result in the current folder; raises FileFault if it is taken and not
    `force`.
    """
    if name.exists() and not force:
        raise FileFault(
            f"{name} is there already; give a name with -o, or --force to write over it"
        )
    return outgoing(name, *made_from)


def called(file: FilePath) -> str:
    """What a program is called in the figures: a tape, or a program in another medium."""
    return "program" if _SUFFIXES.get(file.suffix.lower()) == "program" else "tape"


def told(report: Report) -> Figures:
    """What a recorder tells of its program beyond size and time, where it tells more."""
    figures: Figures = getattr(report, "figures", {})
    return figures


def incomplete(file: FilePath) -> FilePath:
    """The name for a result that a fault has cut short."""
    return file.with_name(f"{file.stem}.incomplete{file.suffix}")


def with_suffix_in(file: FilePath, suffixes: tuple[str, ...], option: str = "-o") -> FilePath:
    """The file itself if its name ends in one of the suffixes; else wrong use of the command line."""
    if file.suffix.lower() not in suffixes:
        raise click.BadParameter(
            f"{str(file)!r} must end in {', '.join(suffixes)}", param_hint=f"'{option}'"
        )
    return file
