"""The order of a batch: what is done with every drawing, and the fingerprint by which its result is known.

Signals in: the settings of `morfax trace`, the same for all drawings. Signals out: the name of a drawing's
folder: its stem, and the first digits of a SHA-256 over

    version · settings · files that the settings name · the drawing's bytes · its corrections' bytes

Source: our own. Questions: a page that a drawing links to is not read; no format that is taken has such.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cached_property
from importlib.metadata import version
from pathlib import Path
from typing import Any

from morfax.jobs.machine.recording import RecordingUnit
from morfax.jobs.settings.correction_settings import sha256_of
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.settings import TraceSettings

PROGRAM = Path("program.ngc")  # G-code is about a hundredth of a tape's size
HASH_DIGITS = 12  # of 64: among a million drawings two are alike once in 500 batches
STEM_BYTES = 100  # of a drawing's name that its folder has; file systems take 255


@dataclass(frozen=True)
class Order:
    """What is done with every drawing; `drawing` says how it is read, its file is another one each time."""

    drawing: DrawingFile = field(default_factory=lambda: DrawingFile(Path()))
    settings: TraceSettings = field(default_factory=TraceSettings)
    unit: RecordingUnit = field(default_factory=RecordingUnit)
    program: Path = PROGRAM  # name of the program in each folder; its suffix says the medium
    force: bool = False  # do what is there already

    def folder_name(self, file: Path) -> tuple[str, str]:
        """The name of a drawing's folder, and the whole hash; raises FileFault if it cannot be read."""
        sums = [self._told, sha256_of(file)]
        corrections = self.drawing.corrections.found(file)
        if corrections is not None:
            sums.append(sha256_of(corrections))
        hashed = hashlib.sha256("\n".join(sums).encode()).hexdigest()
        stem = os.fsencode(file.stem)[:STEM_BYTES].decode(errors="ignore")
        return f"{stem}-{hashed[:HASH_DIGITS]}", hashed

    @cached_property
    def _told(self) -> str:
        """Version and settings as one text."""
        parts = (self.drawing, self.settings, self.unit, str(self.program))
        return "\n".join((version("morfax"), *(word for part in parts for word in _told(part))))


def _told(value: Any) -> Iterator[str]:
    """A value as words that are the same on every computer; a file as the sum of what is in it."""
    if is_dataclass(value):
        for entry in fields(value):
            yield entry.name
            yield from _told(getattr(value, entry.name))
    elif isinstance(value, tuple):
        yield f"{len(value)}"
        for part in value:
            yield from _told(part)
    elif isinstance(value, Path) or (isinstance(value, str) and value.endswith(".toml")):
        yield sha256_of(Path(value)) if Path(value).is_file() else str(value)
    else:
        yield repr(value)
