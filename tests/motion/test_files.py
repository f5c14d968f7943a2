"""Files appear whole or not at all."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

from morfax.motion.faults import FileFault
from morfax.motion.files import written_beside


def names_in(folder: Path) -> list[str]:
    return [file.name for file in folder.iterdir()]


def test_the_file_appears_when_it_is_whole(tmp_path: Path) -> None:
    final = tmp_path / "cam.csv"
    with written_beside(final) as beside:
        assert beside.parent == tmp_path
        assert beside.suffix == ".csv"
        beside.write_text("whole")
        assert not final.exists()
    assert final.read_text() == "whole"
    assert names_in(tmp_path) == ["cam.csv"]


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt, SystemExit])
def test_a_broken_run_leaves_what_was_there(tmp_path: Path, error: type[BaseException]) -> None:
    final = tmp_path / "cam.csv"
    final.write_text("before")
    with pytest.raises(error), written_beside(final) as beside:
        beside.write_text("half")
        raise error
    assert final.read_text() == "before"
    assert names_in(tmp_path) == ["cam.csv"]


def test_two_at_once_do_not_meet(tmp_path: Path) -> None:
    with written_beside(tmp_path / "a") as one, written_beside(tmp_path / "a") as other:
        assert one != other


def test_a_full_disk_is_a_fault_and_leaves_nothing(tmp_path: Path) -> None:
    with (
        pytest.raises(FileFault, match="disk is full; no half file is left"),
        written_beside(tmp_path / "a"),
    ):
        raise OSError(errno.ENOSPC, "No space left on device")
    assert names_in(tmp_path) == []


def test_an_error_about_another_file_stays_what_it_is(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError), written_beside(tmp_path / "a"):
        (tmp_path / "drawing.png").read_bytes()


def test_a_missing_folder_is_a_fault(tmp_path: Path) -> None:
    with (
        pytest.raises(FileFault, match=r"folder .* does not exist; make it first"),
        written_beside(tmp_path / "no" / "a"),
    ):
        pass


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    with pytest.raises(FileFault, match="it is a folder"), written_beside(tmp_path):
        pass


def test_a_file_is_no_folder(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("")
    with (
        pytest.raises(FileFault, match="is not a folder"),
        written_beside(tmp_path / "a" / "b"),
    ):
        pass


@pytest.mark.skipif(os.name != "posix", reason="needs a device that is a file")
def test_a_device_is_never_replaced() -> None:
    with pytest.raises(FileFault, match="not a regular file"), written_beside(os.devnull):
        pass
    assert Path(os.devnull).is_char_device()


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_may_not_be_written(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(FileFault, match="takes no new file"), written_beside(tmp_path / "a"):
        pass


def test_a_link_is_written_through(tmp_path: Path) -> None:
    (tmp_path / "real").write_text("before")
    (tmp_path / "link").symlink_to("real")
    with written_beside(tmp_path / "link") as beside:
        beside.write_text("after")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").read_text() == "after"


def test_what_a_killed_run_left_is_cleared_by_the_next(tmp_path: Path) -> None:
    """A process that is gone; one that lives, one of another machine and an older file are left alone."""
    gone = subprocess.run(  # its number was a process, and is none
        [
            sys.executable,
            "-c",
            "import os, sys; from morfax.motion.files import written_beside\n"
            "with written_beside(sys.argv[1]) as beside:\n"
            "    beside.write_text('half'); os._exit(9)",
            str(tmp_path / "a.wav"),
        ],
        check=False,
    )
    assert gone.returncode == 9
    (left,) = tmp_path.glob(".morfax-*")
    machine = left.name.split("-")[1]
    kept = [
        left.with_name(f".morfax-{machine}-{os.getpid()}-00ff00ff00ff.wav"),
        left.with_name(".morfax-00000000-999999999-00ff00ff00ff.wav"),
        left.with_name(".morfax-00ff00ff00ff.wav"),
    ]
    for file in kept:
        file.write_text("somebody's")
    with written_beside(tmp_path / "b.wav") as beside:
        beside.write_text("whole")
    assert sorted(tmp_path.iterdir()) == sorted([*kept, tmp_path / "b.wav"])
