"""Path files: what is written reads back, what others wrote is understood, what is none is refused with its
line.
"""

from pathlib import Path as FilePath

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from morfax.motion.contour import length_mm
from morfax.motion.faults import FileFault, MotionFault
from morfax.motion.motion import Path, join
from morfax.motion.pathfile import CLEARANCE_MM, FEED_MM_S, read_path, write_path

WRITTEN_MM = 0.51e-5  # half of the last of five decimals
WRITTEN_S = 0.51e-7  # half of the last of seven decimals

IN_ONE_FOLDER = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


def read(folder: FilePath, text: str, **options: float) -> Path:
    (folder / "path.csv").write_text(text, encoding="utf-8")
    return read_path(folder / "path.csv", **options)


@IN_ONE_FOLDER
@given(
    arrays(np.float64, (20, 3), elements=st.floats(-1e4, 1e4)),
    st.floats(0, 1e4),
    st.floats(1e-4, 10),
)
def test_a_written_path_reads_back(
    tmp_path: FilePath, positions: np.ndarray, start_s: float, step_s: float
) -> None:
    path = Path(start_s + step_s * np.arange(20), positions)
    write_path(path, tmp_path / "p.csv")
    again = read_path(tmp_path / "p.csv")
    assert np.abs(again.t_s - path.t_s).max() <= WRITTEN_S
    assert np.abs(again.positions_mm - path.positions_mm).max() <= WRITTEN_MM


def test_the_written_file_is_as_documented(tmp_path: FilePath) -> None:
    write_path(
        Path(np.array([0.0, 0.5]), np.array([[1.0, -0.0, 2.0], [1.0, -1e-9, -5.0]])),
        tmp_path / "p.csv",
    )
    assert (tmp_path / "p.csv").read_text().splitlines() == [
        "t_s,x_mm,y_mm,z_mm,tool",
        "0.0000000,1.00000,0.00000,2.00000,0",
        "0.5000000,1.00000,0.00000,-5.00000,1",
    ]


def test_x_and_y_are_enough(tmp_path: FilePath) -> None:
    path = read(tmp_path, "y,x\n0,0\n0,30\n40,30\n")
    assert path.positions_mm.tolist() == [[0, 0, 0], [30, 0, 0], [30, 40, 0]]
    assert path.t_s == pytest.approx([0, 3, 7])  # 10 mm/s
    assert path.tool.all()


def test_the_feed_sets_the_times_that_are_missing(tmp_path: FilePath) -> None:
    assert read(tmp_path, "x,y\n0,0\n30,0\n", feed_mm_s=20).t_s[-1] == pytest.approx(1.5)
    with pytest.raises(ValueError, match="feed of 0"):
        read(tmp_path, "x,y\n0,0\n30,0\n", feed_mm_s=0)


@pytest.mark.parametrize(
    "text",
    [
        "\ufeffX_MM,Y_MM\r\n1,2\r\n3,4\r\n",  # byte-order mark, capitals, Windows lines
        "# made by hand\n\n x_mm ; y_mm \n1;2\n# half way\n\n3;4\n",
        "x\ty\n1\t2\n3\t4",
        'name,"x","y"\n"a, b",1,2\nc,3,4\n',
        "x,y,\n1,2,\n3,4,\n",
    ],
)
def test_other_programs_ways_of_writing(tmp_path: FilePath, text: str) -> None:
    assert read(tmp_path, text).xy_mm.tolist() == [[1, 2], [3, 4]]


def test_loops_become_contours_with_the_tool_up_in_between(tmp_path: FilePath) -> None:
    path = read(tmp_path, "loop,x,y\n0,0,0\n0,10,0\n1,10,5\n1,20,5\n")
    assert [run.tolist() for run in path.runs()] == [[[0, 0], [10, 0]], [[10, 5], [20, 5]]]
    assert path.positions_mm[:, 2].tolist() == [0, 0, CLEARANCE_MM, CLEARANCE_MM, 0, 0]
    assert length_mm(path) == pytest.approx(20)


@pytest.mark.parametrize("header", ["x,y,tool", "t_s,x,y,tool"])
def test_tool_becomes_moves_of_z_at_the_feed_while_x_and_y_stand(
    tmp_path: FilePath, header: str
) -> None:
    rows = [
        (0, 0, 0, 0),
        (1, 10, 0, 1),
        (2, 20, 0, 1),
        (3, 20, 10, 0),
        (4, 30, 10, 1),
        (5, 40, 10, 1),
    ]
    lines = [",".join(map(str, row if header.startswith("t") else row[1:])) for row in rows]
    path = read(tmp_path, "\n".join([header, *lines]))
    assert [run[:, 0].tolist() for run in path.runs()] == [[10, 20], [30, 40]]
    motion = join(path.motion())
    step_mm = np.abs(np.diff(motion.positions_mm, axis=0))
    assert step_mm.max() * motion.rate_hz <= FEED_MM_S * (1 + 1e-6)
    in_z = step_mm[:, 2] > 1e-9
    stray_mm = (
        FEED_MM_S / motion.rate_hz
    )  # one sample may hold the end of one move and the start of the next
    assert np.count_nonzero(in_z & (step_mm[:, :2].max(axis=1) > 1e-9)) <= 6
    assert step_mm[in_z, :2].max() <= stray_mm


def test_words_for_the_tool(tmp_path: FilePath) -> None:
    path = read(tmp_path, "x,y,tool\n0,0,up\n1,0,Down\n2,0,TRUE\n3,0,false\n")
    assert path.runs()[0].tolist() == [[1, 0], [2, 0]]


def test_given_times_move_on_by_what_z_needs(tmp_path: FilePath) -> None:
    path = read(tmp_path, "t_s,x,y,tool\n5,0,0,1\n6,10,0,1\n7,20,0,0\n")
    rise_s = CLEARANCE_MM / FEED_MM_S
    assert path.t_s == pytest.approx([5, 6, 6 + rise_s, 7 + rise_s])


def test_a_point_that_stands_twice_is_taken_once(tmp_path: FilePath) -> None:
    assert len(read(tmp_path, "x,y\n0,0\n0,0\n1,0\n1,0\n").t_s) == 2


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "0 points in it"),
        ("x,y\n", "0 points in it"),
        ("x,y\n1,2\n", "1 points in it"),
        ("1,2\n3,4\n5,6\n", "line 1: no column x_mm in '1,2'"),
        ("t_s,x_mm\n1,2\n3,4\n", "line 1: no column y_mm"),
        (
            "x,y,a_deg\n1,2,3\n4,5,6\n",
            "line 1: column a_deg cannot be read; give a_mm, in mm, or take the column out",
        ),
        (
            "x,y,t_ms\n1,2,3\n4,5,6\n",
            "line 1: column t_ms cannot be read; give t_s, in seconds",
        ),
        ("x,x_mm,y\n1,2,3\n4,5,6\n", "line 1: column x_mm stands there 2 times"),
        ("x,y\n1,2\n# remark\n3,four\n", "line 4: y_mm is 'four'; it must be a finite number"),
        ("x,y\n1,2\n3\n", "line 3: no value for y_mm in '3'"),
        ("x,y\n1,2\n3,nan\n", "line 3: y_mm is 'nan'"),
        ("x,y\n1,2\n3,\n", "line 3: y_mm is ''"),
        (
            "x,y,tool\n1,2,1\n3,4,maybe\n",
            r"line 3: tool is 'maybe'; it must be 1 \(in the work\) or 0 \(up\)",
        ),
        ("t_s,x,y\n0,1,2\n1,3,4\n0.5,5,6\n", "line 4: t_s is 0.5 after 1; times must grow"),
        ("t_s,x,y\n0,1,2\n0,3,4\n", "line 3: t_s is 0 after 0"),
        ("x,y\n1,2\n1,2\n", "stands still at one place"),
    ],
)
def test_what_is_no_path_is_refused_with_its_line(
    tmp_path: FilePath, text: str, fault: str
) -> None:
    with pytest.raises(MotionFault, match=fault) as caught:
        read(tmp_path, text)
    assert "\n" not in str(caught.value)


def test_files_that_cannot_be_read(tmp_path: FilePath) -> None:
    with pytest.raises(FileFault, match="No such file"):
        read_path(tmp_path / "none.csv")
    with pytest.raises(FileFault, match="directory"):
        read_path(tmp_path)
    (tmp_path / "p.csv").write_bytes(b"\x89PNG\r\n\x1a\n\xff\xfe")
    with pytest.raises(MotionFault, match="not a text file"):
        read_path(tmp_path / "p.csv")


@IN_ONE_FOLDER
@given(st.text(max_size=60) | st.text("xy,_mt0123.\n-e", max_size=60).map("x,y\n".__add__))
def test_any_text_is_a_path_or_a_fault_of_one_line(tmp_path: FilePath, text: str) -> None:
    (tmp_path / "p.csv").write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        assert len(read_path(tmp_path / "p.csv").t_s) >= 2
    except MotionFault as fault:
        assert "\n" not in str(fault)
