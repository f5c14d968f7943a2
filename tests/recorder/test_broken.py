"""Broken tapes: whatever bytes are changed or cut, the reader takes them or names the fault; and kill -9."""

from __future__ import annotations

import io
import json
import signal
import subprocess
import sys
import time
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
import soundfile
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from morfax.motion.faults import Fault, TapeFault
from morfax.motion.motion import Motion
from morfax.recorder.sound.pipe import PipeSource
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.tape.tape import Tape, record

BY_HAND = {"reference_hz": 6000.0, "cycles_per_mm": 20.0}
SLOW = settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])


def short_tape(folder: Path, name: str) -> bytes:
    """A tape of a moment."""
    record(Motion(np.zeros((60, 3))), folder / name, TapeFormat(dwell_s=0.01))
    return (folder / name).read_bytes()


@pytest.mark.parametrize("name", ["a.wav", "a.rf64", "a.flac", "a.aiff", "a.w64"])
@SLOW
@given(st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), max_size=12), st.floats(0, 1))
def test_a_broken_file_is_taken_or_told(
    tmp_path: Path, name: str, changes: list[tuple[float, int]], kept: float
) -> None:
    data = bytearray(short_tape(tmp_path, name))
    for at, byte in changes:
        data[int(at * min(len(data) - 1, 600))] = byte
    (tmp_path / name).write_bytes(
        bytes(data[: max(1, int(len(data) * (1 if kept > 0.5 else 2 * kept)))])
    )
    try:
        with Tape.open(tmp_path / name, **BY_HAND) as tape:
            list(islice(tape.blocks(1000), 20))
    except Fault as fault:
        assert "\n" not in str(fault)
    try:
        with Tape.of(PipeSource(io.BytesIO(bytes(data))), **BY_HAND) as pipe:
            list(islice(pipe.blocks(1000), 20))
    except Fault as fault:
        assert "\n" not in str(fault)


@settings(max_examples=300)
@given(
    st.recursive(
        st.none() | st.booleans() | st.floats() | st.text(),
        lambda inner: st.lists(inner),
        max_leaves=5,
    )
)
def test_nonsense_in_an_entry_is_told(value: object) -> None:
    good = json.loads(TapeFormat().to_json())
    for name in good:
        try:
            TapeFormat.from_json(json.dumps({**good, name: value}))
        except TapeFault as fault:
            assert "\n" not in str(fault) and len(str(fault)) < 400


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('{"version": 99, "what": 1}', "version 99; this program reads 3"),
        ('{"a": "' + "x" * 10_000_000 + '"}', "at most 2000"),
        ("{" * 1999, "no JSON object"),
    ],
)
def test_texts_that_are_none(tmp_path: Path, text: str, said: str) -> None:
    record(Motion(np.zeros((60, 3))), tmp_path / "a.w64", TapeFormat(dwell_s=0.01))
    (tmp_path / "a.w64.json").write_text(text)  # a chunk of a WAV ends at 2 kB for libsndfile
    with pytest.raises(TapeFault, match=said):
        Tape.open(tmp_path / "a.w64")


KILLED = """
import sys, numpy as np
from morfax.motion.motion import Motion
from morfax.recorder.tape.tape import record
from morfax.recorder.wear.settings import SETS
from morfax.recorder.wear.transport import age
print("go", flush=True)
while True:
    record((Motion(np.zeros((6000, 3))) for _ in range(60)), sys.argv[1])
    age(sys.argv[1], sys.argv[2], SETS["cassette"])
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs kill -9")
@pytest.mark.parametrize("after_s", [0.05, 0.4, 0.9])
def test_kill_9_leaves_no_half_file(tmp_path: Path, after_s: float) -> None:
    names = tmp_path / "a.wav", tmp_path / "b.wav"
    with subprocess.Popen(
        [sys.executable, "-c", KILLED, *map(str, names)], stdout=subprocess.PIPE
    ) as run:
        assert run.stdout is not None
        run.stdout.readline()
        time.sleep(after_s)
        run.kill()
    for file in names:
        if file.exists():
            with Tape.open(file) as tape:
                assert tape.frames > 62 * 48000 * 0.98  # whole, whichever run it is from
    # the next run is not disturbed
    record(Motion(np.zeros((60, 3))), names[0], TapeFormat(dwell_s=0.01))
    assert soundfile.info(names[0]).frames == (60 + 120) * 8


def test_a_tape_that_cannot_be_wound_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Found by atheris: libsndfile opens a broken FLAC, and then cannot seek to its first frame."""
    short_tape(tmp_path, "a.flac")
    with Tape.open(tmp_path / "a.flac") as tape:
        monkeypatch.setattr(
            soundfile.SoundFile,
            "seek",
            lambda *_: (_ for _ in ()).throw(soundfile.LibsndfileError(39)),
        )
        with pytest.raises(TapeFault, match="cannot be wound to frame 0"):
            list(tape.blocks())
