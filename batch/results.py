"""Where results go: a folder for each drawing, whole or not there.

    out/manifest.jsonl        how each drawing ended
    out/STEM-HASH/            path.csv, the program, picture.png, figures.json
    out/.unfinished/          folders that are being written; those of processes that died are removed

Signals in: the files of one drawing. Signals out: the same under their final names. At an address (s3://,
file://) there is no renaming: `figures.json` comes last there, and a folder without it does not count.

Source: our own. Questions: none.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Protocol

from morfax.motion.faults import FileFault
from morfax.motion.files import clear_leftovers, folder_written_beside

FIGURES = "figures.json"
PATH, PICTURE = "path.csv", "picture.png"
UNFINISHED = ".unfinished"


class Results(Protocol):
    """A place for results."""

    def figures(self, name: str) -> Mapping[str, Any] | None:
        """What `figures.json` of a whole folder holds; None if there is no such folder."""

    def folder(self, name: str) -> Any:
        """A context that gives an empty folder to write into; it is kept if the context ends well."""


@dataclass(frozen=True)
class LocalResults:
    """Results in a folder of this computer."""

    out: Path

    def figures(self, name: str) -> Mapping[str, Any] | None:
        """What `figures.json` of a whole folder holds; None if there is no such folder."""
        try:
            return _figures((self.out / name / FIGURES).read_bytes())
        except OSError:
            return None

    @contextmanager
    def folder(self, name: str) -> Iterator[Path]:
        """Give a hidden folder, and rename it."""
        with folder_written_beside(self.out / name, self.out / UNFINISHED) as beside:
            yield beside

    def clear(self) -> None:
        """Remove what processes that died have left unfinished."""
        clear_leftovers(self.out / UNFINISHED)


@dataclass(frozen=True)
class RemoteResults:
    """Results at an address that fsspec knows."""

    address: str

    def figures(self, name: str) -> Mapping[str, Any] | None:
        """What `figures.json` of a whole folder holds; None if there is no such folder."""
        system, root = self._system()
        try:
            return _figures(system.cat_file(f"{root}/{name}/{FIGURES}"))
        except FileNotFoundError:
            return None

    @contextmanager
    def folder(self, name: str) -> Iterator[Path]:
        """Give a folder of this computer, and copy what is in it; figures.json last."""
        with TemporaryDirectory(prefix="morfax-") as beside:
            yield Path(beside)
            system, root = self._system()
            folder = f"{root}/{name}"
            system.makedirs(folder, exist_ok=True)
            if system.exists(f"{folder}/{FIGURES}"):  # what stood there no longer counts
                system.rm_file(f"{folder}/{FIGURES}")
            for file in sorted(Path(beside).iterdir(), key=lambda file: file.name == FIGURES):
                system.put_file(str(file), f"{folder}/{file.name}")

    def _system(self) -> tuple[Any, str]:
        """The file system of the address, and the folder there."""
        system, root = file_system(self.address)
        return system, root.rstrip("/")


def file_system(address: str) -> tuple[Any, str]:
    """The file system of an address, and the path there; raises FileFault if nothing knows it."""
    from fsspec.core import url_to_fs

    try:
        system, path = url_to_fs(address)
    except (ImportError, ValueError) as error:
        raise FileFault(
            f"{address} cannot be reached: {error}; give an address that fsspec knows here"
        ) from None
    return system, str(path)


def _figures(text: bytes) -> Mapping[str, Any] | None:
    """The figures of a text of JSON; None if it is none."""
    try:
        figures = json.loads(text)
    except ValueError:
        return None
    return figures if isinstance(figures, dict) else None
