"""Corrections as a job: kept beside the drawing, used by whatever opens it."""

from __future__ import annotations

import pickle
import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from morfax.jobs.correct import CorrectJob
from morfax.jobs.lines import LinesJob
from morfax.jobs.settings.correction_settings import CorrectionSettings
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.settings.settings import ProgramSettings, TraceSettings
from morfax.jobs.trace import TraceJob, TraceOutputs
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import CardFault, DrawingFault
from morfax.motion.polyline import area_mm2
from morfax.reports.numbered import draw_numbered
from morfax.tracer.corrections.corrections import Correction, Place, Span
from tests.console.conftest import SAMPLES
from tests.jobs.worked import Recording

RUB = Correction("rub", (Place(42.8, 6.99, "mm"),), Span(3, "mm"), why="a tear")
STOP = Correction("stop", (Place(300, 200),))


@pytest.fixture
def bracket(here: Path) -> DrawingFile:
    """A drawing in a folder of its own."""
    return DrawingFile(Path(shutil.copy(SAMPLES / "bracket.png", here)))


def test_the_file_is_made_added_to_undone(bracket: DrawingFile) -> None:
    made = CorrectJob(bracket, (RUB,)).run()
    assert made.file == bracket.file.with_name("bracket.morfax.toml")
    assert made.laid is not None
    assert made.laid.place_of(1) == pytest.approx((42.8, 6.99), abs=0.001)
    job = CorrectJob(bracket, (STOP,))
    assert pickle.loads(pickle.dumps(job)) == job
    assert job.run().corrections.counts() == {"rub": 1, "stop": 1}
    assert CorrectJob(bracket).run().figures["corrections"] == 2
    assert CorrectJob(bracket, undo=1).run().corrections.counts() == {"rub": 1}
    assert CorrectJob(bracket, (STOP,), remove=(1,)).run().corrections.counts() == {"stop": 1}
    with pytest.raises(WrongUse, match="no correction 2: there is 1"):
        CorrectJob(bracket, remove=(2,)).run()
    with pytest.raises(
        WrongUse,
        match="--undo 2 takes back more corrections than there are: there is 1; give no",
    ):
        CorrectJob(bracket, undo=2).run()


@pytest.mark.parametrize(("places", "goes_on"), [(3, False), (4, True)])
def test_of_a_long_stroke_its_first_three_places_are_listed(
    bracket: DrawingFile, places: int, goes_on: bool
) -> None:
    at = tuple(Place(300 + 10 * k, 200) for k in range(places))
    (row,) = CorrectJob(bracket, (Correction("rub", at),)).run().figures["each"]
    assert row["at"] == " ".join(map(str, at[:3])) + (" …" if goes_on else "")


def test_whoever_opens_the_drawing_has_its_corrections(bracket: DrawingFile) -> None:
    plain = bracket.open()
    CorrectJob(bracket, (RUB,)).run()
    heard = Recording()
    rubbed = bracket.open(heard)
    assert heard.said[0] == ("note", "1 correction of bracket.morfax.toml: 1 rub")
    lost_mm2 = (plain.darkness - rubbed.darkness).sum() * plain.pitch_mm**2
    assert lost_mm2 == pytest.approx(3 * 0.5, rel=0.1)  # 3 mm of a line of 0.5 mm
    without = DrawingFile(bracket.file, corrections=CorrectionSettings(used=False)).open()
    assert np.array_equal(without.darkness, plain.darkness)


def test_what_changed_nothing_is_told_with_its_place(bracket: DrawingFile) -> None:
    CorrectJob(bracket, (Correction("rub", (Place(2, 3, "mm"),)),)).run()
    heard = Recording()
    bracket.open(heard)
    assert heard.said[1:] == [
        (
            "warning",
            "correction 1 of bracket.morfax.toml, rub at 2.00, 3.00 mm, changed nothing:"
            " there is no ink under it",
        )
    ]


def test_corrections_of_another_picture(bracket: DrawingFile) -> None:
    CorrectJob(bracket, (RUB,)).run()
    # 1. the same name and shape, other bytes: a warning
    with bracket.file.open("ab") as stream:
        stream.write(b"\0")
    heard = Recording()
    bracket.open(heard)
    assert "is not the file that its corrections were made on" in heard.said[0][1]
    # 2. a drawing of the same stem beside it: not its own
    other = DrawingFile(Path(shutil.copy(SAMPLES / "cam.png", "bracket.tif")))
    heard = Recording()
    assert other.open(heard).corrected is None
    assert heard.said[0] == (
        "note",
        "bracket.morfax.toml belongs to bracket.png, and this is bracket.tif, and is not used; this "
        "drawing's own go into a file with --corrections",
    )
    # 3. another picture under the old name
    shutil.copy(SAMPLES / "cam.png", bracket.file)
    with pytest.raises(CardFault, match="it is another picture"):
        bracket.open()
    # 4. asked for by name
    asked = CorrectionSettings(Path("bracket.morfax.toml"))
    with pytest.raises(CardFault, match=r"belongs to bracket\.png, and this is bracket\.tif"):
        DrawingFile(other.file, corrections=asked).open()


def test_a_drawing_without_a_scale_is_corrected_in_pixels(here: Path) -> None:
    with Image.open(SAMPLES / "bracket.png") as image:
        Image.fromarray(np.asarray(image)).save("bare.png")
    bare = DrawingFile(Path("bare.png"))
    assert CorrectJob(bare, (STOP,)).run().laid is None
    with pytest.raises(DrawingFault, match="states no resolution"):
        CorrectJob(bare, (RUB,)).run()


def test_a_file_that_cannot_be_edited_is_left_as_it_is(bracket: DrawingFile) -> None:
    file = bracket.file.with_name("bracket.morfax.toml")
    text = 'correction = [{ do = "stop", at = "3px,4px" }, { do = "stop", at = "3px,4px" }]\n'
    file.write_text(text)
    with pytest.raises(CardFault, match="cannot be edited"):
        CorrectJob(bracket, (STOP,)).run()
    with pytest.raises(CardFault, match="cannot be edited"):
        CorrectJob(bracket, undo=1).run()
    assert file.read_text() == text


def test_start_direction_and_reference_point_are_those_of_the_corrections(
    bracket: DrawingFile,
) -> None:
    """The hole of the bracket is not its longest line; a start that is asked for goes first."""
    hole = Correction("start", (Place(50.5, 26.04, "mm"),), direction="cw")
    CorrectJob(bracket, (hole, Correction("reference", (Place(5, 5, "mm"),)))).run()
    outputs = TraceOutputs(path=Path("a.csv"), program=Path("a.ngc"))
    settings = TraceSettings(program=ProgramSettings(zero="reference"))
    result = TraceJob(bracket, outputs, settings).run()
    assert result.figures["length_mm"] == pytest.approx(2 * np.pi * 11, abs=0.02)
    assert area_mm2(result.traced.trace.lines[0].xy_mm) < 0  # clockwise
    assert result.figures["corrections"] == 2
    laid = result.drawing.corrected
    assert laid is not None
    head = Path("a.ngc").read_text().splitlines()[1]
    assert head == f"(from bracket.png with corrections {laid.fingerprint})"
    own = TraceSettings(LineSettings(start_mm=(42.8, 6.99)))
    asked = TraceJob(bracket, TraceOutputs(Path("b.csv")), own).run()
    assert asked.figures["length_mm"] == pytest.approx(227.5, abs=0.1)


def test_turns_and_stops_that_served_nothing_are_told(bracket: DrawingFile) -> None:
    each = (
        Correction("left", (Place(60, 7, "mm"),)),
        Correction("stop", (Place(42.8, 7.5, "mm"),)),
        Correction("not-stop", (Place(42.8, 20, "mm"),)),
    )
    CorrectJob(bracket, each).run()
    heard = Recording()
    result = TraceJob(bracket, TraceOutputs(Path("a.csv"))).run(heard)
    told = [text for _, text in heard.said if "changed nothing" in text]
    assert told == [
        "correction 1 of bracket.morfax.toml, left at 60.00, 7.00 mm, changed nothing:"
        " the head came to no junction there with such a way out",
        "correction 3 of bracket.morfax.toml, not-stop at 42.80, 20.00 mm, changed nothing:"
        " no line that the head followed has a mark to strike out there",
    ]
    assert len(result.figures["stops"]) == 1


def test_a_picture_shows_the_corrections(bracket: DrawingFile) -> None:
    CorrectJob(bracket, (RUB, STOP, Correction("left", (Place(500, 300),)))).run()
    picture = Path("lines.png")
    draw_numbered(LinesJob(bracket, picture=picture).run())
    with Image.open(picture) as image:
        seen = np.asarray(image.convert("RGB")).astype(int)
    magenta = np.array([0xD1, 0x00, 0xB8])
    assert np.count_nonzero(np.abs(seen - magenta).sum(axis=2) < 30) > 50  # pixels of the marks


def test_edges_of_filled_shapes_take_no_ink(here: Path) -> None:
    levels = np.full((300, 300), 255, np.uint8)
    levels[100:200, 100:200] = 0
    Image.fromarray(levels).save("square.png", dpi=(300, 300))
    square = DrawingFile(Path("square.png"), edge=True)
    CorrectJob(square, (Correction("rub", (Place(100, 100),)),)).run()
    with pytest.raises(CardFault, match="does not work with --edge"):
        square.open()
