"""Fuzz the tape reader, the pipe and the text chunk with atheris: `python -m fuzz.tapes -runs=1000000`.

The first inputs are whole tapes of a moment, in every kind of file, and their text: changes of these get
past the first bytes. Every input must be read, or end in a fault of the domain. Any other exception, 2 s
of work or 1 GB of memory ends the run and keeps the input in a file (`make fuzz` sets `-timeout=2
-rss_limit_mb=1024`).
"""

from __future__ import annotations

import io
import os
import sys
import tempfile
from itertools import islice
from pathlib import Path

import atheris
import numpy as np

os.environ["NUMBA_DISABLE_JIT"] = "1"  # numba cannot compile code that atheris has instrumented

with atheris.instrument_imports(include=["morfax.recorder", "morfax.motion.faults"]):
    from morfax.motion.faults import Fault
    from morfax.motion.motion import Motion
    from morfax.recorder.sound.pipe import PipeSource
    from morfax.recorder.tape.format import TapeFormat
    from morfax.recorder.tape.tape import Tape, record

TEXT, PIPE, TAPE = b"\0", b"\x60", b"\xff"  # first bytes
FILE = Path(tempfile.mkdtemp(prefix="morfax-fuzz-")) / "fuzz.wav"


def seeds(folder: Path) -> None:
    """Write the first inputs into a folder."""
    fmt, motion = TapeFormat(dwell_s=0.0), Motion(np.zeros((4, 3)))
    (folder / "text").write_bytes(TEXT + fmt.to_json().encode())
    for suffix in (".wav", ".rf64", ".w64", ".aiff", ".flac"):
        for sample in ("16", "24"):
            whole = folder.parent / f"seed{suffix}"
            record(motion, whole, fmt, sample=sample)
            for first, name in ((TAPE, "file"), (PIPE, "pipe")):
                (folder / f"{name}-{sample}{suffix}").write_bytes(first + whole.read_bytes())


def one(data: bytes) -> None:
    """Try one input on the reader that its first byte chooses."""
    kind, body = data[:1], data[1:]
    try:
        if kind < b"\x55":
            TapeFormat.from_json(body.decode("utf-8", "replace"))
        elif kind < b"\xaa":
            pipe_source = PipeSource(io.BytesIO(body))
            with Tape.of(pipe_source, reference_hz=6000, cycles_per_mm=20) as pipe:
                list(islice(pipe.blocks(1000), 20))
        else:
            FILE.write_bytes(body)
            with Tape.open(FILE, reference_hz=6000, cycles_per_mm=20) as tape:
                list(islice(tape.blocks(1000), 20))
    except Fault:
        pass


if __name__ == "__main__":
    corpus = FILE.parent / "corpus"
    corpus.mkdir()
    seeds(corpus)
    atheris.Setup([*sys.argv, str(corpus)], one)
    atheris.Fuzz()
