"""The whole way over a sound server: a tape goes out of a device and comes in by PulseAudio's null sink.

PulseAudio runs by itself, with a runtime folder of its own and no hardware; PortAudio finds it through ALSA.
Skipped where one of them is missing.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

ATTEMPTS = 3  # a busy machine may let a device run dry, which is a fault, not a wrong path
LOST = (5, 10)  # samples that are gone: told by the tape's check signal, or by the device
SINK = "sink_name=loop channels=4 channel_map=front-left,front-right,rear-left,rear-right"
DEAF_S = 20.0  # until the server is there


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """The environment of a sound server with a null sink, whose monitor is the source."""
    if shutil.which("pulseaudio") is None or shutil.which("pactl") is None:
        pytest.skip("there is no pulseaudio: a sound server's loop cannot be tested")
    try:
        import sounddevice  # noqa: F401
    except (ImportError, OSError) as error:  # OSError: no PortAudio
        pytest.skip(f"sounddevice cannot be loaded: {error}")
    home = tmp_path_factory.mktemp("pulse")
    home.chmod(0o700)
    socket = home / "native"
    here = {
        **os.environ,
        "HOME": str(home),
        "XDG_CACHE_HOME": os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache"),
        "XDG_RUNTIME_DIR": str(home),
        "PULSE_RUNTIME_PATH": str(home),
        "PULSE_SINK": "loop",
        "PULSE_SOURCE": "loop.monitor",
    }
    words = [
        "pulseaudio", "-n", "--daemonize=no", "--exit-idle-time=-1", "--use-pid-file=no",
        "-L", f"module-native-protocol-unix auth-anonymous=1 socket={socket}",
        "-L", f"module-null-sink {SINK} rate=44100",
    ]  # fmt: skip
    silent = subprocess.DEVNULL
    running = subprocess.Popen(words, env=here, stdout=silent, stderr=silent)
    here["PULSE_SERVER"] = f"unix:{socket}"
    try:
        until = time.monotonic() + DEAF_S
        while subprocess.run(["pactl", "info"], env=here, capture_output=True).returncode:
            if running.poll() is not None or time.monotonic() > until:
                pytest.skip("pulseaudio does not start here")
            time.sleep(0.2)
        if '"number"' not in morfax(here, "devices", "--json").stdout:
            pytest.skip("PortAudio does not see the sound server (libasound2-plugins)")
        yield here
    finally:
        running.terminate()
        running.wait(timeout=10)


def morfax(here: dict[str, str], *words: object) -> subprocess.CompletedProcess[str]:
    """Run the command line."""
    return subprocess.run(
        command(*words), env=here, capture_output=True, text=True, timeout=300
    )


def command(*words: object) -> list[str]:
    """The command line as words."""
    return [sys.executable, "-m", "morfax", *map(str, words)]


def once(here: dict[str, str], folder: Path) -> int:
    """Play a path out of the device and in again; 0 if both went well, 10 for a fault of the device."""
    path, label = folder / "short.csv", folder / "label.json"
    listening = subprocess.Popen(
        command("play", "--device", "pulse", "--label", label, "-o", folder / "heard.csv"),
        env=here,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    sent = morfax(here, "record", path, "--device", "pulse")
    if sent.returncode:
        listening.terminate()
        listening.wait(timeout=300)
        # Ctrl-C, or a tape that breaks off, leaves no file under the final name
        assert not (folder / "heard.csv").exists()
        assert sent.returncode == 10, sent.stderr
        return 10
    return listening.wait(timeout=300)


def test_a_tape_over_a_sound_server_is_the_path(server: dict[str, str], tmp_path: Path) -> None:
    (tmp_path / "short.csv").write_text("x,y\n10,10\n20,10\n20,16\n10,10\n")
    made = morfax(
        server, "record", tmp_path / "short.csv", "-o", tmp_path / "short.wav",
        "--label", tmp_path / "label.json",
    )  # fmt: skip
    assert made.returncode == 0, made.stderr
    morfax(server, "play", tmp_path / "short.wav", "-o", tmp_path / "short-played.csv")
    for _ in range(ATTEMPTS):
        ended = once(server, tmp_path)
        assert ended in (0, *LOST)
        if ended == 0:
            break
    if ended:
        pytest.skip(
            f"the sound server lost samples {ATTEMPTS} times: a fault each time, and no path"
        )
    # 2 um: 0.04 cycle; the server resamples to 44.1 kHz and back
    compared = morfax(
        server, "compare", tmp_path / "heard.csv", tmp_path / "short-played.csv", "--tolerance", "2um"
    )  # fmt: skip
    assert compared.returncode == 0, compared.stdout + compared.stderr
