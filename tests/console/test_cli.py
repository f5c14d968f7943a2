"""The command line as a whole: help, exit codes, one line for whatever goes wrong."""

from __future__ import annotations

import ctypes
import gc
import importlib
import os
import re
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import click
import pytest

from morfax.console import cli
from morfax.motion import faults
from tests.console.conftest import Morfax, without_kernels

MORFAX = [
    sys.executable,
    "-c",
    "import sys; from morfax.console.cli import main; sys.exit(main())",
]


@pytest.mark.parametrize("verb", cli.VERBS)
def test_every_verb_has_help_with_real_examples(morfax: Morfax, verb: str) -> None:
    answer = morfax(verb, "--help")
    assert answer.exit_code == 0 and answer.err == ""
    examples = re.findall(r"^ +morfax (\w+)", answer.out.split("Examples:")[1], re.MULTILINE)
    assert 2 <= len(examples) <= 4 and set(examples) == {verb}
    assert cli.VERBS[verb] in " ".join(answer.out.split())


@pytest.mark.parametrize("verb", cli.VERBS)
def test_the_examples_in_the_help_are_commands_that_parse(verb: str) -> None:
    """Each example is parsed by the verb itself; nothing is run."""
    command = importlib.import_module(f"morfax.console.verbs.{verb}").command
    for line in command.epilog.splitlines():
        if line.strip().startswith("morfax"):
            words = line.split()[2:]
            assert command.make_context(verb, words, resilient_parsing=False).params


def test_help_lists_the_verbs_and_every_exit_code(morfax: Morfax) -> None:
    answer = morfax("--help")
    assert all(verb in answer.out for verb in cli.VERBS)
    kinds = [
        kind
        for kind in vars(faults).values()
        if isinstance(kind, type) and issubclass(kind, faults.Fault)
    ]
    codes = {kind.exit_code for kind in kinds} | {0, 2, 70, 130}
    listed = {
        int(line.split()[0])
        for line in cli.EXIT_CODES.splitlines()
        if line.strip()[:1].isdigit()
    }
    assert listed == codes


def test_help_is_quick_because_it_loads_none_of_the_machines() -> None:
    check = (
        "import sys; from morfax.console.cli import main; main(['--help']);"
        " print([m for m in sys.modules if m in %r])"
    )
    heavy = ["numpy", "numba", "scipy", "cv2", "soundfile", "matplotlib", "rich", "PIL"]
    done = subprocess.run(
        [sys.executable, "-c", check % heavy], capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize(
    "words",
    [
        ["dance"],
        ["play"],
        ["play", "a.wav", "--reference-frequency", "3mm"],
        ["play", "a.wav", "--cycles-per-mm", "0"],
        ["play", "a.wav", "--cycles-per-mm", "many"],
        ["trace", "a.png", "--start", "4"],
        ["trace", "a.png", "--speed", "0"],
        ["trace", "a.png", "--depth=-3mm"],
        ["trace", "a.png", "--depth", "1m"],  # six decades
        ["trace", "a.png", "--depth", "2.505mm"],  # between two counts
        ["trace", "a.png", "--clearance", "0.05mm"],  # in the work, as a path file has it
        ["trace", "a.png", "--dpi", "-300"],
        ["trace", "a.png", "--start", "1e300,1"],
        [
            "trace",
            "a.png",
            "--cutter",
            "40m",
        ],  # whose corners would be arcs of billions of places
        ["record", "a.csv", "--scale", "inf"],
        ["record", "a.csv", "--feed", "1e-9mm/s"],  # for which no disk is large enough
        ["compare", "a.csv"],
        ["compare", "a.csv", "b.csv", "--tolerance", "soon"],
    ],
)
def test_wrong_use_ends_with_2_and_one_line_that_says_where_help_is(
    morfax: Morfax, words: list[str]
) -> None:
    answer = morfax(*words)
    assert answer.exit_code == 2 and answer.out == ""
    assert answer.fault.endswith("--help") and len(answer.err.splitlines()) == 1


def test_a_mistake_in_morfax_is_one_line_too(
    morfax: Morfax, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(ctx: click.Context, name: str) -> None:
        raise RuntimeError("two\nlines")

    monkeypatch.setattr(cli.cli, "get_command", broken)
    answer = morfax("play", "a.wav")
    assert answer.exit_code == 70
    assert "RuntimeError: two lines" in answer.fault


def test_a_lack_of_memory_says_what_to_do(
    morfax: Morfax, monkeypatch: pytest.MonkeyPatch
) -> None:
    def too_large(ctx: click.Context, name: str) -> None:
        raise MemoryError

    monkeypatch.setattr(cli.cli, "get_command", too_large)
    answer = morfax("trace", "a.png")
    assert answer.exit_code == 3 and "resolution" in answer.fault


def test_an_interrupt_that_was_lost_where_none_can_be_caught_comes_again(
    morfax: Morfax, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As in the middle of compiling: LLVM calls Python, and what is raised there is printed and forgotten."""
    calls: list[int] = []

    def interrupted() -> None:
        calls.append(1)
        os.kill(os.getpid(), signal.SIGTERM)
        for _ in range(1000):  # the handler runs here
            pass

    def compiling(ctx: click.Context, name: str) -> None:
        ctypes.CFUNCTYPE(None)(interrupted)()
        for _ in range(3000):
            time.sleep(0.01)

    monkeypatch.setattr(cli.cli, "get_command", compiling)
    answer = morfax("trace", "a.png")
    assert calls == [1]
    assert answer.exit_code == 128 + signal.SIGTERM
    assert answer.fault.startswith("morfax: interrupted")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_as_a_kernel_returns_is_no_mistake(
    morfax: Morfax, monkeypatch: pytest.MonkeyPatch, number: signal.Signals
) -> None:
    """Compiled code that returns a result while one is raised: Python makes a SystemError of it."""

    def returning(ctx: click.Context, name: str) -> None:
        raise SystemError("returned a result with an exception set") from KeyboardInterrupt(
            number
        )

    monkeypatch.setattr(cli.cli, "get_command", returning)
    answer = morfax("trace", "a.png")
    assert answer.exit_code == 128 + number and answer.fault.startswith("morfax: interrupted")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_ctrl_c_or_being_asked_to_end_stops_the_work_and_leaves_no_half_file(
    tmp_path: Path, number: signal.Signals
) -> None:
    """An hour of standing still takes some seconds to record: its unfinished file is there meanwhile."""
    hour = "t_s,x_mm,y_mm,z_mm,tool\n0,1,1,2,0\n3600,1,1,2,0\n"
    (tmp_path / "hour.csv").write_text(hour, encoding="ascii")
    command = [*MORFAX, "record", "hour.csv", "-o", "half.wav"]
    heeded = partial(
        signal.signal, number, signal.SIG_DFL
    )  # a shell has its background jobs ignore Ctrl-C
    with subprocess.Popen(
        command,
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        text=True,
        env=_with_house(),
        preexec_fn=heeded,
    ) as process:
        while len(list(tmp_path.iterdir())) == 1 and process.poll() is None:
            time.sleep(0.02)
        process.send_signal(number)
        _, err = process.communicate(timeout=300)
    assert process.returncode == 128 + number
    assert err.split("\n")[-2:] == [
        "morfax: interrupted; no unfinished file was left under its final name",
        "",
    ]
    assert [file.name for file in tmp_path.iterdir()] == ["hour.csv"]


def test_a_reader_that_goes_away_is_no_fault(path_file: Path) -> None:
    command = [*MORFAX, "compare", str(path_file), str(path_file), "--json"]
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        command, stdout=write, stderr=subprocess.PIPE, text=True, env=_with_house(), check=False
    )
    os.close(write)
    assert without_kernels(done.stderr) == ""
    assert done.returncode == 0


@pytest.mark.parametrize("closed", ["2>&-", ">&- 2>&-", "<&- >&- 2>&-"])
def test_streams_that_are_closed_take_what_is_said(
    path_file: Path, tmp_path: Path, closed: str
) -> None:
    """(Fails without `_open_closed_streams`: a mistake in morfax, exit code 70.)"""
    words = ["record", str(path_file), "-o", str(tmp_path / "closed.cubic")]
    done = subprocess.run(
        ["sh", "-c", f'exec "$@" {closed}', "sh", *MORFAX, *words],
        capture_output=True,
        text=True,
        env=_with_house(),
        check=False,
    )
    assert done.returncode == 0 and done.stderr == ""
    assert (tmp_path / "closed.cubic").read_text().startswith("morfax cubic 1")


def _with_house() -> dict[str, str]:
    """The environment, with the packages on the path wherever the command is called."""
    return {**os.environ, "PYTHONPATH": str(Path(cli.__file__).absolute().parents[2])}


def test_rings_of_objects_are_sought_seldom_while_a_verb_runs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    before, seen = gc.get_threshold(), list[tuple[int, int, int]]()
    monkeypatch.setattr(cli, "_ended", lambda words: seen.append(gc.get_threshold()) or 0)
    assert cli.main(["--help"]) == 0
    assert seen[0][0] == cli.OBJECTS > before[0]
    assert gc.get_threshold() == before
