"""Further axes the whole way: columns of a path file, tracks of a tape, the machine's own screws, columns
again.
"""

from __future__ import annotations

from pathlib import Path as FilePath

import numpy as np
import pytest
import soundfile

from morfax.motion.faults import MotionFault, TapeFault
from morfax.motion.motion import Motion, Path, join, thin
from morfax.motion.pathfile import read_path, write_path
from morfax.player.tape.playback import play
from morfax.recorder.media import record as record_any
from morfax.recorder.tape.tape import Tape, record
from tests.console.conftest import Morfax, here, morfax

__all__ = ["here", "morfax"]  # fixtures

UM = 1e-3
FIVE = ("x", "y", "z", "a", "u")


def five_axes(axes: tuple[str, ...] = FIVE) -> Path:
    """Three seconds in which every axis swings in its own way, at most 12 mm/s and 0.1 m/s²."""
    t_s = np.linspace(0, 3, 601)
    gently = np.sin(np.pi * t_s / 3) ** 2
    columns = [(3 + i) * gently * np.sin((1.5 + i / 4) * t_s) + i for i in range(len(axes))]
    return Path(t_s, np.column_stack(columns), axes)


def test_five_coordinates_go_through_file_tape_and_machine(tmp_path: FilePath) -> None:
    write_path(five_axes(), tmp_path / "a.csv")
    assert (tmp_path / "a.csv").read_text().startswith("t_s,x_mm,y_mm,z_mm,tool,a_mm,u_mm\n")
    path = read_path(tmp_path / "a.csv")
    assert path.axes == FIVE
    record(path, tmp_path / "a.wav")
    assert soundfile.info(tmp_path / "a.wav").channels == 6
    played = join(play(tmp_path / "a.wav"))
    assert played.axes == FIVE
    wanted = join(path.motion()).positions_mm
    # 0.3 m/s² of the kinks of the path file's straight pieces at 250 Hz
    assert np.abs(played.positions_mm[6000 : 6000 + len(wanted)] - wanted).max() < 0.5 * UM
    write_path(thin([played]), tmp_path / "b.csv")
    assert read_path(tmp_path / "b.csv").positions_mm[-1] == pytest.approx(
        path.positions_mm[-1], abs=0.05 * UM
    )


def test_a_stream_says_its_axes(tmp_path: FilePath) -> None:
    record(five_axes().motion(), tmp_path / "a.wav")
    with Tape.open(tmp_path / "a.wav") as tape:
        assert tape.format.axes == FIVE


def test_a_flac_holds_seven_axes_and_no_more(tmp_path: FilePath) -> None:
    seven = ("x", "y", "z", "a", "b", "u", "v")
    record(five_axes(seven), tmp_path / "a.flac")
    assert np.ptp(join(play(tmp_path / "a.flac")).positions_mm, axis=0).min() > 1
    with pytest.raises(TapeFault, match="a FLAC holds at most 8 tracks, these are 9"):
        record(five_axes((*seven, "w")), tmp_path / "b.flac")
    record(five_axes((*seven, "w")), tmp_path / "b.wav")
    assert play(tmp_path / "b.wav").format.tracks == 9


def test_three_axes_stay_as_they_were(tmp_path: FilePath) -> None:
    path = five_axes(("x", "y", "z"))
    write_path(path, tmp_path / "a.csv")
    assert (
        (tmp_path / "a.csv")
        .read_text()
        .startswith("t_s,x_mm,y_mm,z_mm,tool\n0.0000000,0.00000,")
    )
    assert read_path(tmp_path / "a.csv").axes == ("x", "y", "z")


def test_further_axes_without_times_or_z(tmp_path: FilePath) -> None:
    (tmp_path / "a.csv").write_text("x,y,tool,v_mm\n0,0,1,0\n0,0,1,30\n4,0,0,30\n")
    path = read_path(tmp_path / "a.csv", feed_mm_s=10)
    assert path.axes == ("x", "y", "z", "v")
    assert path.t_s[1] == pytest.approx(3.0)  # a move of V alone takes its time at the feed
    assert path.positions_mm[2].tolist() == [
        0,
        0,
        2,
        30,
    ]  # the tool goes up where it is, V stays


def test_time_must_pass_while_a_further_axis_moves(tmp_path: FilePath) -> None:
    (tmp_path / "a.csv").write_text("t_s,x,y,u_mm\n0,0,0,0\n0,0,0,1\n1,1,1,1\n")
    with pytest.raises(MotionFault, match="line 3: t_s is 0 after 0"):
        read_path(tmp_path / "a.csv")


@pytest.mark.parametrize("suffix", [".ngc", ".steps", ".cubic"])
def test_other_media_refuse_what_they_would_lose(tmp_path: FilePath, suffix: str) -> None:
    with pytest.raises(
        MotionFault, match="the motion has A, U beside X, Y, Z, which only a tape takes"
    ):
        record_any(five_axes(), tmp_path / f"a{suffix}")
    assert not list(tmp_path.iterdir())


def test_the_command_line_records_and_plays_them(morfax: Morfax, here: FilePath) -> None:
    write_path(five_axes(), "a.csv")
    assert (
        morfax(
            "record", "a.csv", "-o", "a.wav", "--mirror", "y", "--pickup", "hall", "-q"
        ).exit_code
        == 0
    )
    answer = morfax(
        "play", "a.wav", "-o", "b.csv", "--json", "--zero-adjustment", "0,0,0,0,0.5"
    )
    assert answer.exit_code == 0
    end = read_path("a.csv").positions_mm[-1] * [1, 1, 1, 1, 1]
    assert answer.figures["end_place_mm"] == pytest.approx(
        [*end[:4], end[4] + 0.5], abs=0.05 * UM
    )
    assert "track_6_u" in morfax("inspect", "a.wav", "--json").figures
    assert "A, U beside X, Y, Z" in morfax("record", "a.csv", "-o", "a.ngc").fault


def test_a_motion_of_other_axes_than_the_format_is_refused(tmp_path: FilePath) -> None:
    from morfax.recorder.tape.tape import TapeFormat

    with pytest.raises(MotionFault, match="the motion has 5 axes; this tape takes 3: x, y, z"):
        record(Motion(np.zeros((10, 5))), tmp_path / "a.wav", TapeFormat())
