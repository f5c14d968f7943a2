"""Tapes of three and six hours, the second beyond 4 GiB: written and played in bounded memory. Only with
MORFAX_SOAK=1.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
import soundfile

pytestmark = pytest.mark.skipif(
    not os.environ.get("MORFAX_SOAK"), reason="12 GB and some minutes; make soak"
)

MOST_MB = 300.0
RUN = """
import resource, sys, time
from benchmarks.tape import circles
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import record

begun = time.perf_counter()
file, hours = sys.argv[1], float(sys.argv[2])
recording = record(circles(hours * 3600), file)
written = time.perf_counter()
playback = play(file)
rows = sum(len(block.positions_mm) for block in playback)
played = time.perf_counter()
print(rows, abs(playback.end_error_mm).max(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
print(f"{hours:g} h: {recording.bytes / 2**30:.2f} GiB written in {written - begun:.0f} s, "
      f"played in {played - written:.0f} s", file=sys.stderr)
"""


@pytest.mark.parametrize(
    ("name", "hours", "kind"), [("a.wav", 3, "WAV"), ("b.wav", 6, "RF64"), ("c.w64", 6, "W64")]
)
def test_a_tape_of_hours_is_written_and_played(
    tmp_path: Path, name: str, hours: float, kind: str
) -> None:
    file = tmp_path / name
    try:
        told = subprocess.run(
            [sys.executable, "-c", RUN, str(file), str(hours)],
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        ).stdout
        assert soundfile.info(file).format == kind
    finally:
        file.unlink(missing_ok=True)
    rows, end_error_mm, memory_mb = (float(word) for word in told.split())
    print(f"{name}: {memory_mb:.0f} MB, end {end_error_mm * 1e6:.1f} nm off")
    assert rows == (hours * 3600 + 2) * 6000
    assert end_error_mm < 1e-5  # 10 nm: nothing drifts
    assert memory_mb < MOST_MB  # the whole process, Python and numba's compiler with it
