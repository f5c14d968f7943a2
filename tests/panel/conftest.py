"""A bench with a worker that does nothing, and a server round it that is asked without a network."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip(
    "starlette", reason="the panel's packages are not installed: pip install 'morfax[panel]'"
)

from starlette.testclient import TestClient

from morfax.console.verbs.panel import _command_line
from morfax.panel.app import routes
from morfax.panel.bench import Bench
from morfax.panel.guard import Guard
from morfax.panel.history import Step

SAMPLES = Path(__file__).parents[2] / "samples"
TOKEN = "a-token-of-the-tests"
HOST = "127.0.0.1:8017"
ORIGIN = {"origin": f"http://{HOST}"}


class Idle:
    """A worker that takes down what is sent to it."""

    def __init__(self, heard):
        self.heard, self.sent = heard, []

    async def start(self):
        """Start nothing."""

    async def send(self, *message):
        """Take a message down."""
        self.sent.append(message)

    async def close(self):
        """End nothing."""


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    """A bench with the cam on it."""
    shutil.copy(SAMPLES / "cam.png", tmp_path)
    (tmp_path / "work").mkdir()
    bench = Bench(tmp_path / "work", {"cam.png": tmp_path / "cam.png"}, _command_line(), Idle)
    bench.history.add(Step("cam.png", {}))
    return bench


def again(bench: Bench) -> Bench:
    """A bench after the server was killed and started again."""
    return Bench(bench.folder, bench.sources, _command_line(), Idle)


@pytest.fixture
def stranger(bench: Bench) -> Iterator[TestClient]:
    """A browser that has not opened the address with its token."""
    app = Guard(routes(bench), TOKEN, [HOST, "localhost:8017"], "morfax_panel_8017")
    with TestClient(app, base_url=f"http://{HOST}", follow_redirects=False) as client:
        yield client


@pytest.fixture
def page(stranger: TestClient) -> TestClient:
    """A browser that has."""
    assert stranger.get(f"/?token={TOKEN}").status_code == 303
    return stranger
