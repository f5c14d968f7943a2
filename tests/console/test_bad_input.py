"""Input that nobody meant: pipes, names of any bytes, huge cards and paths. One line each, and its code."""

from __future__ import annotations

import io
import os
import sys
from pathlib import Path

import pytest
from PIL import Image

from morfax.motion.faults import FileFault, MotionFault
from morfax.motion.files import check_regular, printable, written_beside
from morfax.motion.pathfile import read_path
from tests.console.conftest import SAMPLES, Morfax

CURVE = SAMPLES / "curve.png"
# no UTF-8, and what a formula would be in a picture's title
ODD = os.fsdecode(b"b\xff\xfed$^$x")


# pipes and devices


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names on this system")
@pytest.mark.parametrize("what", ["drawing", "path", "card", "compared"])
def test_a_pipe_is_refused_and_not_waited_for(here: Path, morfax: Morfax, what: str) -> None:
    os.mkfifo("pipe")
    words = {
        "drawing": ("trace", "pipe", "-o", "x.ngc"),
        "path": ("record", "pipe", "-o", "x.ngc"),
        "card": ("trace", CURVE, "--card", "pipe", "-o", "x.ngc"),
        "compared": ("compare", CURVE, "pipe"),
    }
    answer = morfax(*words[what])
    assert answer.exit_code == 8
    assert answer.fault == "morfax: cannot read pipe: it is a pipe; write it to a file first"
    assert not Path("x.ngc").exists()


def test_a_device_is_refused() -> None:
    with pytest.raises(FileFault, match="cannot read /dev/zero: it is a device"):
        check_regular("/dev/zero")


# names


@pytest.mark.parametrize(
    "words",
    [
        ("trace", "a\0.png", "-o", "x.ngc"),
        ("trace", CURVE, "-o", "a\0.ngc"),
        ("play", "a\0.wav"),
        ("compare", "a\0.csv", "b.csv"),
    ],
)
def test_a_name_with_a_byte_of_0_is_wrong_use(
    here: Path, morfax: Morfax, words: tuple[str, ...]
) -> None:
    answer = morfax(*words)
    assert answer.exit_code == 2
    assert (
        r"a\0." in answer.fault and "is no name of a file: it holds a byte of 0" in answer.fault
    )


def test_a_name_with_a_byte_of_0_is_a_fault_of_the_library() -> None:
    import morfax

    for what in (morfax.Drawing.open, morfax.read_path, morfax.play):
        with pytest.raises(FileFault, match="is no name of a file"):
            what("a\0.png")
    with pytest.raises(FileFault, match="is no name of a file"), written_beside("a\0.csv"):
        raise AssertionError("nothing is written")


@pytest.mark.skipif(sys.platform != "linux", reason="names are Unicode on this system")
def test_a_name_of_any_bytes_is_traced_played_compared_and_drawn(
    here: Path, morfax: Morfax, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path(f"{ODD}.png").write_bytes(CURVE.read_bytes())
    # as a terminal is: what cannot be encoded is no figure
    strict = io.TextIOWrapper(io.BytesIO(), encoding="utf-8", errors="strict")
    monkeypatch.setattr(sys, "stdout", strict)
    made = (f"{ODD}.wav", f"p{ODD}.png", f"{ODD}.csv", f"c{ODD}.png")
    assert morfax("trace", f"{ODD}.png", "-o", made[0], "--picture", made[1]).exit_code == 0
    assert morfax("play", made[0], "-o", made[2], "--json").exit_code == 0
    assert morfax("inspect", made[0]).exit_code == 0
    assert morfax("compare", f"{ODD}.png", made[2], "--picture", made[3]).exit_code == 0
    assert all(Path(name).stat().st_size for name in made)
    strict.flush()
    assert rb"b\udcff\udcfed$^$x.wav" in strict.buffer.getvalue()  # type: ignore[attr-defined]


def test_what_is_no_utf_8_is_written_out() -> None:
    assert printable(os.fsdecode(b"a\xffb") + " µ") == r"a\udcffb µ"


# cards and settings


DEEP = {
    "large": ("#" + "x" * 1_000_000, "line 1: {} holds more than that; it may hold 1000000 bytes"),
    "dots": ('start = "2mm"\n' + ".".join("a" * 2000) + " = 1", "line 2: {} holds a key of too many parts"),
    "many dots": (".".join("a" * 100_000) + " = 1", "line 1: {} holds a key of too many parts"),
    "header": ("[" + ".".join("a" * 9) + "]", "line 1: {} holds a key of too many parts; it may hold 8"),
    "brackets": ("a = " + "[" * 9 + "]" * 9, "line 1: {} holds too many brackets in one another"),
    "tables": ("a = " + "{b = " * 40_000 + "1" + "}" * 40_000, "too many brackets in one another"),
}  # fmt: skip


@pytest.mark.parametrize("kind", DEEP)
@pytest.mark.parametrize(
    ("option", "called"), [("--card", "the card"), ("--settings", "the file of settings")]
)
def test_a_card_and_settings_have_a_size_and_a_depth(
    here: Path, morfax: Morfax, kind: str, option: str, called: str
) -> None:
    text, said = DEEP[kind]
    Path("card.toml").write_text(text)
    answer = morfax("trace", CURVE, option, "card.toml", "-o", "x.ngc")
    assert answer.exit_code == 9 and said.format(called) in answer.fault


# paths


@pytest.mark.parametrize("far", ["1.1e6", "1e9", "-1e12", "1e300"])
def test_a_place_or_a_time_that_no_machine_has_is_refused(here: Path, far: str) -> None:
    Path("p.csv").write_text(f"x_mm,y_mm\n0,0\n{far},5\n0,9\n")
    with pytest.raises(
        MotionFault, match=r"p\.csv, line 3: x_mm is .*; it may be up to 1e\+06 mm"
    ):
        read_path("p.csv")
    Path("t.csv").write_text(f"t_s,x_mm,y_mm\n0,0,0\n{far.strip('-')},5,5\n")
    with pytest.raises(
        MotionFault, match=r"t\.csv, line 3: t_s is .*; it may be up to 86400 s"
    ):
        read_path("t.csv")


def test_a_path_that_takes_more_than_a_day_is_refused(here: Path, morfax: Morfax) -> None:
    Path("p.csv").write_text("x_mm,y_mm\n0,0\n900000,0\n")
    answer = morfax("record", "p.csv", "-o", "p.wav")
    assert (
        answer.exit_code == 7 and "p.csv takes 25 h; a program may take a day" in answer.fault
    )
    assert read_path("p.csv", feed_mm_s=20).t_s[-1] == 45_000


@pytest.mark.parametrize("row", ["1," + "1" * 1_000_000, "x" * 1_000_000])
def test_a_line_of_a_million_characters_is_refused(
    here: Path, morfax: Morfax, row: str
) -> None:
    Path("p.csv").write_text(f"x_mm,y_mm\n0,0\n{row}\n2,2\n")
    answer = morfax("record", "p.csv", "-o", "p.wav")
    assert answer.exit_code == 7
    assert "p.csv, line 3: longer than 10000 characters" in answer.fault


@pytest.mark.parametrize("suffix", ["ngc", "dxf"])
def test_a_tolerance_that_cannot_be_written_is_wrong_use(
    path_file: Path, here: Path, morfax: Morfax, suffix: str
) -> None:
    answer = morfax("record", path_file, "-o", f"x.{suffix}", "--fit-tolerance", "1e-9mm")
    assert answer.exit_code == 2 and "a tolerance of 1e-09 mm cannot be written" in answer.fault


# drawings


@pytest.mark.parametrize("dpi", [(2, 2), (200, 2), (3, 60000), (1e9, 1e9)])
def test_a_resolution_that_no_scanner_has_is_refused(
    here: Path, morfax: Morfax, dpi: tuple[float, float]
) -> None:
    with Image.open(CURVE) as curve:
        curve.convert("L").save("a.tif", dpi=dpi)
    answer = morfax("trace", "a.tif", "-o", "x.ngc")
    assert answer.exit_code == 3
    said = f"a.tif states {dpi[0]:g} x {dpi[1]:g} dpi, which no scanner has; give --dpi 300"
    assert said in answer.fault
