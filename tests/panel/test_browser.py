"""The whole way in a browser: open, scale, choose, run, save; reload, kill, a second page."""

from __future__ import annotations

import shutil
import signal
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
    morfax,
    on_screen,
    opened,
    ran,
    settled,
    soon,
)


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


def set_a_cutter(page: Any) -> None:
    """Set scale, lines, machine and cutter on the page; a cutter that is none is refused."""
    page.fill("#field--width", "80mm")
    page.press("#field--width", "Enter")
    page.wait_for_selector("text=80.0 ×")
    page.click("#which >> text=Contours")
    page.select_option("#field--machine", "grbl-router")
    page.fill("#field--cutter", "3 apples")
    page.press("#field--cutter", "Enter")
    page.wait_for_selector("#field--cutter-refused:has-text('apples')")
    page.fill("#field--cutter", "2mm")
    page.press("#field--cutter", "Enter")
    page.wait_for_selector("#command:has-text('--cutter 2mm')")


def test_what_the_page_saves_is_byte_for_byte_what_its_commands_write(
    server: Server, page: Any, tmp_path: Path
) -> None:
    # 1. run and save
    set_a_cutter(page)
    page.select_option("#pace", "0.1")  # so slow that the run is seen
    page.click("#run-button")
    page.wait_for_selector("#stop:not([disabled])")
    page.select_option("#pace", label="fast")
    ran(page)
    page.click("[data-save='.dxf']")
    page.wait_for_selector("#files a >> text=bracket.dxf", timeout=RUN_MS)
    page.wait_for_selector("#run-button:not([disabled])")
    page.click("[data-save='.html']")
    page.wait_for_selector("#files a >> text=bracket.html", timeout=RUN_MS)
    typed = list[str]()
    for kind in ("run", ".dxf"):
        page.select_option("#command-kind", kind)
        typed.append(page.inner_text("#command"))
    # 2. the same commands, typed
    shutil.copy(server.folder / "bracket.png", tmp_path)
    for command in typed:
        morfax(tmp_path, command)
    written = {file.name: file.read_bytes() for file in (tmp_path / "bracket.panel").iterdir()}
    assert {
        "bracket.dxf",
        "bracket.traced.csv",
        "bracket.played.csv",
        "bracket.png",
    } < written.keys()
    for name, content in written.items():
        assert (server.folder / "bracket.panel" / name).read_bytes() == content, name
        # and what the browser downloads
        with page.expect_download() as download:
            page.click(f"#files a >> text='{name}'")
        assert Path(download.value.path()).read_bytes() == content


# The server's answers to what is done are kept until they are let go
HELD = """() => {
  const asked = window.fetch, free = new Promise((letGo) => { window.letGo = letGo; });
  window.said = false;
  window.fetch = async (where, ...what) => {
    const answer = await asked(where, ...what);
    if (where === "/do") { await free; setTimeout(() => { window.said = true; }); }
    return answer;
  };
}"""


def test_a_correction_on_the_page_is_the_one_that_its_command_writes(
    server: Server, page: Any, tmp_path: Path
) -> None:
    page.evaluate(HELD)
    page.click("#help-open")
    page.click("[data-tool=rub]")
    box = settled(page, "#sheet")
    x, y = box["x"] + 0.5 * box["width"], box["y"] + 0.25 * box["height"]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 30, y + 10, steps=4)
    page.mouse.up()
    page.wait_for_selector("#corrections li", timeout=RUN_MS)
    page.select_option("#command-kind", "correct")
    shutil.copy(server.folder / "bracket.png", tmp_path)
    morfax(tmp_path, page.inner_text("#command"))
    file = server.folder / "bracket.morfax.toml"
    assert file.read_bytes() == (tmp_path / "bracket.morfax.toml").read_bytes()
    # by the keyboard as well: the cross in the middle of the sheet; the answer to the first comes meanwhile
    page.focus("#sheet")
    page.keyboard.press("b")
    page.keyboard.press("Enter")
    page.evaluate("letGo()")
    soon(lambda: bool(page.evaluate("said")))  # the page lets no string be waited for
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("Enter")
    page.wait_for_selector("#corrections li:nth-child(2)", timeout=RUN_MS)
    assert "bridge" in file.read_text()
    # undone, one after the other
    page.click("#undo")
    soon(lambda: "bridge" not in file.read_text())
    page.click("#undo")
    soon(lambda: not file.exists())


def ring_with_a_gap(file: Path) -> tuple[tuple[float, float], tuple[float, float]]:
    """Draw a ring of 25 mm with a gap of 6 mm at 300 dpi; the places of its two ends, pixels."""
    import cv2
    import numpy as np
    from PIL import Image

    middle, radius, half = 200, 148, np.degrees(3.0 / 12.5)
    paper = np.full((400, 400), 245, np.uint8)
    cv2.ellipse(
        paper, (middle, middle), (radius, radius), 0, half, 360 - half, 20, 6, cv2.LINE_AA
    )
    Image.fromarray(paper).save(file, dpi=(300, 300))
    x, y = radius * np.cos(np.radians(half)), radius * np.sin(np.radians(half))
    return (middle + x, middle - y), (middle + x, middle + y)


def test_a_gap_of_6_mm_is_bridged_and_the_program_is_the_commands(
    server: Server, page: Any, tmp_path: Path
) -> None:
    # 1. dropped on the page, and run: the line ends at the gap
    ends = ring_with_a_gap(tmp_path / "ring.png")
    page.set_input_files("#upload", tmp_path / "ring.png")
    page.wait_for_selector("#title:has-text('ring.png')")
    page.wait_for_selector("#lines li:has-text('open')", timeout=RUN_MS)
    page.click("#run-button")
    page.wait_for_selector("#figures:has-text('ended')", timeout=RUN_MS)
    # 2. bridged from end to end, and run again: it closes
    page.click("#zoom-all")
    places = [on_screen(page, x, y) for x, y in ends]
    page.click("#help-open")
    page.click("[data-tool=bridge]")
    page.mouse.move(*places[0])
    page.mouse.down()
    page.mouse.move(*places[1], steps=3)
    page.mouse.up()
    page.wait_for_selector("#lines li:has-text('closed')", timeout=RUN_MS)
    typed = [page.inner_text("#command")]
    page.click("#run-button")
    page.wait_for_selector("#figures:has-text('closed')", timeout=RUN_MS)
    # 3. the same commands, typed beside a copy
    page.select_option("#command-kind", "correct")
    typed.insert(0, page.inner_text("#command"))
    folder = tmp_path / "bracket.panel"
    (folder / "drawings").mkdir(parents=True)
    shutil.copy(tmp_path / "ring.png", folder / "drawings")
    for command in typed:
        morfax(tmp_path, command)
    for name in ("drawings/ring.morfax.toml", "ring.wav", "ring.traced.csv", "ring.played.csv"):
        made = (server.folder / "bracket.panel" / name).read_bytes()
        assert made == (folder / name).read_bytes(), name


def test_a_tile_that_is_asked_for_when_another_drawing_lies_there_is_no_fault(
    page: Any, tmp_path: Path
) -> None:
    """A request that waits in a busy browser until the sheet has changed."""
    waiting = list[Any]()
    page.route("**/tile/**", lambda tile: tile.continue_() if waiting else waiting.append(tile))
    page.reload()
    soon(lambda: bool(page.wait_for_timeout(50) or waiting))
    ring_with_a_gap(tmp_path / "later.png")
    page.set_input_files("#upload", tmp_path / "later.png")
    page.wait_for_selector("#title:has-text('later.png')")
    page.wait_for_selector("#lines li:has-text('open')", timeout=RUN_MS)
    with page.expect_response(waiting[0].request.url) as answered:
        waiting[0].continue_()
    assert answered.value.status == 204
    # the page itself is asked once more when it closes: it has not complained


def test_a_reload_a_second_page_and_a_killed_server_lose_nothing(
    chromium: Any, tmp_path: Path
) -> None:
    server = Server(tmp_path / "page")  # of its own: nothing has been run yet
    try:
        with looked_at(chromium, server) as page:
            _killed_in_mid_run(server, page, chromium)
    finally:
        server.end()


def _killed_in_mid_run(server: Server, page: Any, chromium: Any) -> None:
    page.select_option("#pace", "1")  # so slow that it can be held
    page.click("#run-button")
    soon(lambda: page.evaluate("panel.head.now?.travel_mm ?? 0") > 25)
    page.click("#hold")
    page.wait_for_selector("#words:has-text('held')")
    # 1. a reload in mid run, and a second page
    page.reload()
    page.wait_for_selector("#words:has-text('held')")
    second = chromium.new_page()
    second.set_default_timeout(WAIT_MS)
    opened(second, server)
    second.wait_for_selector("#words:has-text('held')")
    assert second.input_value("#field--cutter") == page.input_value("#field--cutter")
    # 2. the server killed in mid run: it is started again, and the head goes on
    command = page.inner_text("#command")
    kept = server.folder / "bracket.panel" / "result.json"
    server.end(signal.SIGKILL)
    assert not kept.exists()
    server.start()
    opened(second, server)
    said = second.locator("#messages")
    api.expect(said).to_contain_text("the server was ended in the middle", timeout=RUN_MS)
    api.expect(said).to_contain_text("the head goes on where it was", timeout=RUN_MS)
    second.select_option("#pace", label="fast")
    second.select_option("#command-kind", "run")
    api.expect(second.locator("#command")).to_have_text(command, timeout=WAIT_MS)
    ran(second)
    assert kept.exists()
    second.close()
