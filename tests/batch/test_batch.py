"""The batch as its user meets it: folders, the manifest, a second call, the page, faults and wrong use."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.batch import crew, manifest, search
from morfax.batch.job import BatchJob
from morfax.batch.manifest import Manifest
from morfax.batch.one import there_already
from morfax.batch.order import Order
from morfax.batch.page import wants_eye, write_page
from morfax.batch.results import LocalResults
from morfax.batch.row import BatchRow
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.settings import HeadSettings, TraceSettings
from morfax.motion.faults import FileFault
from tests.console.conftest import Morfax, here, morfax

__all__ = ["here", "morfax"]
FILES = {"path.csv", "program.ngc", "picture.png", "figures.json"}


@pytest.fixture(autouse=True, scope="module")
def kernels() -> None:
    """Kernels are compiled before: else a worker does it within the time of its first drawing."""
    root = Path(__file__).parents[2]
    subprocess.run([sys.executable, "-c", "import morfax.batch.warm"], cwd=root, check=True)


@pytest.fixture(autouse=True)
def light(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fork from a process that has not traced anything: that takes longer than these tests."""
    monkeypatch.setattr(crew, "WARM", ("morfax.batch.one", "cv2"))


@pytest.fixture
def scans(here: Path) -> Path:
    """Two rings in two folders, an empty sheet, a file that is no picture."""
    folder = here / "scans"
    (folder / "deep").mkdir(parents=True)
    for name, radius in (("small", 47), ("deep/large", 71), ("empty", 0)):
        grey = np.full((200, 200), 245, np.uint8)
        if radius:
            cv2.circle(grey, (100, 100), radius, 30, 6, cv2.LINE_AA)
        Image.fromarray(grey).save(folder / f"{name}.png", dpi=(300, 300))
    (folder / "bad.png").write_bytes(b"no picture")
    (folder / "notes.txt").write_text("no drawing")
    return folder


def rows_of(out: Path) -> list[dict[str, Any]]:
    """The lines of the manifest."""
    return [json.loads(line) for line in (out / manifest.NAME).read_text().splitlines()]


def test_every_drawing_has_its_folder_and_is_not_done_again(
    morfax: Morfax, scans: Path
) -> None:
    call = ("batch", "scans", "-o", "out", "--jobs", "1", "--json")
    answer = morfax(*call)
    assert answer.exit_code == 1, answer.err
    assert (answer.figures["done"], answer.figures["failed"]) == (2, 2)
    assert "morfax batch --report out shows all drawings on a page" in answer.err
    rows = {Path(row["file"]).name: row for row in rows_of(Path("out"))}
    assert {name: row["ending"] for name, row in rows.items()} == {
        **{"small.png": "done", "large.png": "done"},
        **{"empty.png": "fault", "bad.png": "fault"},
    }
    for name, radius_px in (("small.png", 47), ("large.png", 71)):
        folder = Path("out", rows[name]["folder"])
        assert {file.name for file in folder.iterdir()} == FILES
        length_mm = json.loads((folder / "figures.json").read_text())["figures"]["length_mm"]
        assert length_mm == pytest.approx(2 * np.pi * radius_px * 25.4 / 300, rel=0.005)
        # all but the paler edge of the ink lies under the path
        assert rows[name]["figures"]["ink_followed_share"] > 0.99
    assert (
        rows["empty.png"]["code"] == 3
        and "no line on the drawing" in rows["empty.png"]["fault"]
    )
    assert list(Path("out", ".unfinished").iterdir()) == []
    # a second call does nothing and adds no line; a drawing that was changed is another one
    whole = {file: file.stat().st_mtime_ns for file in Path("out").rglob("*.csv")}
    shutil.copy("scans/deep/large.png", "scans/small.png")
    again = morfax(*call).figures
    assert again["there_already"] == 3 and again["drawings"] == 4
    assert {f: f.stat().st_mtime_ns for f in Path("out").rglob("*.csv") if f in whole} == whole
    assert len(rows_of(Path("out"))) == 5
    # the page, by the command that was told, shows each drawing once, those without a result first
    assert morfax("batch", "--report", "out").exit_code == 0
    page, count = write_page(Path("out"))
    text = page.read_text()
    assert count == 4 and text.count("<img") == 3
    assert text.index("bad.png") < text.index("large.png")


def test_an_interrupted_batch_goes_on_where_it_was(scans: Path) -> None:
    shutil.rmtree(scans)
    scans.mkdir()
    for name in "abcd":  # no pictures, which is soon found out
        (scans / f"{name}.png").write_text(name)
    job = BatchJob("scans", "out", limits=crew.WorkerLimits(1))
    rows = job.rows()
    first = next(rows)
    rows.close()
    assert len(rows_of(Path("out"))) == 1
    rest = [row for row in job.rows() if not row.kept]
    assert {Path(row.file).stem for row in (first, *rest)} == set("abcd")
    assert len(rest) == 3 and len(rows_of(Path("out"))) == 4


def test_the_hash_is_of_content_settings_and_corrections(scans: Path) -> None:
    file, order = scans / "small.png", Order()
    name, hashed = order.folder_name(file)
    assert name == f"small-{hashed[:12]}" and order.folder_name(file) == (name, hashed)
    faster = TraceSettings(head=HeadSettings(speed_mm_s=20.0))
    with_card = replace(faster, program=replace(faster.program, card_file=Path("card.toml")))
    Path("card.toml").write_text("depths = [1.0]")
    others = {hashed, replace(order, settings=faster).folder_name(file)[1]}
    others.add(replace(order, settings=with_card).folder_name(file)[1])
    Path("card.toml").write_text("depths = [2.0]")
    others.add(replace(order, settings=with_card).folder_name(file)[1])
    (scans / "small.morfax.toml").write_text("")
    others.add(order.folder_name(file)[1])
    file.write_bytes(file.read_bytes() + b" ")
    others.add(order.folder_name(file)[1])
    assert len(others) == 6
    with pytest.raises(FileFault):
        order.folder_name(scans / "none.png")


def test_patterns_choose_files_without_a_list(scans: Path) -> None:
    def named(pattern: str | None) -> set[str]:
        found = search.drawings(str(scans), pattern)
        assert isinstance(found, Iterator)
        return {Path(name).name for name in found}

    assert named(None) == {"small.png", "large.png", "empty.png", "bad.png"}
    assert named("*.png") == {"small.png", "empty.png", "bad.png"}
    assert named("**/*a??e.png") == {"large.png"}
    assert named("deep/**") == {"large.png"}
    assert named("**/*.txt") == {"notes.txt"}


def test_a_manifest_survives_a_line_that_was_cut_short(tmp_path: Path) -> None:
    with Manifest(tmp_path) as written:
        written.append(BatchRow("a.png", "done", hash="0" * 64, folder="a"))
    with (tmp_path / manifest.NAME).open("a") as stream:
        stream.write('{"file": "b.png", "end')
    assert [row.file for row in manifest.rows(tmp_path)] == ["a.png"]
    with Manifest(tmp_path) as written:  # which begins on a line of its own
        written.append(BatchRow("a.png", "done", hash="0" * 64, folder="a", kept=True))
        written.append(BatchRow("c.png", "done", hash="1" * 64, folder="c", kept=True))
    assert [row.file for row in manifest.rows(tmp_path)] == ["a.png", "c.png"]


def test_a_manifest_survives_a_name_that_was_cut_within_a_letter(tmp_path: Path) -> None:
    (tmp_path / manifest.NAME).write_bytes('{"file": "ä'.encode()[:-1])
    with Manifest(tmp_path) as written:
        written.append(BatchRow("b.png", "done"))
    assert [row.file for row in manifest.rows(tmp_path)] == ["b.png"]


def test_names_of_any_bytes_have_their_line_on_the_page(tmp_path: Path) -> None:
    for name in (os.fsdecode(b"fl\xe4che.png"), "a\0b.png"):
        row = BatchRow(name, "done", "0123abcd" * 8, name, seconds=1.0)
        with Manifest(tmp_path) as written:
            written.append(row)
    page, count = write_page(tmp_path)
    assert count == 2 and r"fl\udce4che.png" in page.read_text()


def test_results_are_no_drawings_and_a_link_leads_round_once(scans: Path) -> None:
    made = (
        scans / "small-0123456789ab"
    )  # as a batch leaves it whose results go into the same folder
    made.mkdir()
    for name in ("picture.png", "figures.json"):
        (made / name).write_text("{}")
    (scans / "deep" / "up").symlink_to("..")
    found = [Path(name).name for name in search.drawings(str(scans))]
    assert sorted(found) == ["bad.png", "empty.png", "large.png", "small.png"]


def test_a_name_as_long_as_a_file_system_takes_has_a_folder(scans: Path) -> None:
    file = scans / f"{'漢' * 83}.png"  # 253 of 255 bytes; its corrections' name would be longer
    shutil.copy(scans / "small.png", file)
    name, hashed = Order().folder_name(file)
    assert name == f"{'漢' * 33}-{hashed[:12]}"
    assert DrawingFile(file).open().file == file


def test_a_folder_that_holds_other_figures_is_traced_again(scans: Path) -> None:
    name, _ = Order().folder_name(scans / "small.png")
    (scans / "out" / name).mkdir(parents=True)
    (scans / "out" / name / "figures.json").write_text("{}")
    results = LocalResults(scans / "out")
    assert there_already(Order(), scans / "small.png", "small.png", results) is None


def test_a_folder_appears_whole_or_not_at_all(tmp_path: Path) -> None:
    results = LocalResults(tmp_path)
    with suppress(KeyboardInterrupt), results.folder("a") as folder:
        (folder / "figures.json").write_text("{}")
        raise KeyboardInterrupt
    assert results.figures("a") is None and not (tmp_path / "a").exists()
    for text in (
        '{"ending": "done"}',
        '{"ending": "fault"}',
    ):  # the second in the first one's place
        with results.folder("a") as folder:
            (folder / "figures.json").write_text(text)
        assert results.figures("a") == json.loads(text)
    assert list((tmp_path / ".unfinished").iterdir()) == []


def test_what_wants_an_eye_comes_first() -> None:
    well = BatchRow("a", "done", figures={"ink_followed_share": 0.99})
    order = [
        well,
        replace(well, figures={"ink_followed_share": 0.4}),
        replace(well, remarks=("edges are close together",)),
        BatchRow("a", "incomplete", figures={"ink_followed_share": 0.9}),
        BatchRow("a", "fault"),
    ]
    grades = [wants_eye(row) for row in order]
    assert grades == sorted(grades) and len(set(grades)) == len(grades)


@pytest.mark.parametrize(
    ("words", "exit_code", "told"),
    [
        (("batch", "scans"), 2, "a folder for the results with -o"),
        (
            ("batch", "scans/small.png", "-o", "out"),
            8,
            "is no folder; give a folder of drawings",
        ),
        (("batch", "s3://a/b", "-o", "out"), 2, "give --scheduler, or a folder"),
        (("batch", "scans", "-o", "out", "--memory", "1MB"), 2, "1GB to 1000TB"),
        (("batch", "scans", "-o", "out", "--limit", "0s"), 2, "--limit"),
        (
            ("batch", "scans", "-o", "out", "--glob", "*.pdf"),
            8,
            "no file that fits *.pdf in scans",
        ),
        (("batch", "scans", "-o", "out", "--order", "3,1"), 2, "--order is for several lines"),
        (("batch", "scans", "-o", "out", "--edge", "--paper", "ruled"), 2, "give one of them"),
        (("batch", "--report", "scans"), 8, "give the folder that morfax batch -o named"),
        (("batch", "--report", "scans", "-o", "out"), 2, "give it alone"),
        (
            ("batch", "scans", "-o", "out", "--scheduler", "tcp://127.0.0.1:1", "--jobs", "2"),
            2,
            "a cluster has its own",
        ),
    ],
)
def test_wrong_use_is_one_line(
    morfax: Morfax, scans: Path, words: tuple[str, ...], exit_code: int, told: str
) -> None:
    answer = morfax(*words)
    assert answer.exit_code == exit_code and told in answer.fault
    assert not Path("out").exists()
