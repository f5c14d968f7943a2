"""Corrections as a job: kept beside the drawing, used by whatever opens it."""

from __future__ import annotations

import pickle
import shutil
from pathlib import Path

import numpy as np
import pytest

from morfax.jobs.correct import CorrectJob
from morfax.jobs.correction_settings import CorrectionSettings
from morfax.jobs.settings import DrawingFile
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import CardFault, DrawingFault
from morfax.tracer.corrections.corrections import Correction, Place, Span
from tests.console.conftest import SAMPLES
from tests.jobs.test_jobs import Recording

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
    with pytest.raises(WrongUse, match="2 corrections were to be undone, and there is 1"):
        CorrectJob(bracket, undo=2).run()


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
        "bracket.morfax.toml belongs to bracket.png, and this is bracket.tif, and is not used",
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
    from PIL import Image

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
