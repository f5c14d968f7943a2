"""Files of the operator's own: a card, settings and a machine are taken if the command line takes them."""

from __future__ import annotations

import shlex

import pytest
from starlette.testclient import TestClient

from morfax.panel.bench import Bench
from tests.panel.conftest import ORIGIN, again
from tests.panel.serving import SAMPLES

CARD = (SAMPLES / "program.toml").read_bytes()
SETTINGS = b"sweep_hz = 50\n"


def sent(
    page: TestClient, option: str, name: str, content: bytes
) -> tuple[int, dict[str, str]]:
    """Send a file; the status and the answer."""
    answer = page.post(f"/own/{option}/{name}", content=content, headers=ORIGIN)
    is_json = answer.headers["content-type"].startswith("application/json")
    return answer.status_code, answer.json() if is_json else {"refused": answer.text}


def machine() -> bytes:
    """A machine of one's own, as `morfax machines` prints one."""
    from morfax.recorder.gcode.machine import as_toml

    return as_toml("grbl-router").encode()


def left(bench: Bench) -> list[str]:
    """What is in the folder, hidden files too."""
    folder = bench.folder / "own"
    return sorted(file.name for file in folder.iterdir()) if folder.exists() else []


def test_each_is_known_by_what_it_holds_and_stands_in_the_command(
    page: TestClient, bench: Bench
) -> None:
    for name, content, option in (
        ("my.toml", CARD, "--card"),
        ("head.toml", SETTINGS, "--settings"),
        ("mill.toml", machine(), "--machine"),
    ):
        assert sent(page, "any", name, content) == (200, {"option": option, "name": name})
        assert sent(page, option[2:], name, content)[1]["option"] == option  # as name-2.toml
        action = {"do": "set", "option": option, "value": name, "seen": bench.history.revision}
        assert page.post("/do", json=action, headers=ORIGIN).status_code == 200
        typed = shlex.split(page.get("/state").json()["state"]["commands"]["run"])
        assert typed[typed.index(option) + 1] == str(bench.folder / "own" / name)
    after = again(bench)  # nothing was closed
    assert after.words() == bench.words() and "mill.toml" in after.own


@pytest.mark.parametrize(
    ("option", "name", "content", "said"),
    [
        ("any", "a.toml", b"nonsense", "no card, no settings and no machine"),
        ("card", "a.toml", b"depth = 'deep'\n", "line 1"),
        ("settings", "a.toml", b"sweep_hz = 'fast'\n", "sweep_hz"),
        ("machine", "a.toml", b"\xff\x00", "toml"),
        ("machine", "a.toml", SETTINGS, "sweep_hz"),
        ("card", "a.png", CARD, "no .toml"),
        ("card", "..%2F..%2Fa.toml", CARD, "Not Found"),  # the router knows no such address
        ("output", "a.toml", CARD, "cards, settings and machines"),
        ("card", "a.toml", b"#" * 1_000_001, "larger than 1 MB"),
    ],
)
def test_what_is_none_is_refused_in_words_and_leaves_nothing(
    page: TestClient, bench: Bench, option: str, name: str, content: bytes, said: str
) -> None:
    status, answer = sent(page, option, name, content)
    assert status in (404, 409) and said in answer["refused"]
    assert not left(bench) and not bench.own


def test_a_name_is_never_a_path(page: TestClient, bench: Bench) -> None:
    assert sent(page, "card", "..my <b>card.toml", CARD)[0] == 200
    assert left(bench) == ["my-b-card.toml"]
    action = {"do": "set", "option": "--card", "seen": bench.history.revision}
    for value in (
        "/etc/passwd",
        "../own/my-b-card.toml",
        str(bench.folder / "own" / "my-b-card.toml"),
    ):
        answer = page.post("/do", json={**action, "value": value}, headers=ORIGIN)
        assert (
            answer.status_code == 409 and "a file of your own" not in answer.json()["refused"]
        )
