"""What a control takes, as data in a machine's file: read, and refused with the line of a mistake."""

from __future__ import annotations

from pathlib import Path

import pytest

from morfax.motion.faults import CardFault
from morfax.recorder.gcode.machine import as_toml, machine, names
from morfax.recorder.gcode.takes import codes

LONGEST_OF_LINUXCNC = 252  # measured with rs274 2.9: 253 characters are "Command too long"


def test_words_are_named_one_by_one_or_from_to() -> None:
    assert codes("G0 G38.2 M100-M102") == {
        ("G", 0.0),
        ("G", 38.2),
        ("M", 100.0),
        ("M", 101.0),
        ("M", 102.0),
    }


def test_a_range_of_words_has_four_digits_at_most() -> None:
    """M100-M1999999999 took minutes and all of the memory."""
    assert len(codes("M0-M9999")) == 10_000
    with pytest.raises(ValueError, match="is no word"):
        codes("M100-M1999999999")


def test_every_machine_takes_the_words_that_it_begins_and_ends_with() -> None:
    for name in names():
        made = machine(name)
        for line in (*made.begin, *made.end, *made.tool_down, *made.tool_up):
            words = [word for word in line.split() if word[0] in "GM"]
            assert all(codes(word) <= made.takes.codes for word in words), (name, line)


def test_linuxcnc_s_longest_line_is_the_one_that_it_reads() -> None:
    assert machine("linuxcnc").longest_line == LONGEST_OF_LINUXCNC
    assert len(machine("linuxcnc").comment("x" * 400)) <= LONGEST_OF_LINUXCNC


def test_no_comment_holds_what_grbl_obeys_in_a_comment() -> None:
    """Grbl, serial.c: ! and ~ are taken out of the stream wherever they stand."""
    assert machine("grbl-pen").comment("part!~ 2") == "(part.. 2)"
    assert machine("linuxcnc").comment("part! 2") == "(part! 2)"


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ('codes = "G0 G1x"', r'takes.codes holds "G0 G1x"; it may hold G and M words'),
        ('codes = "G0-M5"', r"takes.codes holds .*it may hold G and M words"),
        ("arc_mm = -1", r"takes.arc_mm holds -1; it may hold a number from 0"),
        (
            'end = "never"',
            r'takes.end holds "never"; it may hold "needed" or "usual" or "none"',
        ),
        ("percent = 1", r"takes.percent holds 1; it may hold true or false"),
        ("letter = 1", r"takes.letter holds 1; there is no such field"),
    ],
)
def test_a_mistake_is_told_with_its_line(line: str, says: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    head = as_toml("grbl-router").split("[takes]")[0]
    file.write_text(f"{head}[takes]\n{line}\n")
    with pytest.raises(CardFault, match=says) as caught:
        machine(str(file))
    assert caught.value.line == head.count("\n") + 2
