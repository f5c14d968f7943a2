"""The command line as a user meets it: exit code, stdout, stderr."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from morfax.console.cli import main

SAMPLES = Path(__file__).parents[2] / "samples"


@dataclass(frozen=True)
class Answer:
    """What `morfax` answered."""

    exit_code: int
    out: str
    err: str

    @property
    def figures(self) -> dict[str, Any]:
        """The figures, of a call with --json."""
        read = json.loads(self.out)
        assert isinstance(read, dict)
        return read

    @property
    def fault(self) -> str:
        """The one line of a fault, after what else was told on stderr; no traceback, ever."""
        assert self.exit_code != 0 and "Traceback" not in self.err
        lines = self.err.splitlines()
        assert [line.startswith("morfax: ") for line in lines] == [False] * (len(lines) - 1) + [
            True
        ]
        return lines[-1]


Morfax = Callable[..., Answer]


def without_kernels(err: str) -> str:
    """What was told, but for lines that kernels are being compiled: whichever test runs first has those."""
    return re.sub(r"^compiling .*\.\.\.\n", "", err, flags=re.MULTILINE)


@pytest.fixture
def morfax(capfd: pytest.CaptureFixture[str]) -> Morfax:
    """Call the command line in this process."""

    def call(*words: object) -> Answer:
        capfd.readouterr()
        exit_code = main([str(word) for word in words])
        out, err = capfd.readouterr()
        return Answer(exit_code, out, without_kernels(err))

    return call


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to work in, which is the current one."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _eased(share: np.ndarray) -> np.ndarray:
    """From 0 to 1 without a step in speed: a cycloid, as on a cam."""
    share = np.clip(share, 0, 1)
    return np.asarray(share - np.sin(2 * np.pi * share) / (2 * np.pi))


@pytest.fixture(scope="session")
def path_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A path file: once round a circle of 10 mm about 30,30 in three seconds, with the tool going down and
    up.
    """
    t_s = np.arange(0, 4.001, 0.01)
    z_mm = 2 - 7 * (_eased(t_s / 0.5) - _eased((t_s - 3.5) / 0.5))
    turn = 2 * np.pi * _eased((t_s - 0.5) / 3)
    rows = np.column_stack([t_s, 30 + 10 * np.cos(turn), 30 + 10 * np.sin(turn), z_mm])
    file = tmp_path_factory.mktemp("path") / "circle.csv"
    np.savetxt(file, rows, delimiter=",", header="t_s,x_mm,y_mm,z_mm", comments="", fmt="%.6f")
    return file


@pytest.fixture
def hasty_file(here: Path) -> Path:
    """A path file: X from rest to 90 mm/s at 10 m/s², on, and to rest; twice what the motors of the machine
    can.
    """
    t_s = np.arange(0, 0.06, 1e-3)
    x_mm = np.where(t_s < 9e-3, 5e3 * t_s**2, 0.405 + 90 * (t_s - 9e-3))
    there = np.r_[x_mm, 2 * x_mm[-1] - x_mm[-2::-1]]
    rows = np.column_stack([1e-3 * np.arange(len(there)), there, 0 * there])
    file = here / "hasty.csv"
    np.savetxt(file, rows, delimiter=",", header="t_s,x_mm,y_mm", comments="", fmt="%.6f")
    return file


@pytest.fixture(scope="session")
def tape_file(path_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The tape of that path."""
    file = tmp_path_factory.mktemp("tape") / "circle.wav"
    assert main(["record", str(path_file), "-o", str(file), "--quiet"]) == 0
    return file


@pytest.fixture(scope="module")
def small() -> np.ndarray:
    """Grey values of a small drawing: a line of 0.5 mm round an ellipse of 19 x 14 mm."""
    grey = np.full((320, 320), 240, np.uint8)
    cv2.ellipse(grey, (160, 160), (110, 80), 20, 0, 360, 30, 6, cv2.LINE_AA)
    return grey
