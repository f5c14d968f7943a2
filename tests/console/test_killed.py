"""kill -9 at random moments of every verb that writes: no half file under a final name, and the next run is
not disturbed.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

RUN = "import sys; from morfax.console.cli import main; sys.exit(main(sys.argv[1:]))"
CAM = Path(__file__).parents[2] / "samples" / "cam.png"
MOMENTS = 20 if os.environ.get("MORFAX_SOAK") else 2

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs kill -9")


def words_of(verb: str, tape: Path, path: Path) -> list[str]:
    """A command line whose results are all in the current folder."""
    return {
        "trace": ["trace", str(CAM), "-o", "a.wav", "--path", "a.csv", "--picture", "a.png"],
        "play": ["play", str(tape), "-o", "a.csv", "-o", "a.svg", "-o", "a.png"],
        "record": ["record", str(path), "-o", "a.wav"],
        "age": ["age", str(tape), "-o", "a.wav", "--preset", "cassette"],
        "mend": ["mend", str(tape), "-o", "a.wav"],
    }[verb]


def started(words: list[str], folder: Path) -> subprocess.Popen[bytes]:
    """A run in a process of its own."""
    return subprocess.Popen(
        [sys.executable, "-c", RUN, *words, "--quiet"],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def results(folder: Path) -> dict[str, bytes]:
    """What stands under a final name."""
    return {
        file.name: file.read_bytes()
        for file in folder.iterdir()
        if not file.name.startswith(".")
    }


@pytest.mark.parametrize("verb", ["trace", "play", "record", "age", "mend"])
def test_kill_9_leaves_no_half_file(
    tmp_path: Path, tape_file: Path, path_file: Path, verb: str
) -> None:
    words, folder = words_of(verb, tape_file, path_file), tmp_path / "work"
    folder.mkdir()
    assert started(words, folder).wait() == 0  # kernels are compiled by now
    whole = results(folder)
    begun = time.monotonic()
    assert started(words, folder).wait() == 0  # and over what stands there, as the runs below
    lasts_s = time.monotonic() - begun
    for share in np.random.default_rng(9).uniform(0.3, 1.05, MOMENTS):
        with started(words, folder) as run:
            time.sleep(share * lasts_s)
            run.kill()
        found = results(folder)
        assert [name for name in found if found[name] != whole.get(name)] == []
        for file in folder.iterdir():
            if not file.name.startswith("."):
                file.unlink()
    assert started(words, folder).wait() == 0
    assert results(folder) == whole
