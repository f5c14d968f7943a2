"""Start-up: whole processes in times of `import numpy, numba, cv2`, in turn in one run.

Signals out: processor time (user and system) of each command over that of the imports; the median of ROUNDS
rounds. The kernels are warm: every command runs once before, and leaves the bytecode of its modules too.
"""

from __future__ import annotations

import os
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROUNDS = 5
ENVIRONMENT = {
    name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"
}
IMPORTS = [sys.executable, "-c", "import numpy, numba, cv2"]
ASKED = {"trace": 1.8, "play": 1.5, "run": 3.2, "help": 0.2}


def used_s(words: list[str]) -> float:
    """Processor time of one process, s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(words, check=True, capture_output=True, env=ENVIRONMENT)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Print a line for each command."""
    morfax = [sys.executable, "-m", "morfax"]
    with tempfile.TemporaryDirectory() as folder:
        tape = str(Path(folder) / "cam.wav")
        commands = {
            "trace": [*morfax, "trace", "samples/cam.png", "-o", tape],
            "play": [*morfax, "play", tape, "-o", str(Path(folder) / "cam.csv")],
            "run": [*morfax, "run", "samples/cam.png", "-o", str(Path(folder) / "run")],
            "help": [*morfax, "--help"],
        }
        for name, words in commands.items():
            used_s(words)
            ratios = [used_s(words) / used_s(IMPORTS) for _ in range(ROUNDS)]
            ratio = statistics.median(ratios)
            print(f"start-up: {name} takes {ratio:.2f} times the imports ({ASKED[name]} asked)")


if __name__ == "__main__":
    main()
