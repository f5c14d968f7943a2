"""Targets: right files and the readers that must read them, or refuse them with a fault, after any change.

    text       a tape's text chunk, card, settings, corrections, machine, batch's manifest, paths
    programs   .steps, .cubic, .ngc
    tapes      a moment of tape in five kinds of sound file, and one through a pipe
    drawings   PNG, JPEG, TIFF and PDF of a ring, as `trace` opens them; SVG and DXF of a square

Questions: none.
"""

from __future__ import annotations

import io
import json
import re
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path

import numpy as np

from morfax.batch.manifest import NAME as MANIFEST
from morfax.batch.manifest import rows
from morfax.batch.row import BatchRow
from morfax.motion.motion import Motion
from morfax.motion.motion import Path as Course
from morfax.motion.pathfile import read_path, write_path
from morfax.player.gcode.machine_reader import read_program
from morfax.recorder.cubics.file import read_program as read_cubic
from morfax.recorder.gcode.machine import as_toml, machine
from morfax.recorder.media import read_outline, record
from morfax.recorder.sound.pipe import PipeSource
from morfax.recorder.steps.file import read_program as read_steps
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.tape.tape import Tape
from morfax.recorder.tape.tape import record as record_tape
from morfax.tracer.corrections.correction_file import read_corrections
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator import settings_file
from morfax.tracer.operator.card import Card

Reader = Callable[[Path], object]
Target = tuple[bytes, Callable[[bytes], object]]
CARD = b"""start = "2mm"
passes = ["2mm", "4mm"]
restart = "automatic"
turns = ["straight", "left"]
override = [3]

[speeds]
trace = "10mm/s"
feed = "300mm/min"

[[stop]]
number = 1
moves = [
    { down = "7mm", feed = "2mm/s" },
    { dwell = "500ms" },
    { up = "7mm" },
]
"""
CORRECTIONS = b"""[drawing]
name = "ring.png"
pixels = [120, 100]

[[correction]]
do = "bridge"
at = ["12px,14px", "50px,10px"]
why = "the pen skipped"

[[correction]]
do = "rub"
at = "10mm,12mm"
width = "3mm"

[[correction]]
do = "straight"
at = "12px,30px"
from = "8px,30px"
"""
DPI = 100.0  # of the small drawings


def targets(folder: Path) -> Iterator[tuple[str, Target]]:
    """All targets: name, a right file, the reader; files are written into the folder."""
    yield from _texts(folder)
    yield from _programs(folder)
    yield from _drawings(folder)
    yield from _tapes(folder)


def _texts(folder: Path) -> Iterator[tuple[str, Target]]:
    """What is kept as text."""
    chunk = TapeFormat(end_mm=(1.0, 2.0, 3.0)).to_json().encode()
    yield (
        "chunk",
        (chunk, lambda data: TapeFormat.from_json(data.decode("utf-8", "replace"))),
    )
    yield "card", (CARD, _by_file(folder / "input.toml", Card.open))
    settings = settings_file.as_toml(Settings()).encode()
    reads_settings = _by_file(folder / "input.toml", settings_file.read_changes)
    yield "settings", (settings, reads_settings)
    corrections = _by_file(folder / "input.morfax.toml", read_corrections)
    yield "corrections", (CORRECTIONS, corrections)
    grbl = as_toml("grbl-router").encode()
    yield "machine", (grbl, _by_file(folder / "input.toml", lambda file: machine(str(file))))
    row = BatchRow("a.png", "done", "0123abcd" * 8, "a", seconds=1.5, figures={"rms_um": 2.0})
    manifest = (json.dumps(row.as_plain()) + "\n").encode() * 3
    reads_rows = _by_file(folder / MANIFEST, lambda file: list(rows(file.parent)))
    yield "manifest", (manifest, reads_rows)
    write_path(_course(), folder / "right.csv")
    path = (folder / "right.csv").read_bytes()
    yield "path", (path, _by_file(folder / "input.csv", read_path))


def _programs(folder: Path) -> Iterator[tuple[str, Target]]:
    """What a machine plays."""
    for suffix, read in (
        (".steps", read_steps),
        (".cubic", read_cubic),
        (".ngc", read_program),
    ):
        whole = folder / f"right{suffix}"
        record(_course(), whole)
        # without its check sum, by which all changes would be refused alike
        right = re.sub(rb"\(crc32 .*\)\n| crc32 .*", b"", whole.read_bytes())
        yield suffix[1:], (right, _by_file(folder / f"input{suffix}", read))


def _drawings(folder: Path) -> Iterator[tuple[str, Target]]:
    """What is traced, and drawings from CAD."""
    from PIL import Image

    ring = Image.fromarray(_ring())
    for kind in ("PNG", "JPEG", "TIFF", "PDF"):
        held = io.BytesIO()
        ring.save(held, kind, **({"resolution": DPI} if kind == "PDF" else {"dpi": (DPI, DPI)}))
        opened = _by_file(
            folder / f"input.{kind.lower()}", lambda file: Drawing.open(file, DPI)
        )
        yield kind.lower(), (held.getvalue(), opened)
    for suffix in (".svg", ".dxf"):
        whole = folder / f"right{suffix}"
        record(_course(), whole)
        yield (
            suffix[1:],
            (whole.read_bytes(), _by_file(folder / f"input{suffix}", read_outline)),
        )


def _tapes(folder: Path) -> Iterator[tuple[str, Target]]:
    """A moment of tape in every kind of sound file, from a disk and through a pipe."""
    fmt, motion = TapeFormat(dwell_s=0.0), Motion(np.zeros((4, 3)))
    for suffix in (".wav", ".rf64", ".w64", ".aiff", ".flac"):
        whole = folder / f"right{suffix}"
        record_tape(motion, whole, fmt)
        right, name = whole.read_bytes(), f"tape-{suffix[1:]}"
        yield name, (right, _by_file(folder / f"input{suffix}", _play_file))
        if suffix == ".wav":
            yield "pipe", (right, lambda data: _played(Tape.of(PipeSource(io.BytesIO(data)))))


def _play_file(file: Path) -> None:
    """Read a tape in a file; not every kind of file has room for the text that says its format."""
    by_hand = {} if file.suffix == ".wav" else {"reference_hz": 6000.0, "cycles_per_mm": 20.0}
    _played(Tape.open(file, **by_hand))


def _played(opened: Tape) -> None:
    """Read some blocks of a tape, and close it."""
    with opened as tape:
        list(islice(tape.blocks(1000), 20))


def _by_file(file: Path, read: Reader) -> Callable[[bytes], object]:
    """A reader of files as one of bytes."""

    def reads(data: bytes) -> object:
        file.write_bytes(data)
        return read(file)

    return reads


def _course() -> Course:
    """A square of 5 mm, in the work, with a way down and up."""
    corners = [[0, 0, 2], [0, 0, -1], [5, 0, -1], [5, 5, -1], [0, 5, -1], [0, 0, -1], [0, 0, 2]]
    return Course(np.arange(7.0), np.array(corners, float))


def _ring() -> np.ndarray:
    """Grey levels of a ring of 20 mm, 100 x 120 pixels."""
    y, x = np.mgrid[:100, :120]
    off = np.abs(np.hypot(x - 60, y - 50) - 40)
    return np.asarray(255 * np.clip((off - 1.5) / 1.5, 0, 1), np.uint8)
