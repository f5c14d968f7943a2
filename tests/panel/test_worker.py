"""The worker compiles damaged kernels again, once, and tells the page so in one line."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

from morfax.panel import pipe

ROOT = Path(__file__).parents[2]
MODULE = """
from numba import njit

@njit(cache=True)
def twice(x):
    return 2 * x
"""
# a worker whose only kind of job runs that kernel
RUN = """
from morfax.panel import worker

def run(self, number):
    import loop
    return {"is": loop.twice(number)}

worker.Worker._twice = run
worker.main()
"""


def told(home: Path) -> list[dict[str, Any]]:
    """What the worker says until its job is done."""
    with subprocess.Popen(
        [sys.executable, "-c", RUN],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        cwd=ROOT,
        env={"PYTHONPATH": f"{ROOT}:{home}"},
    ) as process:
        assert process.stdin is not None and process.stdout is not None
        process.stdin.write(pipe.packed(("job", 1, "twice", 21)))
        process.stdin.flush()
        said = [pipe.read_from(process.stdout)]
        while said[-1]["say"] not in ("done", "failed"):
            said.append(pipe.read_from(process.stdout))
        process.stdin.close()
    return said


def test_damaged_kernels_are_compiled_again_and_the_page_hears_of_it(tmp_path: Path) -> None:
    (tmp_path / "loop.py").write_text(MODULE)
    assert [one["say"] for one in told(tmp_path)] == ["begun", "done"]
    kernel = next((tmp_path / "__pycache__").glob("loop.twice-*.nbc"))
    kernel.write_bytes(b"\x80\x05garbage" * 40)
    begun, note, done = told(tmp_path)
    assert begun["say"] == "begun"
    assert note["say"] == "note" and "are damaged: they are compiled again" in note["text"]
    assert done["result"] == {"is": 42}


def test_a_worker_whose_server_was_killed_ends_without_a_word() -> None:
    with subprocess.Popen(
        [sys.executable, "-m", "morfax.panel.worker"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd=ROOT,
    ) as process:
        assert process.stdin and process.stdout and process.stderr
        process.stdout.close()
        process.stdin.write(pipe.packed(("job", 1, "lines", None)))
        process.stdin.flush()
        assert process.wait(60) == 0
        assert process.stderr.read() == b""


def test_ctrl_c_is_the_servers_and_leaves_the_worker_at_work() -> None:
    """The terminal sends it to both; the server asks the head to stop, and says what is kept."""
    with subprocess.Popen(
        [sys.executable, "-m", "morfax.panel.worker"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        cwd=ROOT,
    ) as process:
        assert process.stdin and process.stdout
        for number in (1, 2):
            process.stdin.write(pipe.packed(("job", number, "lines", None)))
            process.stdin.flush()
            said = [pipe.read_from(process.stdout) for _ in range(2)]
            assert [(one["say"], one["number"]) for one in said] == [
                ("begun", number),
                ("failed", number),
            ]
            process.send_signal(signal.SIGINT)
        process.stdin.close()
        assert process.wait(60) == 0
