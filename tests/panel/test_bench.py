"""The bench: steps on disk, undo and redo, pages that contradict each other, pages that stop reading."""

from __future__ import annotations

import asyncio
import json
import shlex
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient

from morfax.console.verbs.panel import _command_line
from morfax.panel.bench import Bench
from tests.panel.conftest import ORIGIN
from tests.panel.serving import Idle


def does(page: TestClient, bench: Bench, **action: Any) -> str:
    """Do an action as a page that has seen the newest state; the refusal, or nothing."""
    answer = page.post("/do", json={"seen": bench.history.revision, **action}, headers=ORIGIN)
    return str(answer.json().get("refused") or "")


def command(page: TestClient) -> str:
    """The command that the page shows for a run."""
    text: str = page.get("/state").json()["state"]["commands"]["run"]
    return text


def test_each_setting_is_in_the_command_that_is_shown(page: TestClient, bench: Bench) -> None:
    assert not does(page, bench, do="set", option="--cutter", value="3mm")
    assert not does(page, bench, do="set", option="--side", value="inside")
    assert not does(page, bench, do="set", option="--climb", value=True)
    assert "--cutter 3mm --side inside --climb" in command(page)
    assert not does(page, bench, do="set", option="--climb", value=None)
    assert "--climb" not in command(page)
    assert not does(page, bench, do="set", option="--arrow", value="26,30 20,30; 16,23 18,23")
    assert "--arrow 26,30 20,30 --arrow 16,23 18,23" in command(page)
    assert not does(page, bench, do="set", option="--order", value="3,1")
    assert "--order 3,1" in command(page)


def test_the_page_knows_the_lines_that_machine_and_cutter_are_for(
    page: TestClient, bench: Bench
) -> None:
    """A laser takes all the ink, and a cutter the contours, though nobody has chosen: the page shows it."""

    def usual() -> Any:
        return page.get("/state").json()["state"]["usual_lines"]

    assert usual() is None
    does(page, bench, do="set", option="--machine", value="grbl-laser")
    assert usual() == "all"
    does(page, bench, do="set", option="--lines", value="1")  # the longest alone
    assert usual() == "all" and "--lines 1" in command(page)
    does(page, bench, do="set", options={"--cutter": "1mm", "--lines": None})
    assert usual() == "contours"
    does(page, bench, do="set", option="--start", value="26,30")
    assert usual() is None


@pytest.mark.parametrize(
    ("option", "value", "said"),
    [
        ("--cutter", "3 apples", "3 apples"),
        ("--cutter", "900mm", "0.05mm to 500mm"),
        ("--depth", "-1mm", "five decades"),
        ("--lines", "1,x", "names no lines"),
        ("--start", "40", "40"),
        ("--machine", "../../etc/passwd", "may be"),
        ("--machine", "/tmp/my.toml", "may be"),
        ("--card", "card.toml", "a file of your own"),
        ("--settings", "/etc/passwd", "a file of your own"),
        ("--arrow", "26,30", "value for “Arrow”"),
        ("--order", "3,x", "no order of lines"),
        ("-o", "/tmp/x.wav", "no option"),
        ("--print-settings", True, "no option"),
        ("--edge", "yes", "cannot be"),
        ("--cutter", "--help", "--help"),
        ("--cutter", 3, "cannot be"),
        ("--cutter", "3" * 300, "cannot be"),
    ],
)
def test_nonsense_is_refused_as_a_terminal_refuses_it(
    page: TestClient, bench: Bench, option: str, value: Any, said: str
) -> None:
    before = bench.history.now
    assert said in does(page, bench, do="set", option=option, value=value)
    assert bench.history.now == before


@pytest.mark.parametrize(
    "action",
    [
        {},
        {"do": "fly"},
        {"do": ["run"]},
        {"do": "open", "drawing": "/etc/passwd"},
        {"do": "save", "as": "../x.wav"},
        {"do": "pace", "times": 101},
        {"do": "pace", "times": 0.09},
        {"do": "override", "share": 0.5},
        {"do": "override", "share": "50%"},
        {"do": "hold"},
        {"do": "set", "options": "--cutter"},
        {"do": "set", "options": ["--cutter", "3mm"]},
    ],
)
def test_what_cannot_be_done_is_refused_in_words(
    page: TestClient, bench: Bench, action: dict[str, Any]
) -> None:
    assert does(page, bench, **action)
    assert page.post("/do", content=b"{" * 200_000, headers=ORIGIN).status_code == 413
    assert page.post("/do", content=b"[" * 50_000, headers=ORIGIN).status_code == 400


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (
            {"as": "rub", "at": [[1, 2], [3.04, 4]], "width": "3mm"},
            ["--rub", "1.0px,2.0px 3.0px,4.0px", "--rubber", "3mm"],
        ),
        ({"as": "bridge", "at": [[1, 2], [3, 4]]}, ["--bridge", "1.0px,2.0px 3.0px,4.0px"]),
        ({"as": "left", "at": [[1, 2]]}, ["--turn", "left", "1.0px,2.0px"]),
        ({"as": "not-stop", "at": [[1, 2]]}, ["--not-stop", "1.0px,2.0px"]),
        ({"remove": 2}, ["--remove", "2"]),
    ],
)
def test_a_correction_is_words_of_morfax_correct(
    page: TestClient, bench: Bench, asked: dict[str, Any], words: list[str]
) -> None:
    assert not does(page, bench, do="correct", **asked)
    shown = page.get("/state").json()["state"]["commands"]["correct"]
    assert shlex.split(shown) == ["morfax", "correct", str(bench.drawing), *words]


@pytest.mark.parametrize(
    "asked",
    [
        {"as": "burn", "at": [[1, 2]]},
        {"as": "rub", "at": []},
        {"as": "rub", "at": [[1, 2]] * 500},
        {"as": "rub", "at": [["1", "--undo"]]},
        {"as": "rub", "at": [[1, float("nan")]]},
        {"as": "rub", "at": [[1, 2]], "width": "--undo"},
        {"as": "rub", "at": [[1, 2]], "width": "3 apples"},
        {"remove": "1 --undo"},
        {},
    ],
)
def test_what_is_no_correction_is_refused(
    page: TestClient, bench: Bench, asked: dict[str, Any]
) -> None:
    body = json.dumps({"seen": bench.history.revision, "do": "correct", **asked})
    assert page.post("/do", content=body, headers=ORIGIN).json()["refused"]


def test_undo_lays_the_former_corrections_beside_the_drawing(
    page: TestClient, bench: Bench
) -> None:
    assert bench.drawing is not None
    file = bench.drawing.with_name("cam.morfax.toml")
    file.write_text("# first\n")
    does(page, bench, do="set", option="--cutter", value="3mm")
    # somebody edits the file by hand
    file.write_text("# by hand\n")
    does(page, bench, do="undo")
    assert file.read_text() == "# first\n"
    does(page, bench, do="undo")
    assert not file.exists()
    for text in ("# first\n", "# by hand\n"):
        does(page, bench, do="redo")
        assert file.read_text() == text


def test_undo_and_redo_go_all_the_way(page: TestClient, bench: Bench) -> None:
    for mm in range(1, 30):
        does(page, bench, do="set", option="--cutter", value=f"{mm}mm")
    for mm in range(28, 0, -1):
        does(page, bench, do="undo")
        assert bench.history.now.options == {"--cutter": f"{mm}mm"}
    for _ in range(40):
        does(page, bench, do="redo")
    assert bench.history.now.options == {"--cutter": "29mm"} and not bench.history.can_redo


def test_undo_of_the_first_drawing_leaves_the_bench_bare(
    page: TestClient, bench: Bench
) -> None:
    """(Fails without `_clear`: the sheet and its lines stay, beneath "lay a drawing on the bench"; and where
    lines that were looked at meanwhile are taken in.)"""
    seen = {"numbers": np.zeros((4, 4), np.uint8), "picture": np.zeros((4, 4), np.uint8)}
    looked = {"kind": "lines", "result": {**seen, "figures": {"drawing": "cam.png"}}}
    bench.look()
    bench.heard({"say": "done", "number": bench._job, **looked})
    assert page.get("/state").json()["state"]["picture"]
    while bench.history.can_undo:
        does(page, bench, do="undo")
    bench.heard({"say": "done", "number": bench._job, **looked})
    state = page.get("/state").json()["state"]
    assert state["drawing"] is state["picture"] is state["sheet"] is None
    sent = len(bench.workshop.sent)  # type: ignore[attr-defined]
    does(page, bench, do="redo")
    assert page.get("/state").json()["state"]["drawing"] == "cam.png"
    assert len(bench.workshop.sent) > sent  # type: ignore[attr-defined]


def test_of_two_pages_the_one_that_has_not_seen_the_others_change_is_refused(
    page: TestClient, bench: Bench
) -> None:
    seen = bench.history.revision
    first = page.post(
        "/do",
        json={"do": "set", "option": "--cutter", "value": "3mm", "seen": seen},
        headers=ORIGIN,
    )
    second = page.post(
        "/do",
        json={"do": "set", "option": "--cutter", "value": "6mm", "seen": seen},
        headers=ORIGIN,
    )
    assert first.status_code == 200 and second.status_code == 409
    assert "another page" in second.json()["refused"]
    assert bench.history.now.options == {"--cutter": "3mm"}


def test_the_state_comes_back_after_the_server_was_killed(
    page: TestClient, bench: Bench
) -> None:
    does(page, bench, do="set", option="--cutter", value="3mm")
    again = Bench(bench.folder, bench.sources, _command_line(), Idle)  # nothing was closed
    assert again.history.now == bench.history.now and again.history.can_undo
    assert again.history.revision == bench.history.revision


def test_a_run_that_was_cut_off_goes_on_by_itself(page: TestClient, bench: Bench) -> None:
    bench.sheet = {"figures": {}}
    assert not does(page, bench, do="run")
    assert "a run is under way" in does(page, bench, do="run")
    again = Bench(bench.folder, bench.sources, _command_line(), Idle)

    async def begins() -> None:
        await again.begin()
        await asyncio.sleep(0.01)

    asyncio.run(begins())
    kinds = [message[2] for message in again.workshop.sent if message[0] == "job"]  # type: ignore[attr-defined]
    assert kinds == ["lines", "run"]


def test_an_override_has_the_machine_play_the_program_again(
    page: TestClient, bench: Bench
) -> None:
    bench.kept.begin(bench.words())
    placed = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    bench.kept.keep({"program": "cam.wav", "placed": placed, "override": 1.0, "figures": {}})
    assert "10% to 200%" in does(page, bench, do="override", share=2.5)
    assert not does(page, bench, do="override", share=0.5)
    _, _, kind, (job, back, share) = bench.workshop.sent[-1]  # type: ignore[attr-defined]
    assert (kind, back, share) == ("play", placed, 0.5)
    assert (job.tape, job.control.feed_override) == (bench.folder / "cam.wav", 0.5)
    ran = {"played": {}, "following": None, "override": 0.5, "faults": []}
    bench.heard({"say": "done", "number": 1, "kind": "play", "result": ran})
    said = page.get("/state").json()["state"]
    assert shlex.split(said["commands"]["play"])[-2:] == ["--feed-override", "50%"]
    assert said["result"]["override"] == 0.5 and said["busy"] is None


def test_an_override_is_of_the_machine_that_the_program_is_for(
    page: TestClient, bench: Bench
) -> None:
    """Another machine that is set after the run has not run yet."""
    assert not does(page, bench, do="set", option="--machine", value="grbl-router")
    bench.kept.begin(bench.words())
    bench.kept.keep({"program": "cam.nc", "placed": [], "override": 1.0, "figures": {}})
    assert not does(page, bench, do="set", option="--machine", value="marlin")
    assert not does(page, bench, do="override", share=0.5)
    _, _, _, (job, _, _) = bench.workshop.sent[-1]  # type: ignore[attr-defined]
    assert job.control.given() and job.by_hand.machine == "grbl-router"
