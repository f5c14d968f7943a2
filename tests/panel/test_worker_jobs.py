"""What the worker does, without a process of its own: what it saves, what it says of mistakes, its pace."""

from __future__ import annotations

import io
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import LineFault
from morfax.motion.placement import Placement
from morfax.panel import lookout, worker
from morfax.panel.result_data import MOST, _placed, following_rows, of_play, path_rows
from morfax.panel.worker import NO_MEMORY, Worker, _stamp, _told

SAMPLES = Path(__file__).parents[2] / "samples"


class OpenCvError(Exception):
    """OpenCV's own, which has a code."""

    def __init__(self, code: int) -> None:
        self.code = code
        super().__init__("(-4:Insufficient memory)")


@pytest.mark.parametrize(
    ("error", "text", "place_mm"),
    [
        (WrongUse("give -o\n a name"), "give -o a name", None),
        (OSError("no space left"), "no space left", None),
        (LineFault("the line\n ends", x_mm=1.5, y_mm=2.5), "the line ends", (1.5, 2.5)),
        (MemoryError(), NO_MEMORY, None),
        (OpenCvError(-4), NO_MEMORY, None),
        (OpenCvError(-5), "a mistake in morfax: OpenCvError: (-4:Insufficient memory)", None),
        (KeyError("x"), "a mistake in morfax: KeyError: 'x'", None),
    ],
)
def test_what_went_wrong_is_one_line_and_a_mistake_of_ours_says_so(
    error: Exception, text: str, place_mm: tuple[float, float] | None
) -> None:
    told = _told(error)
    assert told["text"] == text or (place_mm and told["text"].startswith(text))
    assert told["place_mm"] == place_mm


class Job:
    """A job that takes down whether it traces, or only writes what was traced."""

    unit = None

    def __init__(self, drawing: DrawingFile, tracing: str) -> None:
        self.drawing, self.tracing, self.did = drawing, tracing, list[Any]()
        self.settings = None

    def prepared(self) -> tuple[Any, str]:
        return SimpleNamespace(program=None, path=Path("a.csv")), self.tracing

    def run(self, teller: object) -> Any:
        self.did.append("run")
        return self._result()

    def written(self, outputs: Any, *more: Any) -> Any:
        self.did.append(("written", more[:2]))
        return self._result()

    def _result(self) -> Any:
        return SimpleNamespace(fault=None, traced=SimpleNamespace(name=str))


def test_what_was_traced_is_written_and_after_a_change_traced_again(tmp_path: Path) -> None:
    """A program of an older tracing would be wrong in silence."""
    picture = tmp_path / "cam.png"
    picture.write_bytes(b"first")
    drawing = DrawingFile(picture)
    mine = Worker(io.BytesIO())
    first = Job(drawing, "as set")
    assert mine._save(first) == {"file": "a.csv", "fault": None}  # type: ignore[arg-type]
    assert first.did == ["run"]  # nothing was traced yet
    mine._traced = (_stamp(drawing), "as set", "drawing", "traced")  # type: ignore[assignment]
    same = Job(drawing, "as set")
    mine._save(same)  # type: ignore[arg-type]
    assert same.did == [("written", ("drawing", "traced"))]
    others = [Job(drawing, "otherwise"), Job(DrawingFile(picture, ink="blue"), "as set")]
    picture.write_bytes(b"and another")
    for other in (*others, Job(drawing, "as set")):
        mine._save(other)  # type: ignore[arg-type]
        assert other.did == ["run"]


class Clock:
    """A clock that goes only while somebody sleeps."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def monotonic(self) -> float:
        return self.now_s

    def sleep(self, for_s: float) -> None:
        assert 0 < for_s <= 0.05  # the operator's stop is heard within
        self.now_s += for_s


@pytest.mark.parametrize("pace", [0.5, 1.0, 4.0])
def test_at_a_pace_the_head_takes_its_motion_over_the_pace(
    monkeypatch: pytest.MonkeyPatch, pace: float
) -> None:
    clock = Clock()
    monkeypatch.setattr(lookout, "time", clock)
    seen = lookout.Lookout()
    seen.set_pace(pace)
    for _ in range(3):  # seconds of motion
        seen.moved(SimpleNamespace(rate_hz=6000.0, enlarged=1.0), np.zeros((6000, 2)))  # type: ignore[arg-type]
    assert clock.now_s - 100.0 == pytest.approx(3.0 / pace, abs=1e-6)
    clock.now_s += 10.0  # held for long, and then at another pace: no time is made up for
    seen.set_pace(2.0)
    seen.moved(SimpleNamespace(rate_hz=6000.0, enlarged=1.0), np.zeros((6000, 2)))  # type: ignore[arg-type]
    assert clock.now_s - 110.0 == pytest.approx(3.0 / pace + 0.5, abs=1e-6)
    seen.set_pace(None)
    seen.moved(SimpleNamespace(rate_hz=6000.0, enlarged=1.0), np.zeros((6000, 2)))  # type: ignore[arg-type]
    assert clock.now_s - 110.0 == pytest.approx(3.0 / pace + 0.5, abs=1e-6)


def test_progress_is_told_a_hundred_times_and_ends_where_the_operator_stops() -> None:
    out = io.BytesIO()
    mine = Worker(out)
    with mine.teller.progress("tracing", 2000.0) as advance:
        for done in range(-10, 2010):
            advance(done)
    out.seek(0)
    said = []
    while len(said) < 102:
        said.append(worker.pipe.read_from(out))
    with pytest.raises(EOFError):
        worker.pipe.read_from(out)
    assert [one["share"] for one in said[1:]] == [k / 100 for k in range(101)]
    assert all(one["say"] == "progress" and one["what"] == "tracing" for one in said)
    with mine.teller.progress("nothing", 0.0) as advance:
        advance(1.0)
    mine.lookout.stop()
    with mine.teller.progress("tracing", 1.0) as advance, pytest.raises(KeyboardInterrupt):
        advance(0.5)


def test_a_machine_that_ran_again_is_laid_back_on_the_drawing() -> None:
    from morfax.motion.motion import Path as MotionPath

    t_s = np.linspace(0, 1, MOST + 500)
    places = np.column_stack([10 * t_s, np.zeros_like(t_s), t_s])
    path = MotionPath(t_s, places)
    turned = [[0.0, -1.0, 5.0], [1.0, 0.0, 7.0]]  # a quarter to the left, and moved
    rows = of_play(path, None, turned)["played"]
    assert len(rows["x_mm"]) == MOST
    assert (rows["x_mm"][0], rows["y_mm"][0], rows["z_mm"][-1]) == (5.0, 7.0, 1.0)
    assert (rows["x_mm"][-1], rows["y_mm"][-1]) == (5.0, 17.0)
    assert path_rows(path)["x_mm"][-1] == 10.0  # the path itself stays where it is


def test_where_a_program_was_placed_is_told_so_that_its_path_comes_back() -> None:
    placement = Placement("x", 2.0, 0.3, about_mm=(12.0, -5.0), origin_mm=(1.0, 30.0))
    on_drawing = np.array([[3.0, 4.0], [-20.0, 7.5], [60.0, 90.0]])
    on_machine = placement.places(on_drawing)
    placed = np.array(_placed(SimpleNamespace(placement=placement)))  # type: ignore[arg-type]
    back = on_machine @ placed[:, :2].T + placed[:, 2]
    assert np.allclose(back, on_drawing, atol=1e-9)
    assert _placed(SimpleNamespace(placement=None)) == [[1, 0, 0], [0, 1, 0]]  # type: ignore[arg-type]


def test_following_errors_are_listed_axis_by_axis_and_none_without_a_chart() -> None:
    empty = SimpleNamespace(t_s=np.empty(0))
    assert following_rows(None) is None
    assert following_rows(empty) is None  # type: ignore[arg-type]
    t_s = np.linspace(0, 1, 5)
    demand = np.column_stack([t_s, 2 * t_s])
    chart = SimpleNamespace(
        t_s=t_s, axes=("X", "Y"), demand_mm=demand, error_mm=0.01 * demand, limit_mm=demand
    )
    rows = following_rows(chart)  # type: ignore[arg-type]
    assert rows is not None and rows["axes"] == ["X", "Y"]
    assert rows["demand_mm"] == [[0.0, 0.25, 0.5, 0.75, 1.0], [0.0, 0.5, 1.0, 1.5, 2.0]]
    assert rows["error_mm"][1] == [0.0, 0.005, 0.01, 0.015, 0.02]
    assert rows["limit_mm"] == rows["demand_mm"] and rows["t_s"] == t_s.tolist()
