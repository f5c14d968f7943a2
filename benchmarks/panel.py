"""The panel's page on a sheet of 35 million pixels: how it pans, and what that takes.

    python -m benchmarks panel [FOLDER]

A sheet of 7000 × 5000 pixels with forty lines is opened in Chromium, 1280 × 800, and
dragged to and fro, at one screen pixel to one of the picture and with all of it in view. Printed for both:

    frames/s      that Chromium drew, from its own trace (frames presented), and its longest wait between two
    main, ms      processor time of the page's own thread to a frame, from the trace
    all, ms       processor time of all of Chromium to a frame: with drawing in software, and no graphics card

On a machine that has other work only the processor times mean anything.
"""

from __future__ import annotations

import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from PIL import Image

ROOT = Path(__file__).parents[1]
ROWS, COLUMNS, DPI = 5000, 7000, 400
LOOK_MS = 600_000  # to look for the lines, beside other work
SECONDS = 4.0
CATEGORIES = (
    "toplevel,devtools.timeline,disabled-by-default-devtools.timeline,devtools.timeline.frame"
)


def drawing(file: Path) -> None:
    """Draw forty rings and boxes on a sheet, with the noise of a scan."""
    rng = np.random.default_rng(1)
    paper = np.full((ROWS, COLUMNS), 244, np.uint8)
    for k in range(40):
        middle = 500 + 850 * (k % 8), 500 + 950 * (k // 8)
        if k % 2:
            cv2.circle(paper, middle, 330, 20, 9, cv2.LINE_AA)
        else:
            corner = [(middle[0] + a * 330, middle[1] + a * 330) for a in (-1, 1)]
            cv2.rectangle(paper, *corner, 20, 9, cv2.LINE_AA)
    paper = np.clip(paper + rng.normal(0, 3, paper.shape), 0, 255).astype(np.uint8)
    Image.fromarray(paper).save(file, dpi=(DPI, DPI), compress_level=1)


def spent_s(pid: int) -> float:
    """Processor time of a process and all its children, s."""
    tree, total = [pid], 0.0
    while tree:
        one = tree.pop()
        try:
            fields = Path(f"/proc/{one}/stat").read_text().rsplit(")", 1)[1].split()
            total += (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
            for task in Path(f"/proc/{one}/task").iterdir():
                tree += [int(child) for child in (task / "children").read_text().split()]
        except OSError:
            continue  # it has ended
    return total


def panned(page: Any, cdp: Any, chromium: int) -> dict[str, float]:
    """Drag the sheet to and fro, and measure."""
    events: list[dict[str, Any]] = []
    ended: list[bool] = []
    cdp.on("Tracing.dataCollected", lambda data: events.extend(data["value"]))
    cdp.on("Tracing.tracingComplete", lambda _: ended.append(True))
    cdp.send("Tracing.start", {"categories": CATEGORIES, "transferMode": "ReportEvents"})
    page.mouse.move(450, 350)
    page.mouse.down()
    spent, began, k = spent_s(chromium), time.monotonic(), 0
    while time.monotonic() - began < SECONDS:
        k += 1
        way = k % 120 if k % 240 < 120 else 120 - k % 120
        page.mouse.move(450 - 3.3 * way, 350 - 1.7 * way)
    seconds, spent = time.monotonic() - began, spent_s(chromium) - spent
    page.mouse.up()
    cdp.send("Tracing.end")
    while not ended:
        page.wait_for_timeout(50)
    frames = sorted(e["ts"] for e in events if e["name"] == "AnimationFrame::Presentation")
    main = {
        (e["pid"], e["tid"])
        for e in events
        if e["name"] == "thread_name" and e["args"]["name"] == "CrRendererMain"
    }
    on_main_us = sum(
        e.get("tdur", 0)
        for e in events
        if e["name"].endswith("RunTask") and (e["pid"], e["tid"]) in main and e["ph"] == "X"
    )
    waits = np.diff(frames) / 1000 if len(frames) > 1 else np.array([np.nan])
    count = max(1, len(frames))
    return {
        "frames_s": round(len(frames) / seconds, 1),
        "median_wait_ms": round(float(statistics.median(waits)), 1),
        "longest_wait_ms": round(float(np.max(waits)), 1),
        "main_ms": round(on_main_us / 1000 / count, 2),
        "all_ms": round(1000 * spent / count, 1),
    }


def measured(folder: Path) -> None:
    """Measure and print."""
    from playwright.sync_api import sync_playwright

    file = folder / "large.png"
    if not file.exists():
        drawing(file)
    words = [sys.executable, "-m", "morfax", "panel", file.name, "--no-browser"]
    server = subprocess.Popen(
        words,
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        text=True,
    )
    assert server.stdout is not None
    address = server.stdout.readline().strip()
    try:
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(
                executable_path=shutil.which("chromium"), args=["--no-sandbox"]
            )
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.goto(address)
            page.wait_for_selector("#lines li", timeout=LOOK_MS)
            page.wait_for_timeout(2000)
            chromium = int(_children(os.getpid(), server.pid))
            cdp = page.context.new_cdp_session(page)
            for name, set_up in (
                ("one to one", "panel.sheet.zoom(1 / panel.sheet.view.scale)"),
                ("all of it", "panel.sheet.all()"),
            ):
                page.evaluate(set_up)
                page.wait_for_timeout(3000)  # the tiles are there
                print(json.dumps({"view": name, **panned(page, cdp, chromium)}), flush=True)
            browser.close()
    finally:
        server.terminate()
        server.wait(30)
        print("load", os.getloadavg()[0])


def _children(own: int, server: int) -> int:
    """The process of which Chromium is a child: playwright's driver."""
    for task in Path(f"/proc/{own}/task").iterdir():
        for child in (task / "children").read_text().split():
            if int(child) != server:
                return int(child)
    raise RuntimeError("no browser")


def main(words: list[str]) -> None:
    """Measure in a folder that is named, or in one that is taken away afterwards."""
    if words:
        measured(Path(words[0]))
        return
    with tempfile.TemporaryDirectory() as made:
        measured(Path(made))
