"""A bench with a worker that does nothing, and a server round it that is asked without a network."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip(
    "starlette", reason="the panel's packages are not installed: pip install 'morfax[panel]'"
)

from starlette.testclient import TestClient

from morfax.console.verbs.panel import _command_line
from morfax.panel.app import routes
from morfax.panel.bench import Bench
from morfax.panel.guard import Guard
from tests.panel.serving import Idle, bench_in

TOKEN = "a-token-of-the-tests"
HOST = "127.0.0.1:8017"
ORIGIN = {"origin": f"http://{HOST}"}


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    """A bench with the cam on it."""
    return bench_in(tmp_path)


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


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """One browser for all tests of a file."""
    from tests.panel.browsing import launched

    with launched() as browser:
        yield browser
