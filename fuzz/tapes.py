"""Fuzz the tape reader, the pipe and the text chunk with atheris: `python -m fuzz.tapes -runs=1000000`.

Every input must end as a fault of the domain or be taken; any other exception, 2 s of work or 1 GB of memory ends the run
with the input kept in a file (`-timeout=2 -rss_limit_mb=1024` are set by `make fuzz`).
"""

from __future__ import annotations

import io
import sys
import tempfile
from itertools import islice
from pathlib import Path

import atheris

with atheris.instrument_imports(include=["recorder", "motion.faults"]):
    from motion.faults import Fault
    from recorder.pipe import Pipe
    from recorder.tape import Tape
    from recorder.tapeformat import TapeFormat

FILE = Path(tempfile.mkdtemp(prefix="morfax-fuzz-")) / "fuzz.wav"


def one(data: bytes) -> None:
    """Try one input on a reader that its first byte chooses."""
    kind, body = data[:1], data[1:]
    try:
        if kind < b"\x55":
            TapeFormat.from_json(body.decode("utf-8", "replace"))
        elif kind < b"\xaa":
            with Pipe.open(io.BytesIO(body), reference_hz=6000, cycles_per_mm=20) as pipe:
                list(islice(pipe.blocks(1000), 20))
        else:
            FILE.write_bytes(body)
            with Tape.open(FILE, reference_hz=6000, cycles_per_mm=20) as tape:
                list(islice(tape.blocks(1000), 20))
    except Fault:
        pass


if __name__ == "__main__":
    atheris.Setup(sys.argv, one)
    atheris.Fuzz()
