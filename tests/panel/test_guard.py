"""Who may ask the server: token, cookie, Host, Origin; and what the browser may do with its answers."""

from __future__ import annotations

import pytest
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from morfax.jobs.wrong_use import WrongUse
from morfax.panel import server
from tests.panel.conftest import HOST, ORIGIN, TOKEN

PLACES = ("/", "/state", "/result", "/page/main.js", "/tile/1/sheet/0/0/0", "/file/cam.wav")


@pytest.mark.parametrize("place", PLACES)
def test_nothing_is_answered_without_the_token(stranger: TestClient, place: str) -> None:
    answer = stranger.get(place)
    assert answer.status_code == 403 and "open the whole address" in answer.text
    assert stranger.get(place, params={"token": TOKEN[:-1]}).status_code == 403


def test_the_token_opens_once_and_leaves_a_cookie_for_this_site_alone(
    stranger: TestClient,
) -> None:
    answer = stranger.get(f"/?token={TOKEN}")
    assert answer.status_code == 303 and answer.headers["location"] == "/"
    cookie = answer.headers["set-cookie"].lower()
    assert "httponly" in cookie and "samesite=strict" in cookie
    assert stranger.get("/").status_code == 200


@pytest.mark.parametrize(
    "host", ["evil.example", "127.0.0.1", "127.0.0.1:80", "127.0.0.1.evil.example:8017", ""]
)
def test_another_name_for_this_computer_is_refused(page: TestClient, host: str) -> None:
    assert page.get("/state", headers={"host": host}).status_code == 403


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "http://127.0.0.1:80", f"https://{HOST}", None]
)
def test_a_change_that_another_page_asks_for_is_refused(
    page: TestClient, origin: str | None
) -> None:
    headers = {} if origin is None else {"origin": origin}
    before = page.get("/state").json()["state"]["revision"]
    for place in ("/do", "/upload/a.png"):
        assert page.post(place, content=b'{"do": "undo"}', headers=headers).status_code == 403
    assert page.get("/state").json()["state"]["revision"] == before


@pytest.mark.parametrize("origin", ["http://evil.example", None])
def test_another_page_cannot_watch(page: TestClient, origin: str | None) -> None:
    headers = {} if origin is None else {"origin": origin}
    watch = f"ws://{HOST}/watch"
    with (
        pytest.raises(WebSocketDisconnect) as refused,
        page.websocket_connect(watch, headers=headers),
    ):
        pass
    assert "another page" in refused.value.reason
    with page.websocket_connect(watch, headers=ORIGIN) as socket:
        assert socket.receive_json()["state"]["drawing"] == "cam.png"


@pytest.mark.parametrize("place", ["/", "/state", "/nothing", "/page/style.css"])
def test_every_answer_forbids_inline_scripts_and_other_machines(
    page: TestClient, place: str
) -> None:
    policy = page.get(place).headers["content-security-policy"]
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    assert rules["default-src"] == "'none'" and rules["script-src"] == "'self'"
    assert (
        rules["frame-ancestors"] == "'none'" and "unsafe" not in policy and "http" not in policy
    )


def test_the_page_itself_keeps_the_policy(page: TestClient) -> None:
    text = page.get("/").text
    assert "<script>" not in text and " on" + "click=" not in text and "style=" not in text
    assert "http://" not in text and "https://" not in text


@pytest.mark.parametrize(
    "place",
    ["/page/..%2fapp.py", "/page/../app.py", "/file/..%2f..%2fcam.png", "/file/state.json"],
)
def test_names_are_no_paths(page: TestClient, place: str) -> None:
    assert page.get(place).status_code == 404


def test_other_computers_need_a_token_that_somebody_chose() -> None:
    assert server.checked("127.0.0.1", None).token != server.checked("127.0.0.1", None).token
    with pytest.raises(WrongUse, match="lets other computers"):
        server.checked("0.0.0.0", None)
    with pytest.raises(WrongUse, match="16 or more"):
        server.checked("0.0.0.0", "short")
