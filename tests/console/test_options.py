"""Options: each has one meaning, an old spelling is refused with the new one, and the help has headings."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.console.cli import VERBS
from tests.console.conftest import SAMPLES, Morfax

RENAMED = [
    (("trace", "a.png", "--override", "2"), "--stop-override"),
    (("trace", "a.png", "--override=all"), "--stop-override"),
    (("trace", "a.png", "--reference", "8,23"), "--reference-point"),
    (("run", "a.png", "--reference", "8,23"), "--reference-point"),
    (("play", "a.wav", "--override", "50%"), "--feed-override"),
    (("play", "a.wav", "--reference", "6kHz"), "--reference-frequency"),
    (("compare", "a.wav", "b.csv", "--reference", "6kHz"), "--reference-frequency"),
    (("inspect", "a.wav", "--reference", "6kHz"), "--reference-frequency"),
    (("mend", "a.wav", "-o", "b.wav", "--reference", "6kHz"), "--reference-frequency"),
    (("record", "a.csv", "--reference", "6kHz"), "--reference-frequency"),
    (("record", "a.csv", "--tolerance", "10um"), "--fit-tolerance"),
    (("age", "a.wav", "-o", "b.wav", "--speed", "1.5%"), "--speed-error"),
    (("play", "a.wav", "--override"), "--feed-override"),
    (("play", "a.wav", "--zero", "1,1"), "--zero-adjustment"),
    (("trace", "a.png", "--origin", "sheet"), "--zero"),
    (("compare", "a.png", "b.csv", "--origin", "1,1"), "--zero"),
    (("inspect", "a.steps", "-o", "a.png"), "--picture"),
]


@pytest.mark.parametrize(("words", "new"), RENAMED)
def test_an_old_spelling_is_refused_with_the_new_one(
    morfax: Morfax, words: tuple[str, ...], new: str
) -> None:
    answer = morfax(*words)
    old = next(word for word in reversed(words) if word.startswith("-")).partition("=")[0]
    assert answer.exit_code == 2 and len(answer.err.splitlines()) == 1
    assert f"{old} is called {new} now" in answer.fault
    assert f"{old} " not in morfax(words[0], "--help").out  # only the new one is shown
    assert f"{new} " in morfax(words[0], "--help").out


@pytest.mark.parametrize("verb", ["trace", "run"])
def test_the_help_has_a_heading_for_each_part_of_the_work(morfax: Morfax, verb: str) -> None:
    said = morfax(verb, "--help").out
    headings = [
        "Drawing:",
        "Line:",
        "Head:",
        "Tool:",
        "Cutting:",
        "Program:",
        "Output:",
        "Other options:",
    ]
    assert re.findall(r"^[A-Z][a-z ]+:$", said, re.MULTILINE) == headings
    under = {
        "Drawing": ("--dpi", "--ink", "--edge"),
        "Line": ("--start", "--lines", "--gap", "--reference-point"),
        "Head": ("--speed", "--head", "--set "),
        "Tool": ("--depth", "--cutter", "--side"),
        "Cutting": (
            "--climb",
            "--conventional",
            "--lead-in",
            "--lead-out",
            "--start-at",
            "--tabs",
        ),
        "Program": ("--card", "--stop-override", "--zero", "--mirror"),
        "Output": ("-o", "--json"),
    }
    for name, options in under.items():
        section = said.split(f"\n{name}:\n")[1].split("\n\n")[0]
        assert [option for option in options if f"  {option}" not in section] == []


@pytest.mark.parametrize("verb", VERBS)
def test_all_options_but_help_stand_under_a_heading(morfax: Morfax, verb: str) -> None:
    rest = morfax(verb, "--help").out.split("Other options:\n")[1].split("\n\n")[0]
    assert rest.split() == ["-h,", "--help", "Show", "this", "message", "and", "exit."]


def test_a_zero_is_of_the_sheet_of_the_part_the_reference_point_or_a_place(
    morfax: Morfax,
) -> None:
    answer = morfax("trace", "a.png", "--zero", "middle")
    assert answer.exit_code == 2
    assert (
        "'middle' is no zero; give sheet, reference, lower-left, centre, or a place X,Y"
        in answer.fault
    )


@pytest.mark.parametrize(
    ("words", "position", "offered"),
    [
        ("morfax tr", 1, "trace"),
        ("morfax trace --stop", 2, "--stop-override"),
        ("morfax trace a.png --head hi", 4, "historic"),
    ],
)
def test_the_shell_completes_verbs_options_and_choices(
    words: str, position: int, offered: str
) -> None:
    completing = {
        "_MORFAX_COMPLETE": "bash_complete",
        "COMP_WORDS": words,
        "COMP_CWORD": str(position),
        "PYTHONPATH": str(Path(__file__).parents[2]),
    }
    done = subprocess.run(
        [sys.executable, "-c", "from morfax.console.cli import main; main()"],
        env={**os.environ, **completing},
        capture_output=True,
        text=True,
        check=False,
    )
    assert offered in [line.partition(",")[2] for line in done.stdout.splitlines()]
    assert done.stderr == ""


def test_quiet_says_only_what_went_wrong(morfax: Morfax, here: Path) -> None:
    words = ("record", SAMPLES / "cam.csv", "-o", "cam.ngc", "--quiet")
    answer = morfax(*words)
    assert (answer.exit_code, answer.out, answer.err) == (0, "", "")
    assert morfax(*words, "--json").figures["machine"] == "linuxcnc"
    assert "grbl-router" in morfax("machines", "--quiet").out
    assert morfax("check", "cam.ngc", "--quiet").out == ""
    (here / "bad.ngc").write_text((here / "cam.ngc").read_text().replace("M5", "G64 X"))
    told = morfax("check", "bad.ngc", "--quiet")
    assert told.exit_code == 1 and told.out.startswith("line ")


def test_quiet_keeps_warnings_and_drops_notes(morfax: Morfax, here: Path) -> None:
    """Whoever wants no table wants to know all the same that the zero may be the middle of a hole."""
    grey = np.full((300, 300), 245, np.uint8)
    cv2.rectangle(grey, (40, 40), (260, 260), 30, 4)
    cv2.circle(grey, (100, 200), 24, 30, 4, cv2.LINE_AA)
    Image.fromarray(grey).save("plate.png", dpi=(254, 254))
    words = ("trace", "plate.png", "--lines", "contours", "-o", "plate.csv", "--quiet")
    told = morfax(*words, "--zero", "reference")
    assert told.exit_code == 0 and told.out == ""
    assert told.err.startswith("the program's zero is the only small cross or ring")
    place = re.search(r" at ([\d.]+),([\d.]+) mm", told.err)
    # the pixel's middle; told to a tenth
    assert place is not None
    assert [float(it) for it in place.groups()] == pytest.approx([10.05, 9.95], abs=0.051)
    assert morfax(*words).err == ""
    assert morfax(*words, "--zero", "reference", "--reference-point", "10,10").err.startswith(
        "no line"
    )


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("morfax trace --machine grbl-r", "plain,grbl-router"),
        ("morfax check --machine hp", "plain,hpgl"),
        ("morfax machines qt", "plain,qtplasmac"),
        ("morfax play --machine my.to", "file,my.to"),
    ],
)
def test_the_shell_completes_machines(
    words: str, offered: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("_MORFAX_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", words)
    monkeypatch.setenv("COMP_CWORD", str(len(words.split()) - 1))
    run = subprocess.run(
        [sys.executable, "-m", "morfax"], capture_output=True, text=True, check=False
    )
    assert run.stdout.split() == [offered]
