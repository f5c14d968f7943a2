"""What an operator drags and sets on the page: order, start and direction, override, own files, the tape."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from morfax.motion.pathfile import read_path
from morfax.motion.polyline import area_mm2
from tests.panel.browsing import (
    ROOT,
    RUN_MS,
    WAIT_MS,
    Server,
    api,
    command,
    looked_at,
    morfax,
    on_screen,
    run_through,
    soon,
)
from tests.tracer.inked import DPI, arc, inked, polyline

PLATE = inked(
    polyline((6, 6), (46, 6), (46, 30), (6, 30), (6, 6)),
    arc((16, 18), 5),
    arc((36, 18), 4),
    seed=2,
)
ROWS = len(PLATE.darkness)


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """One server for all, with a plate that has two holes."""
    drawing = tmp_path_factory.mktemp("drawing") / "plate.png"
    levels = np.clip(255 - 235 * PLATE.darkness, 0, 255).astype(np.uint8)
    Image.fromarray(levels).save(drawing, dpi=(DPI, DPI))
    server = Server(tmp_path_factory.mktemp("controls") / "page", drawing)
    yield server
    server.end()


@pytest.fixture
def page(server: Server, chromium: Any) -> Iterator[Any]:
    """The page, opened by its address."""
    with looked_at(chromium, server) as page:
        yield page


def shows(page: Any, text: str) -> None:
    """Wait until the shown command of the run has a text."""
    page.select_option("#command-kind", "run")
    api.expect(page.locator("#command")).to_contain_text(text, timeout=WAIT_MS)


def drag(page: Any, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Drag from a place of the window to another."""
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(*end, steps=5)
    page.mouse.up()


def at_mm(page: Any, x: float, y: float) -> tuple[float, float]:
    """Where a place of the sheet is in the window."""
    return on_screen(page, x / PLATE.pitch_mm, ROWS - y / PLATE.pitch_mm)


def rows(page: Any) -> list[str]:
    """The numbers of the lines as they are listed."""
    found: list[str] = page.eval_on_selector_all(
        "#lines li", "all => all.map(r => r.dataset.row)"
    )
    return found


def runs_as_the_page_did(server: Server, page: Any, folder: Path) -> list[np.ndarray]:
    """Run the page and its command; both write the same. The lines that were cut, (n, 2) mm each."""
    typed = command(page)
    assert typed.count("--arrow") == 2
    run_through(page)
    shutil.copy(server.folder / "plate.png", folder)
    morfax(folder, typed)
    for name in ("plate.wav", "plate.traced.csv", "plate.json"):
        made = (server.folder / "plate.panel" / name).read_bytes()
        assert made == (folder / "plate.panel" / name).read_bytes(), name
    runs = read_path(folder / "plate.panel" / "plate.traced.csv").runs()
    return [run[:, :2] for run in runs]


def test_order_and_arrows_are_dragged_and_the_command_does_the_same(
    server: Server, page: Any, tmp_path: Path
) -> None:
    # 1. the order: dragged in the list, and by keys
    page.click("#which >> text=Contours")
    page.wait_for_selector("[data-handle='3']")
    assert rows(page) == ["1", "2", "3"]
    first = page.locator("#lines li").first.bounding_box()
    handle = page.locator("[data-handle='3']").bounding_box()
    x = handle["x"] + 0.5 * handle["width"]
    drag(page, (x, handle["y"] + 0.5 * handle["height"]), (x, first["y"] + 2))
    shows(page, "--order 3,1,2")
    assert rows(page) == ["3", "1", "2"]
    page.focus("[data-handle='1']")
    page.keyboard.press("ArrowDown")
    shows(page, "--order 3,2,1")
    assert page.evaluate("document.activeElement.dataset.handle") == "1"
    # 2. start and direction: an arrow dragged on a line, and one by keys
    soon(
        lambda: page.evaluate("Boolean(panel.sheet.picture.has_lines && panel.sheet.ground.at)")
    )
    page.keyboard.press("a")
    drag(page, at_mm(page, 26, 30), at_mm(page, 20, 30))
    shows(page, "--arrow 26")
    page.focus("#sheet")
    page.evaluate("panel.sheet.goTo([16, 23], 12)")
    page.keyboard.press("Enter")
    for _ in range(3):
        page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("Enter")
    page.wait_for_selector("#arrows li:nth-child(2)", timeout=WAIT_MS)
    # 3. what the command does is what the page did
    cut = runs_as_the_page_did(server, page, tmp_path)
    assert [round(float(np.ptp(run[:, 0]))) for run in cut] == [8, 10, 40]  # 3, 2, 1
    # the head is put down at the plainest place within two widths of the line, 1 mm
    assert np.hypot(*(cut[2][0] - (26, 30))) < 1.1
    assert area_mm2(cut[2]) > 0  # to the left along the upper edge
    # 4. taken away, and undone
    page.click("[aria-label='Take arrow 1 away']")
    api.expect(page.locator("#arrows li")).to_have_count(1, timeout=WAIT_MS)
    page.click("#undo")
    api.expect(page.locator("#arrows li")).to_have_count(2, timeout=WAIT_MS)


def test_the_machine_runs_again_at_the_override_and_the_tape_is_scrubbed(page: Any) -> None:
    if page.is_hidden("#machine"):
        run_through(page)
    # 1. commanded and actual, the following error against its limit, done and left
    slider = page.locator("#machine .bar > input[type=range]")
    whole_s = float(slider.get_attribute("max"))
    slider.evaluate("s => { s.value = 0.5 * s.max; s.dispatchEvent(new Event('input')); }")
    cells = page.locator(".axes tbody td").all_inner_texts()
    told, stands = ([float(v) for v in cells[k : k + 3]] for k in (0, 3))
    assert np.allclose(told, stands, atol=0.05) and any(stands)
    assert " of " in page.inner_text(".dial:has-text('Following error') b")
    assert page.inner_text(".tool") in ("up", "down")
    # 2. at 50 % it takes twice as long, and stands at the same share of its way
    page.locator("#override").evaluate(
        "s => { s.value = 50; s.dispatchEvent(new Event('change')); }"
    )
    soon(lambda: abs(float(slider.get_attribute("max")) / whole_s - 2.0) < 0.05)
    assert float(slider.input_value()) == pytest.approx(whole_s, rel=0.1)
    assert "at 50 %" in page.inner_text(".dial:has-text('Feed') b")
    assert "--feed-override 50%" in command(page, "play")
    # 3. the tape, by keys
    page.click("[data-scope=Tape]")
    strip = page.locator("canvas.tape")
    strip.focus()
    page.keyboard.press("Home")
    assert strip.get_attribute("aria-valuenow") == "0.00"
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    assert float(strip.get_attribute("aria-valuenow")) == pytest.approx(0.1 * whole_s, rel=0.1)
    assert page.locator(".tracks span").count() == 4
    assert "locked" in page.inner_text(".tracks")


def test_files_of_ones_own_are_chosen_dropped_and_refused_in_words(
    page: Any, tmp_path: Path
) -> None:
    for summary in ("Card and stops", "Head and placement"):
        page.click(f"summary >> text={summary}")
    # 1. a card with a mistake: its line is named beside the field
    (tmp_path / "wrong.toml").write_text("depth = 'deep'\n")
    page.set_input_files("[data-own='--card']", tmp_path / "wrong.toml")
    page.wait_for_selector("#field--card-refused:has-text('line 1')")
    # 2. a good one, and a machine that is dropped on the sheet
    shutil.copy(ROOT / "samples" / "program.toml", tmp_path / "card.toml")
    page.set_input_files("[data-own='--card']", tmp_path / "card.toml")
    shows(page, "--card plate.panel/own/card.toml")
    assert page.input_value("#field--card") == "card.toml"
    from morfax.recorder.gcode.machine import as_toml

    dropped = """([name, text]) => {
        const data = new DataTransfer();
        data.items.add(new File([text], name));
        const drop = new DragEvent("drop", { dataTransfer: data, bubbles: true });
        document.getElementById("bench").dispatchEvent(drop);
    }"""
    page.evaluate(dropped, ["shed.toml", as_toml("grbl-router")])
    shows(page, "--machine plate.panel/own/shed.toml")
    # 3. taken away again
    page.select_option("#field--card", "")
    page.select_option("#field--machine", "")
    soon(lambda: "own/" not in command(page))
    page.wait_for_selector("#run-button:not([disabled])", timeout=RUN_MS)


def test_a_press_below_a_field_counts_though_its_help_goes_with_the_focus(page: Any) -> None:
    """The help of a field that was typed into went as the button below was pressed, which moved away."""
    page.wait_for_selector("#lines li", timeout=RUN_MS)
    page.focus("#field--width")
    api.expect(page.locator("#field--width-help")).to_be_visible()
    page.click("#which >> text=All ink")
    shows(page, "--lines all")
    page.click("#which >> text=Longest")
    api.expect(page.locator("#command")).not_to_contain_text("--lines all", timeout=WAIT_MS)
    api.expect(page.locator("#field--width-help")).to_be_hidden()


def test_names_on_the_sheet_do_not_hide_each_other_and_the_list_says_how_many_there_are(
    page: Any,
) -> None:
    """Of a word's letters only the last number could be read; the list showed seven of 22 lines."""
    page.wait_for_selector("#lines li")
    assert page.inner_text("#lines-count") == "1 of 3"
    page.click("#which >> text=Contours")
    api.expect(page.locator("#lines-count")).to_have_text("3 of 3", timeout=WAIT_MS)
    places = page.evaluate(
        """async () => {
            const { besideOthers } = await import("/page/layers.js");
            const context = document.createElement("canvas").getContext("2d"), taken = [];
            return [0, 1, 2, 9].map((k) => besideOthers(context, taken, 30 * k, 50, 1, "unexplained 1"));
        }"""
    )
    heights = [y for _, y in places]
    assert heights == [50, 67, 84, 50]  # below one another where they are near, and no further
