"""What all tests share: the vectors and drawings that stand beside the repository, where there are any."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from morfax.motion.compile_ahead import SWITCH
from tests.programs import NO_CONTROL, Programs

SHARED = Path(__file__).parents[2] / "shared"
NO_SHARED = (
    "no folder ../shared beside the repository: its drawings and vectors are not part of it"
)

# no deadline, as a first example compiles kernels; derandomized, so that a red test is red for everybody
settings.register_profile("house", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("house")


def pytest_configure(config: pytest.Config) -> None:
    """Have every program that the tests write read by the controls' own rules, and no other core compile."""
    os.environ[SWITCH] = "0"  # the tests have all cores already
    config.addinivalue_line("markers", f"{NO_CONTROL}: its programs are spoilt on purpose")
    config.pluginmanager.register(Programs())


def beside(place: Path) -> Path:
    """A file or folder of ../shared: where it is absent the test is skipped, and in `.ci/run` it fails."""
    if not place.exists():
        if os.environ.get("MORFAX_NEEDS_SHARED"):
            pytest.fail(f"{NO_SHARED}; {place} is needed here")
        pytest.skip(NO_SHARED)
    return place


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of drawings, specifications and vectors beside the repository (`beside`)."""
    return beside(SHARED)


@pytest.fixture(scope="session")
def vectors(shared: Path) -> Callable[[str], Any]:
    """Reads a file of test vectors by name: vectors("mf_tape")."""
    return lambda name: json.loads(
        (shared / "vectors" / f"{name}.json").read_text(encoding="utf-8")
    )
