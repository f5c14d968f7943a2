"""The bench on which checked tapes are played."""

from __future__ import annotations

import pytest

from tests.player.tape.checked import Bench


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    return Bench(tmp_path_factory.mktemp("checked"))
