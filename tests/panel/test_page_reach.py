"""Whom the page reaches: without a network as a saved file, by the keyboard alone, and by a screen reader.

axe-core comes from npm: `.ci/run` fetches it, and MORFAX_AXE names its axe.min.js.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.panel.browsing import (
    RUN_MS,
    WAIT_MS,
    Server,
    api,
    looked_at,
    ran,
    soon,
)

AXE = os.environ.get("MORFAX_AXE")


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """One server for all."""
    server = Server(tmp_path_factory.mktemp("panel") / "page")
    yield server
    server.end()


@pytest.fixture
def page(server: Server, chromium: Any) -> Iterator[Any]:
    """The page, opened by its address."""
    with looked_at(chromium, server) as page:
        yield page


def with_a_result(page: Any) -> None:
    """Have a result on the page, whichever tests ran before: a run is made if there was none."""
    page.wait_for_selector("#run-button:not([disabled])", timeout=RUN_MS)
    if page.evaluate("fetch('/state').then((a) => a.json())")["state"]["result"] is None:
        page.click("#run-button")
    ran(page)


def test_the_saved_page_opens_without_a_network_and_can_be_scrubbed(
    server: Server, page: Any, chromium: Any
) -> None:
    # 1. saved
    with_a_result(page)
    page.click("[data-save='.html']")
    page.wait_for_selector("#files a >> text=bracket.html", timeout=RUN_MS)
    # 2. opened
    context = chromium.new_context(offline=True)
    context.set_default_timeout(WAIT_MS)
    saved = context.new_page()
    asked, complaints = list[str](), list[str]()
    saved.on("request", lambda request: asked.append(request.url[:20]))
    saved.on("pageerror", lambda error: complaints.append(str(error)))
    saved.goto((server.folder / "bracket.panel" / "bracket.html").as_uri())
    saved.wait_for_selector("html[data-ready]")
    before = saved.inner_text("#machine .dro")
    saved.fill("#machine input[type=range]", "9")
    soon(lambda: saved.inner_text("#machine .dro") != before)
    assert not complaints and not [
        url for url in asked if not url.startswith(("file:", "data:"))
    ]
    context.close()


@pytest.mark.skipif(AXE is None, reason="no axe-core: MORFAX_AXE names its axe.min.js")
@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 390])
def test_axe_finds_no_serious_fault(page: Any, theme: str, width: int) -> None:
    assert AXE is not None
    page.emulate_media(reduced_motion="reduce")  # no colour is on its way to another
    page.set_viewport_size({"width": width, "height": 800})
    with_a_result(
        page
    )  # before the first run its card is not shown, and its details cannot be opened
    if page.get_attribute("html", "data-theme") != theme:
        page.click("#theme")
    page.wait_for_selector(f"html[data-theme={theme}]")
    closed = page.locator("details:not([open]) > summary")
    for _ in range(closed.count()):
        closed.first.click()
    api.expect(closed).to_have_count(0, timeout=WAIT_MS)
    assert page.is_visible("#all-figures")
    page.evaluate(Path(AXE).read_text(encoding="utf-8"))
    found = page.evaluate("axe.run()")
    serious = [
        (v["id"], v["nodes"][0]["html"][:90])
        for v in found["violations"]
        if v["impact"] in ("serious", "critical")
    ]
    assert not serious


def test_the_keyboard_reaches_everything_and_runs_the_panel(page: Any) -> None:
    page.evaluate("document.activeElement.blur()")
    reached = set[str]()
    for _ in range(90):
        page.keyboard.press("Tab")
        reached.add(
            page.evaluate(
                "document.activeElement.id || document.activeElement.dataset.tool || ''"
            )
        )
    assert {
        "sheet",
        "undo",
        "sources",
        "upload",
        "field--width",
        "field--machine",
        "run-button",
        "copy",
        "measure",
    } <= reached
    page.focus("#sheet")
    page.keyboard.press("m")
    assert page.get_attribute("[data-tool=measure]", "aria-pressed") == "true"
    page.keyboard.press("v")
    page.keyboard.press("+")
