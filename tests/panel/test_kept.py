"""What a page finds that comes later: the last result on disk, the head's path, the numbers of lines."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from starlette.testclient import TestClient

from morfax.panel import head_path
from morfax.panel.bench import Bench
from morfax.panel.head_path import ShownPath
from morfax.panel.kept_result import KeptResult
from tests.panel.conftest import ORIGIN


def frame(*fresh: Any, words: str = "following", run: int = 1) -> dict[str, Any]:
    """A frame of the worker."""
    return {"fresh": list(fresh), "head": {"x_mm": 1.0}, "words": words, "run": run}


def all_of(path: ShownPath) -> list[Any]:
    """The path as a page gets it that asks until there is no more."""
    life, come = path.life, list[Any]()
    while True:
        news = path.since(life, len(come))
        assert (news["life"], news["from"]) == (life, len(come))
        assert len(news["fresh"]) <= head_path.AT_ONCE
        come += news["fresh"]
        if not news["more"]:
            return come


def test_a_page_gets_the_whole_path_piece_by_piece_and_what_the_head_does() -> None:
    path, places = ShownPath(), [[k / 10, -k / 1000] for k in range(12_000)]
    path.add(frame("down", *places[:7000]))
    path.add(frame("down", *places[7000:], words="at a junction", run=2))
    assert all_of(path) == ["down", *places[:7000], "down", *places[7000:]]
    now = path.since(path.life, len(path))
    assert (now["fresh"], now["more"]) == ([], False)
    assert (now["head"], now["words"], now["run"]) == ({"x_mm": 1.0}, "at a junction", 2)
    # a page of another life begins anew, and so do all where a run begins
    assert path.since(path.life - 1, 5)["from"] == 0
    before = path.life
    path.clear()
    assert path.life != before and all_of(path) == [] and "words" not in path.since(0, 0)


def test_of_a_path_that_is_too_long_every_second_place_and_each_put_down_stay(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(head_path, "MOST", 100)
    path, places = ShownPath(), [[float(k), 0.0] for k in range(100)]
    path.add(frame(*places[:49], "down", *places[49:-1]))
    assert (len(path), path.life) == (100, 1)
    path.add(frame(places[-1]))
    assert path.life == 2
    assert all_of(path) == [*places[:49:2], "down", *places[49::2]]


def test_the_last_result_comes_back_with_its_words_and_nonsense_is_none(tmp_path: Path) -> None:
    assert KeptResult(tmp_path / "none").files() == []
    kept = KeptResult(tmp_path)
    assert (kept.result, kept.words) == (None, None)
    kept.begin(["morfax", "run", "cam.png"])
    kept.keep({"figures": {"rms_um": 1.5}, "override": 1.0})
    kept.play_again({"override": 0.5, "faults": ["late"]})
    again = KeptResult(tmp_path)
    assert again.result == {"figures": {"rms_um": 1.5}, "override": 0.5}
    assert again.words == ["morfax", "run", "cam.png"]
    for name in ("b.wav", "a.csv", ".hidden", "state.json"):
        (tmp_path / name).touch()
    (tmp_path / "drawings").mkdir()
    assert again.files() == ["a.csv", "b.wav"]
    for text in ("", "[]", "{}", json.dumps({"result": {}})):
        (tmp_path / "result.json").write_text(text)
        assert KeptResult(tmp_path).result is None
    again.begin([])
    again.play_again({"override": 2.0})  # of a run that is gone
    assert again.result is None


def shown(page: TestClient, bench: Bench) -> None:
    """Wait until the picture is there, which is read beside the answers, and has its number."""
    late_s = time.monotonic() + 60
    while bench.picture is None and time.monotonic() < late_s:
        page.get("/state")


def test_the_numbers_of_the_lines_that_were_seen_are_there_as_tiles(
    page: TestClient, bench: Bench
) -> None:
    numbers = np.zeros((4, 5), np.uint16)
    numbers[2] = 300
    seen = {"numbers": numbers, "picture": None, "figures": {"drawing": "cam.png"}}
    shown(page, bench)
    bench.look()
    at = f"/tile/{bench.picture_id}/lines/0/0/0"
    assert page.get(at).status_code == 204
    bench.heard({"say": "done", "number": bench._job, "kind": "lines", "result": seen})
    answer = page.get(f"/tile/{bench.picture_id}/lines/0/0/0")
    tile = cv2.imdecode(np.frombuffer(answer.content, np.uint8), cv2.IMREAD_UNCHANGED)
    assert tile.shape == (4, 5, 4) and tile[2, 4].tolist() == [0, 1, 44, 255]
    assert page.get("/state").json()["state"]["sheet"] == {"figures": {"drawing": "cam.png"}}
    # looked at again in vain: the numbers are of no sheet that is there
    failed = {"say": "failed", "number": bench._job, "kind": "lines", "place_mm": None}
    bench.heard({**failed, "text": "no line"})
    assert page.get(f"/tile/{bench.picture_id}/lines/0/0/0").status_code == 204
    assert page.get("/state").json()["state"]["sheet"] is None


def test_what_is_gone_by_the_time_it_is_asked_for_is_answered_without_content(
    page: TestClient, bench: Bench
) -> None:
    """A fault would stand in the console of a page that has asked a moment too late."""
    assert page.get("/result").status_code == 204
    bench.kept.result = {"program": None}
    assert page.get("/result").json() == {"program": None}
    shown(page, bench)
    now = bench.picture_id
    assert page.get(f"/tile/{now}/sheet/0/0/0").status_code == 200
    assert page.get(f"/tile/{now - 1}/sheet/0/0/0").status_code == 204
    # what never was is one
    assert page.get(f"/tile/{now}/sheet/9/0/0").status_code == 404
    assert page.get(f"/tile/{now}/nothing/0/0/0").status_code == 404


def test_a_page_that_looks_on_is_woken_by_each_step_and_each_word_of_the_worker(
    page: TestClient, bench: Bench
) -> None:
    bench.look()
    event = bench.look_on()

    def is_woken_by(**action: Any) -> bool:
        event.clear()
        version = bench.version
        if "do" in action:
            seen = {"seen": bench.history.revision}
            assert page.post("/do", json={**seen, **action}, headers=ORIGIN).status_code == 200
        else:
            bench.heard({"number": bench._job, "kind": "run", **action})
        # the head's frames come thirty times a second: the state is not sent with each
        return event.is_set() and (bench.version > version) == (action.get("say") != "head")

    assert is_woken_by(do="set", option="--cutter", value="3mm")  # nothing to look at again
    assert is_woken_by(do="undo") and is_woken_by(do="redo")
    assert is_woken_by(say="begun") and is_woken_by(say="progress", what="", share=0.5)
    assert is_woken_by(do="hold") and bench.busy is not None and bench.busy["held"]
    assert is_woken_by(do="resume") and not bench.busy["held"]
    assert is_woken_by(say="note", text="a note") and is_woken_by(say="stopped")
    assert is_woken_by(say="head", **frame([0.0, 0.0]))
    bench.look_away(event)
    assert not is_woken_by(say="note", text="another")
