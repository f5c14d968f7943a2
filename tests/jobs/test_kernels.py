"""Where compiled kernels are kept, and who is told."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import pytest

from morfax.jobs import kernels
from morfax.motion import compiled
from morfax.motion.kernel_folder import kernel_folder


@pytest.fixture
def house(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A house with its packages."""
    for package in kernels.PACKAGES:
        (tmp_path / package).mkdir()
    monkeypatch.setattr(kernels, "HOUSE", tmp_path)
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    return tmp_path


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
    monkeypatch.setattr(kernels, "writable", lambda folder: house not in folder.parents)
    kernels.choose_cache()
    assert os.environ["NUMBA_CACHE_DIR"] == str(caches / "morfax")


def test_the_folder_is_the_one_that_is_given_or_the_user_s_or_one_of_the_user_s_own_among_temporary_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "a file"
    file.touch()
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(tmp_path))
    # 1. what is given is taken, or nothing
    for given, expected in ((tmp_path / "given", tmp_path / "given"), (file / "x", None)):
        monkeypatch.setenv("NUMBA_CACHE_DIR", str(given))
        assert kernel_folder() == expected
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    # 2. the user's cache folder, made at the first call
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "caches"))
    assert kernel_folder() == tmp_path / "caches" / "morfax"
    # 3. where that cannot be written: a folder that nobody else may write to
    monkeypatch.setenv("XDG_CACHE_HOME", str(file))
    temporary = kernel_folder()
    assert temporary is not None
    assert temporary.parent == tmp_path
    assert temporary.stat().st_mode & 0o077 == 0
    # 4. one that somebody else made or may write to would be run: it is not taken
    temporary.chmod(0o777)
    assert kernel_folder() is None
    temporary.chmod(0o700)
    monkeypatch.setattr(os, "getuid", lambda: 12345)
    (tmp_path / "morfax-12345").mkdir(mode=0o700)
    assert kernel_folder() is None


@pytest.mark.parametrize("before", [0, 3])
def test_compiling_is_announced_by_its_first_kernel_and_every_few_seconds(
    monkeypatch: pytest.MonkeyPatch, before: int
) -> None:
    """A face is told once, then again after AGAIN_S; a process that compiles nothing says nothing, and what
    was compiled before is not counted.
    """
    said: list[str] = []
    now_s = 100.0
    monkeypatch.setattr(kernels.time, "monotonic", lambda: now_s)
    kernels.announce("the head", said.append)
    assert said == []
    hearer = compiled._COMPILER.hearer
    assert hearer is not None
    for count in range(before, before + 12):
        hearer(count)
        now_s += 1.0
    compiled.hear(None)
    assert said == [
        "compiling the head (first run only) ...",
        "compiling the head (5 so far) ...",
        "compiling the head (10 so far) ...",
    ]
