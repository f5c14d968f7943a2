"""Files: which kind each is, and where results may go.

A file's kind is read off its first bytes, and off its name where the bytes say nothing:

    tape      RIFF, RF64, fLaC, FORM, riff  or  .wav .rf64 .flac .aiff .w64
    program   any other text              and .steps .cubic .ngc .nc .gcode .tap .cnc .plt .hpgl
    drawing   PNG, JPEG, TIFF, PDF, …     or  .png .jpg .tif .pdf .heic …
    outline                                   .dxf .svg
    path      any other text              or  .csv

A result is written over a file of a name that somebody gave; over a file of a name that morfax made up only
with --force. A result never goes over the file that it is made from.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path as FilePath
from typing import Literal

from morfax.jobs.figures import Figures
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import FileFault
from morfax.motion.files import HEAD_BYTES, check_name, check_regular

Kind = Literal["tape", "program", "drawing", "outline", "path"]

TAPES = (".wav", ".rf64", ".flac")  # that can be recorded
PATHS = (".csv",)
OUTLINES = (".dxf", ".svg")  # drawings from CAD
BLOCKS = (".ngc", ".nc", ".gcode", ".tap", ".cnc")  # G-code, RS-274
PLOTS = (".plt", ".hpgl")  # HP-GL
DRAWN = (*OUTLINES, *PLOTS)  # what other programs and plotters read
WITH_ARCS = (*BLOCKS, ".dxf", ".svg")

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
    b"%PDF": "drawing",
}
_SUFFIXES: dict[str, Kind] = {
    **dict.fromkeys((".wav", ".rf64", ".flac", ".w64", ".aiff", ".aif"), "tape"),
    **dict.fromkeys((".steps", ".cubic", *BLOCKS, *PLOTS), "program"),
    **dict.fromkeys(
        (
            *(".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".gif", ".webp", ".pgm"),
            *(".pdf", ".heic", ".heif", ".avif"),
        ),
        "drawing",
    ),
    **dict.fromkeys(OUTLINES, "outline"),
    **dict.fromkeys((".csv", ".txt", ".tsv"), "path"),
}


def kind_of(file: FilePath) -> Kind:
    """Tell which kind of file this is; raises FileFault if it cannot be read or is of no known kind."""
    check_regular(file)
    try:
        with file.open("rb") as opened:
            first = opened.read(HEAD_BYTES)
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from error
    if (first[:4], first[8:12]) == (b"RIFF", b"WEBP") or first[4:8] == b"ftyp":  # HEIC, AVIF
        return "drawing"
    of_bytes = (kind for magic, kind in _FIRST_BYTES.items() if first.startswith(magic))
    kind = next(of_bytes, None) or _SUFFIXES.get(file.suffix.lower())
    if kind is None and b"\0" in first:
        raise FileFault(
            f"{file} is no path file, no tape and no known image; give a .csv, a .wav or a .png"
        )
    return kind or "path"


def refuse_drawing(file: FilePath, kind: Kind | None) -> None:
    """Raise WrongUse for a scan or a photo where a program or a path is wanted."""
    if kind == "drawing":
        raise WrongUse(
            f"{file} is a drawing, and no program: `morfax trace {file.name}` makes one of it, `morfax run "
            f"{file.name}` plays it too"
        )


def kind_by_name(file: FilePath) -> Kind | None:
    """Which kind of file this is by its name alone; None if the suffix does not say."""
    return _SUFFIXES.get(file.suffix.lower())


def outgoing(file: FilePath, *made_from: FilePath) -> FilePath:
    """Check, before the work starts, that a result can go under this name; raises FileFault if not."""
    check_name(file)
    folder = file.parent
    if not folder.is_dir():
        raise FileFault(
            f"cannot write {file}: there is no folder {folder}; make it first, or give another name"
        )
    if file.is_dir():
        raise FileFault(f"cannot write {file}: it is a folder; give the name of a file")
    if not os.access(folder, os.W_OK):
        raise FileFault(
            f"cannot write {file}: you may not write to the folder {folder}; give another name"
        )
    if any(file.exists() and source.exists() and file.samefile(source) for source in made_from):
        raise FileFault(
            f"cannot write {file}: the result is made from this file and would replace it; "
            "give another name"
        )
    return file


def outgoing_together(files: Iterable[FilePath | None], *made_from: FilePath) -> None:
    """Check the names of a job's results; raises FileFault as `outgoing`, WrongUse for one file twice."""
    taken = dict[FilePath, FilePath]()
    for file in files:
        if file is None:
            continue
        place = outgoing(file, *made_from).resolve()
        if place in taken:
            raise WrongUse(
                f"{taken[place]} and {file} are one file, for two results; give each a name of its own"
            )
        taken[place] = file


def made_up(name: FilePath, *made_from: FilePath, force: bool) -> FilePath:
    """A name that nobody gave, for a result; raises FileFault if a file has it, unless `force`."""
    if name.exists() and not force:
        raise FileFault(
            f"{name} is there already; give a name with -o, or --force to write over it"
        )
    return outgoing(name, *made_from)


def is_tape(file: FilePath) -> bool:
    """Whether a program of this name is recorded on a magnetic tape."""
    return file.suffix.lower() in TAPES


def is_gcode(file: FilePath) -> bool:
    """Whether a program of this name is written as lines and arcs for a machine's control."""
    return file.suffix.lower() in BLOCKS


def is_plot(file: FilePath) -> bool:
    """Whether a file of this name is for a plotter."""
    return file.suffix.lower() in PLOTS


def is_outline(file: FilePath) -> bool:
    """Whether a file of this name is a drawing of lines, from CAD."""
    return file.suffix.lower() in OUTLINES


def has_machine(file: FilePath) -> bool:
    """Whether a program of this name is written in the words of a machine."""
    return is_gcode(file) or is_plot(file)


def called(file: FilePath) -> str:
    """What a result is called in the figures: a tape, a program in another medium, or a drawing."""
    if is_tape(file) or not file.suffix:  # a pipe, a device
        return "tape"
    if file.suffix.lower() in DRAWN:
        return "drawn"
    return "program" if _SUFFIXES.get(file.suffix.lower()) == "program" else "drawn"


def recorder_figures(report: object) -> Figures:
    """Figures of a recorder beyond size and time, where it has more."""
    figures: Figures = getattr(report, "figures", {})
    return figures


def incomplete(file: FilePath) -> FilePath:
    """The name for a result that a fault has cut short."""
    return file.with_name(f"{file.stem}.incomplete{file.suffix}")
