"""The drawings of a folder, one after the other, without a list of them.

Signals in: a folder, or an address that fsspec knows (s3://bucket/scans), and a pattern. Signals out: names,
in the order in which the file system has them: a million take no more memory than one.

Source: our own; `pathlib.Path.rglob` makes a list of each folder.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

from morfax.batch.results import FIGURES, file_system
from morfax.jobs.media.files import kind_by_name
from morfax.motion.faults import FileFault

ANY = "**/*"
FolderMark = tuple[
    int, int
]  # device and number of a folder, the same by whatever link it is reached


def is_address(place: str) -> bool:
    """Whether a place is an address for fsspec, and not a folder of this computer."""
    return "://" in place


def drawings(place: str, pattern: str | None = None) -> Iterator[str]:
    """The drawings below a folder whose path there fits the pattern (**, * and ?); without a pattern all
    files whose suffix is a drawing's. Passed over are hidden folders, and those that hold `figures.json`:
    the pictures of a batch are no drawings of the next.

    Raises FileFault if the folder cannot be read, or nothing knows the address.
    """
    fits = re.compile(_expression(pattern or ANY)).fullmatch
    found = _of_address(place) if is_address(place) else _of_folder(Path(place), "", ())
    for name, within in found:
        if fits(within) and (pattern is not None or kind_by_name(Path(name)) == "drawing"):
            yield name


def _of_folder(
    folder: Path, within: str, above: tuple[FolderMark, ...]
) -> Iterator[tuple[str, str]]:
    """The files below a folder, and their paths in it; a link to one of the folders above leads nowhere."""
    try:
        status = folder.stat()
        mark = status.st_dev, status.st_ino
        if mark in above or (within and (folder / FIGURES).exists()):
            return
        entries = os.scandir(folder)
    except OSError as error:
        raise FileFault(
            f"the folder {folder} cannot be read: {error.strerror}; check the name"
        ) from None
    with entries:
        for entry in entries:
            if entry.name.startswith("."):
                continue
            if entry.is_dir():
                yield from _of_folder(
                    Path(entry.path), f"{within}{entry.name}/", (*above, mark)
                )
            else:
                yield entry.path, within + entry.name


def _of_address(place: str) -> Iterator[tuple[str, str]]:
    """The files below an address, and their paths there."""
    system, root = file_system(place)
    for folder, _, files in system.walk(root):
        if FIGURES in files:
            continue
        for name in files:
            path = f"{folder.rstrip('/')}/{name}"
            within = path.removeprefix(root).lstrip("/")
            yield system.unstrip_protocol(path), within


def _expression(pattern: str) -> str:
    """A pattern as a regular expression: ** is any folders, * and ? stay within one name."""
    parts = {"**/": "(?:.*/)?", "**": ".*", "*": "[^/]*", "?": "[^/]"}
    words = re.split(r"(\*\*/|\*\*|\*|\?)", pattern)
    return "".join(parts.get(word, re.escape(word)) for word in words)
