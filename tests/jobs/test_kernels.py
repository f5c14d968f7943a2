"""Where compiled kernels are kept."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from morfax.jobs import kernels


@pytest.fixture
def house(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A house with one package that has a kernel, not compiled yet, and one without."""
    for package in kernels.PACKAGES:
        (tmp_path / package).mkdir()
    (tmp_path / "player" / "loop.py").write_text("@njit(cache=True)\ndef _loop(): ...\n")
    (tmp_path / "player" / "part.py").write_text(
        '@njit(cache=True, inline="always")\ndef _part(): ...\n'
    )
    (tmp_path / "motion" / "units.py").write_text("x = 1\n")
    monkeypatch.setattr(kernels, "HOUSE", tmp_path)
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    return tmp_path


def compiled(folder: Path, when_s: float) -> None:
    """Leave what numba leaves when it has compiled `_loop`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "loop._loop-2.py311.nbi").touch()
    os.utime(folder / "loop._loop-2.py311.nbi", (when_s, when_s))


def test_a_package_is_cold_until_its_kernels_are_compiled(house: Path) -> None:
    source_s = (house / "player" / "loop.py").stat().st_mtime
    assert kernels.are_cold(("player",))
    assert not kernels.are_cold(("motion",))
    compiled(house / "player" / "__pycache__", source_s + 1)
    assert not kernels.are_cold(("motion", "player"))


def test_a_package_is_cold_again_when_a_source_is_changed(house: Path) -> None:
    compiled(
        house / "player" / "__pycache__", (house / "player" / "loop.py").stat().st_mtime - 1
    )
    assert kernels.are_cold(("player",))


def test_the_operator_is_told_once_of_the_sources_as_they_are(house: Path) -> None:
    assert not kernels.told(("player",))
    assert kernels.told(("player",))
    changed_s = time.time() + 10
    os.utime(house / "player" / "loop.py", (changed_s, changed_s))
    assert not kernels.told(("player",))


def test_a_house_that_can_be_written_keeps_its_kernels(house: Path) -> None:
    kernels.choose_cache()
    assert "NUMBA_CACHE_DIR" not in os.environ


def test_the_user_s_cache_folder_serves_where_the_house_cannot_be_written(
    house: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    caches = tmp_path_factory.mktemp("caches")
    monkeypatch.setenv(
        "NUMBA_CACHE_DIR", "x"
    )  # so that monkeypatch takes away what is set below
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    monkeypatch.setenv("XDG_CACHE_HOME", str(caches))
    monkeypatch.setattr(kernels, "_writable", lambda folder: house not in folder.parents)
    kernels.choose_cache()
    assert os.environ["NUMBA_CACHE_DIR"] == str(caches / "morfax")
    assert kernels.are_cold(("player",))
    compiled(
        caches / "morfax" / "player_0a1b", (house / "player" / "loop.py").stat().st_mtime + 1
    )
    assert not kernels.are_cold(("player",))
