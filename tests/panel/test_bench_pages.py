"""What the bench keeps on disk, and pages that stop reading or come later."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import pytest

from morfax.motion.faults import FileFault
from morfax.panel.app import _Pages
from morfax.panel.bench import Bench
from morfax.panel.history import History, HistoryStep


def test_a_file_that_holds_no_state_is_refused_and_left_alone(tmp_path: Any) -> None:
    file = tmp_path / "state.json"
    for text in (
        "",
        "{}",
        '{"version": 1}',
        '{"version": 99, "at": 0, "revision": 0, "running": false, "steps": []}',
    ):
        file.write_text(text)
        with pytest.raises(FileFault, match="no state of the panel"):
            History(file)
        assert file.read_text() == text


def test_a_step_is_whole_on_disk(tmp_path: Any) -> None:
    history = History(tmp_path / "state.json")
    history.add(HistoryStep("a.png", {"--width": "120mm"}))
    kept = json.loads((tmp_path / "state.json").read_text())
    step = {"drawing": "a.png", "options": {"--width": "120mm"}, "corrections": ""}
    assert kept["steps"][kept["at"]] == step
    assert [file.name for file in tmp_path.iterdir()] == ["state.json"]


class Socket:
    """A page's end of the stream; one that has stopped reading never takes the first frame off."""

    def __init__(self, reads: bool) -> None:
        self.reads, self.frames, self.waiting = reads, list[dict[str, Any]](), 0

    async def send_text(self, text: str) -> None:
        self.waiting += 1
        if not self.reads:
            await asyncio.Event().wait()
        self.waiting -= 1
        self.frames.append(json.loads(text))


def test_a_page_that_stops_reading_holds_nothing_up_and_gathers_nothing(bench: Bench) -> None:
    quick, stuck = Socket(True), Socket(False)

    async def runs() -> None:
        pages = _Pages(bench)
        tasks = [
            asyncio.create_task(pages._tell(socket, bench.look_on()))
            for socket in (quick, stuck)
        ]
        for k in range(200):
            fresh = [[k + i / 10, 0.0] for i in range(10)]
            bench.heard(
                {"say": "head", "fresh": fresh, "head": {}, "words": "following", "run": 1}
            )
            await asyncio.sleep(0.001)
        await asyncio.sleep(0.1)
        for task in tasks:
            task.cancel()

    asyncio.run(runs())
    come = [place for frame in quick.frames for place in frame["head"]["fresh"]]
    assert len(come) == 2000 and come[-1] == [199.9, 0.0]  # nothing left out, nothing twice
    assert len(quick.frames) < 40  # 0.3 s at 30 a second, not one for each of the 200
    assert stuck.waiting == 1 and not stuck.frames  # one frame, however long it waits


def test_a_page_that_comes_later_gets_the_whole_path(bench: Bench) -> None:
    bench.heard(
        {"say": "head", "fresh": ["down", [0, 0], [1, 0]], "head": {}, "words": "", "run": 1}
    )
    assert bench.path.since(-1, 0)["fresh"] == ["down", [0, 0], [1, 0]]
    assert bench.path.since(bench.path.life, 2)["fresh"] == [[1, 0]]


def test_the_path_of_a_long_run_has_a_bound(
    monkeypatch: pytest.MonkeyPatch, bench: Bench
) -> None:
    monkeypatch.setattr("morfax.panel.head_path.MOST", 1000)
    for k in range(500):
        bench.path.add(
            {"fresh": [[k, i] for i in range(20)], "head": {}, "words": "", "run": 1}
        )
    last = bench.path.since(bench.path.life, len(bench.path) - 1)["fresh"]
    assert len(bench.path) <= 1020 and last in ([[499.0, 19.0]], [[499.0, 18.0]])
