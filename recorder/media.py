"""The media: which recorder makes a program of which suffix.

Signals: a stream of Motion in, a program file out, and a report of what was recorded with its `bytes` and its
`duration_s`. A recorder is only imported when it is asked for; each has the signature

    record_xxx(stream, file, **settings) -> Report

Questions: none of the patents speaks of another's medium; that the suffix of the file tells which it is, is
this project's own rule.
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Protocol

from morfax.motion.faults import FileFault
from morfax.motion.motion import Motion, Path

if TYPE_CHECKING:
    from morfax.recorder.drawings.outline import CadOutline

Source = Iterable[Motion] | Motion | Path


class Report(Protocol):
    """What every recorder reports: size of the program file in bytes, and running time in s."""

    @property
    def bytes(self) -> int: ...

    @property
    def duration_s(self) -> float: ...


@dataclass(frozen=True, slots=True)
class Medium:
    """A medium: its description, and the recorder that writes it."""

    what: str
    module: str
    function: str

    def recorder(self) -> Callable[..., Report]:
        """Import the recorder."""
        recorder: Callable[..., Report] = getattr(
            importlib.import_module(self.module), self.function
        )
        return recorder


_TAPE = Medium("magnetic tape", "morfax.recorder.tape.tape", "record")

_BLOCKS = Medium("lines and arcs in RS-274", "morfax.recorder.gcode.blocks", "record_blocks")
_DRAWINGS = "morfax.recorder.drawings.drawings"
_PLOTTER = Medium("plotter file in HP-GL", "morfax.recorder.drawings.hpgl", "record_hpgl")

MEDIA: dict[str, Medium] = {
    ".wav": _TAPE,
    ".rf64": _TAPE,
    ".flac": _TAPE,
    ".steps": Medium(
        "punched tape of step vectors", "morfax.recorder.steps.steps", "record_steps"
    ),
    ".cubic": Medium("differences of cubics", "morfax.recorder.cubics.cubics", "record_cubics"),
    **dict.fromkeys((".ngc", ".nc", ".gcode", ".tap", ".cnc"), _BLOCKS),
}

# what other programs read; no control plays them
DRAWINGS: dict[str, Medium] = {
    ".dxf": Medium("drawing in DXF", _DRAWINGS, "record_dxf"),
    ".svg": Medium("drawing in SVG, true to size", _DRAWINGS, "record_svg"),
    ".plt": _PLOTTER,
    ".hpgl": _PLOTTER,
}

# how they are read back
_READERS = {
    ".dxf": ("morfax.recorder.drawings.dxf_outline", "read_dxf"),
    ".svg": ("morfax.recorder.drawings.svg_outline", "read_svg"),
}


def read_outline(file: str | os.PathLike[str], unit: str | None = None) -> CadOutline:
    """Read the lines of a drawing from CAD; with `unit` its figures are in that one, whatever it says.

    Raises DrawingFault for one that cannot be read or does not say its unit, FileFault.
    """
    module, function = _READERS[FilePath(file).suffix.lower()]
    read: Callable[..., CadOutline] = getattr(importlib.import_module(module), function)
    return read(FilePath(file), unit)


def record(stream: Source, file: str | os.PathLike[str], **settings: Any) -> Report:
    """Record a motion in the medium that the file's suffix names; the settings are that recorder's own.

    Raises FileFault for a suffix that names no medium, and whatever the recorder raises.
    """
    every = MEDIA | DRAWINGS
    medium = every.get(FilePath(file).suffix.lower())
    if medium is None:
        raise FileFault(f"{file} names no medium; its name must end in {', '.join(every)}")
    return medium.recorder()(stream, file, **settings)
