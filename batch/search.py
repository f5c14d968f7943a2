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

from morfax.jobs.files import kind_by_name
from morfax.motion.faults import FileFault

ANY = "**/*"


def is_address(place: str) -> bool:
    """Whether a place is an address for fsspec, and not a folder of this computer."""
    return "://" in place


def drawings(
    place: str, pattern: str | None = None, beside: Path | None = None
) -> Iterator[str]:
    """The drawings below a folder whose path there fits the pattern (**, * and ?); without a pattern all
    files whose suffix is a drawing's. Hidden folders, and the folder `beside`, are passed over.

    Raises FileFault if the folder cannot be read.
    """
    fits = re.compile(_expression(pattern or ANY)).fullmatch
    found = _of_address(place) if is_address(place) else _of_folder(Path(place), "", beside)
    for name, within in found:
        if fits(within) and (pattern is not None or kind_by_name(Path(name)) == "drawing"):
            yield name


def _of_folder(folder: Path, within: str, beside: Path | None) -> Iterator[tuple[str, str]]:
    """The files below a folder, and their paths in it."""
    try:
        entries = os.scandir(folder)
    except OSError as error:
        raise FileFault(
            f"the folder {folder} cannot be read: {error.strerror}; check the name"
        ) from None
    with entries:
        for entry in entries:
            if entry.name.startswith("."):
                continue
            if not entry.is_dir():
                yield entry.path, within + entry.name
            elif beside is None or not beside.exists() or not beside.samefile(entry.path):
                yield from _of_folder(Path(entry.path), f"{within}{entry.name}/", beside)


def _of_address(place: str) -> Iterator[tuple[str, str]]:
    """The files below an address, and their paths there."""
    from fsspec.core import url_to_fs

    system, root = url_to_fs(place)
    for folder, _, files in system.walk(root):
        for name in files:
            path = f"{folder.rstrip('/')}/{name}"
            within = path.removeprefix(root).lstrip("/")
            yield system.unstrip_protocol(path), within


def _expression(pattern: str) -> str:
    """A pattern as a regular expression: ** is any folders, * and ? stay within one name."""
    parts = {"**/": "(?:.*/)?", "**": ".*", "*": "[^/]*", "?": "[^/]"}
    words = re.split(r"(\*\*/|\*\*|\*|\?)", pattern)
    return "".join(parts.get(word, re.escape(word)) for word in words)
