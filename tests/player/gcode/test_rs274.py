"""The reader of RS-274: the subset that other programs write is read, all else refused with line and word."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.faults import FileFault, ProgramFault
from morfax.player.gcode.machine_reader import read_program
from morfax.player.gcode.moves import CLOCKWISE, COUNTER_CLOCKWISE, DWELL, LINE, RAPID, Move
from morfax.player.gcode.rs274 import parse_rs274

WRITTEN_MM = 1e-4  # what four decimals of a program leave


def moves(*lines: str) -> list[Move]:
    return parse_rs274([*lines, "M2"], start_mm=(0, 0, 0)).moves


def refused(*lines: str) -> str:
    with pytest.raises(ProgramFault) as caught:
        moves(*lines)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_all_that_the_subset_holds_is_read() -> None:
    program = parse_rs274(
        """%
        (a part; with (one comment) N5
        N10 G17 G21 G40 G49 G80 G90 G94 G54 G64 P0.01 S12000 T1 M3 ; and another
        g0 x1 y2 z+5.
        G1 Z-.5 F300
        X 4
        G3 X4Y4 I0J1 F600
        G2 X4 Y2 R-1.0
        G4 P0.25
        M5
        G91 G1 X1 Y-1
        G20 X1
        M0
        M30
        this is not read any more
        """.replace("(a part; with (one comment)", "(a part; one comment)").split("\n")
    )
    kinds = [(move.line, move.kind) for move in program.moves]
    assert kinds == [
        (4, RAPID),
        (5, LINE),
        (6, LINE),
        (7, COUNTER_CLOCKWISE),
        (8, CLOCKWISE),
        (9, DWELL),
        (11, LINE),
        (12, LINE),
    ]
    assert program.start_mm == (1, 2, 5)
    assert program.moves[1] == Move(5, LINE, (1, 2, -0.5), 5.0)
    assert program.moves[5].dwell_s == 0.25
    assert program.moves[-1].end_mm == (5 + 25.4, 1, -0.5)


@pytest.mark.parametrize("arc", ["I{0}", "J{0}", "I{1} J{1}", "R{0}"])
def test_an_arc_in_inches_is_the_arc_in_mm(arc: str) -> None:
    """Centre offsets and radius are in the unit of the places."""
    ends = {"I{0}": (2, 0), "J{0}": (0, 2), "I{1} J{1}": (1, 1), "R{0}": (1, 1)}[arc]
    found = []
    for unit, scale in (("G20", 1 / 25.4), ("G21", 1.0)):
        x, y, one, half = (n * scale for n in (*ends, 1.0, 0.5))
        words = arc.format(f"{one:.9f}", f"{half:.9f}")
        found.append(moves(unit, "G1 X0 Y0 F60", f"G3 X{x:.9f} Y{y:.9f} {words}")[-1])
    inches, metric = found
    assert inches.centre_mm == pytest.approx(metric.centre_mm, abs=1e-7)  # nine decimals
    assert inches.turned_rad == pytest.approx(metric.turned_rad, abs=1e-7)


def test_a_feed_in_inches_is_of_inches() -> None:
    inches, metric = moves("G20 G1 X1 F60", "G21 G1 X1 F60")
    assert inches.feed_mm_s == pytest.approx(25.4) and metric.feed_mm_s == pytest.approx(1.0)


def test_a_dwell_lasts_a_day_at_most() -> None:
    assert moves("G4 P86400")[0].dwell_s == 86400
    assert "a day at most" in refused("G4 P86401")


def test_every_ending_ends() -> None:
    for ending in ("M2", "M30", "m02", "%"):
        assert len(parse_rs274(["%", "G0 X1", ending, "G0 X9"]).moves) == 1


@pytest.mark.parametrize("lines", [[], [""], ["%"], ["G0 X1"], ["%", "G0 X1"]])
def test_a_program_without_an_end_is_cut_short(lines: list[str]) -> None:
    with pytest.raises(ProgramFault, match="a program ends with M2, M30 or %"):
        parse_rs274(lines)


def test_arcs_have_their_centre_and_their_angle() -> None:
    (quarter,) = moves("G3 X-5 Y5 J5 F60".replace("J5", "I-5"))[-1:]
    assert quarter.centre_mm == pytest.approx((-5, 0)) and quarter.turned_rad == pytest.approx(
        math.pi / 2
    )
    (back,) = moves("G2 X-5 Y5 I-5 F60")
    assert back.turned_rad == pytest.approx(-1.5 * math.pi)
    (whole,) = moves("G2 I5 F60")
    assert whole.turned_rad == pytest.approx(-2 * math.pi) and whole.centre_mm == (5, 0)


@given(
    st.floats(1, 100),
    st.floats(0, 6.28),
    st.floats(0.1, 6.2).filter(lambda turn: abs(turn - math.pi) > 0.05),
    st.booleans(),
)
def test_an_arc_by_radius_is_the_arc_by_centre(
    radius: float, first: float, turn: float, left: bool
) -> None:
    sense, code = (1, "G3") if left else (-1, "G2")
    (x0, y0), (x1, y1) = [
        (radius * math.cos(a), radius * math.sin(a)) for a in (first, first + sense * turn)
    ]
    begin = f"G0 X{x0:.9f} Y{y0:.9f}"
    by_centre = moves(begin, f"{code} X{x1:.9f} Y{y1:.9f} I{-x0:.9f} J{-y0:.9f} F60")[-1]
    by_radius = moves(
        begin, f"{code} X{x1:.9f} Y{y1:.9f} R{radius if turn < math.pi else -radius:.9f} F60"
    )[-1]
    for arc in (by_centre, by_radius):
        assert arc.centre_mm == pytest.approx((0, 0), abs=WRITTEN_MM)
        assert arc.turned_rad == pytest.approx(sense * turn, abs=1e-5)


def test_ends_that_lie_a_little_off_their_circle_move_its_centre() -> None:
    (arc,) = moves("G3 X-10.002 Y0 I-5 F60")
    assert arc.centre_mm == pytest.approx((-5.001, 0))


def test_where_the_machine_stands_is_where_the_program_first_sends_each_axis() -> None:
    assert parse_rs274(["G0 Z2", "G0 X3 Y4", "M2"]).start_mm == (3, 4, 2)
    assert parse_rs274(["G91 G0 X3", "M2"]).start_mm == (0, 0, 0)
    up_first = parse_rs274(["G4 P1", "G0 Z2", "G0 X3", "G0 Y4", "G0 X5", "M2"])
    assert up_first.start_mm == (3, 4, 2)
    assert [move.end_mm for move in up_first.moves] == [(3, 4, 2)] * 4 + [(5, 4, 2)]
    assert parse_rs274(["G0 X3", "M2"], start_mm=(1, 1, 1)).start_mm == (1, 1, 1)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("G43 H1", "G43 is not played; this control reads G0"),
        ("G1.5 X1 F60", "G1.5 is not played"),
        ("M6 T1", "M6 is not played"),
        ("G1 X1 A5 F60", "A5 is not played"),
        ("G1 X1 E2 F60", "E2 is not played"),
        ("#1=5", "'#1=5' is no word; words are a letter and a number"),
        ("G1 X F60", "'X' is no word"),
        ("G1 X1.2.3 F60", "'.3' is no word"),
        ("O100 call", "is no word"),
        ("/G0 X1", "'/' is no word"),
        ("G1 Xnan F60", "is no word"),
        ("(open G0 X1", "is no word"),
        ("G1 X1 X2 F60", "X2 is the second word for X in the line"),
        ("G0 G1 X1 F60", "G1 is the second word for motion in the line"),
        ("G1 G4 P1 F60", "G4 stands with another motion"),
        ("G4", "G4 wants a time in seconds, a day at most, and no place; give G4 P0.5"),
        ("G4 P-1", "G4 wants a time"),
        ("P1", "P1 belongs to a dwell"),
        ("X1", "X1 asks for a move, but none of G0 G1 G2 G3 was given"),
        ("G1 X1", "G1 has no feed; give F"),
        ("G1 X1 F0", "F0 moves nothing; give a feed above zero"),
        ("G1 X1 F-5", "F-5 moves nothing"),
        ("G1 X1 I5 F60", "I5 belongs to an arc, and G1 is not one"),
        ("G2 X1 F60", "G2 has no centre; give I and J, or R"),
        ("G2 X1 I1 R1 F60", "R1 stands with a centre"),
        (
            "G2 X10 R4.9 F60",
            "R4.9 does not reach: the ends of the arc are 10.0000 mm apart; give 5.0000 mm or more",
        ),
        ("G2 R4 F60", "give I and J for a whole turn"),
        (
            "G2 X10 I4 F60",
            "I4 J0 is no centre of both ends: 4.0000 mm from the start, 6.0000 mm from the end",
        ),
        ("G2 X10 Z1 I5 F60", "Z1 makes the arc a helix"),
        ("G18", "G18 is not played"),
    ],
)
def test_all_else_is_refused_with_line_and_word(line: str, says: str) -> None:
    message = refused("G21", line)
    assert message.startswith("program, line 2: ") and says in message


@given(st.text(alphabet="GMXYZIJRFPSTN0123456789.-+ %(;)", max_size=40))
def test_no_line_of_any_kind_is_anything_but_read_or_refused(line: str) -> None:
    try:
        parse_rs274([line, "M2"])
    except ProgramFault as fault:
        assert fault.line == 1 or "ends with M2" in str(fault)


def test_a_file_that_is_no_text_or_not_there(tmp_path: Path) -> None:
    file = tmp_path / "part.ngc"
    file.write_bytes(b"G0 X1\nG1 \xff\x00\n")
    with pytest.raises(ProgramFault, match="line 2: this is no text"):
        read_program(file)
    with pytest.raises(FileFault, match="cannot read"):
        read_program(tmp_path / "none.ngc")


@pytest.mark.parametrize("coding", ["utf-8", "latin-1"])
def test_comments_may_hold_any_letters(tmp_path: Path, coding: str) -> None:
    file = tmp_path / "part.ngc"
    file.write_bytes("G21 (für Grün)\nG1 X5 F600 ; längs\nM2\n".encode(coding))
    assert read_program(file).moves[-1].end_mm == (5.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        (
            "G1 X１",
            "line 2: this is no text: '１' stands outside a comment",
        ),  # a wide digit is none
        ("G1 X1 (whole) ä", "line 2: this is no text: 'ä'"),
        ("G1 X1 (cut öff", "line 2: this is no text: 'ö'"),
    ],
)
def test_outside_of_comments_all_is_ascii(tmp_path: Path, line: str, says: str) -> None:
    file = tmp_path / "part.ngc"
    file.write_text(f"G21 (ä)\n{line}\nM2\n", "utf-8")
    with pytest.raises(ProgramFault) as caught:
        read_program(file)
    assert says in str(caught.value) and caught.value.line == 2


def test_a_byte_order_mark_is_refused_by_its_name(tmp_path: Path) -> None:
    file = tmp_path / "part.ngc"
    file.write_text("G21\nM2\n", "utf-8-sig")
    with pytest.raises(ProgramFault, match="begins with a byte-order mark"):
        read_program(file)


@pytest.mark.parametrize(("apart_mm", "is_taken"), [(0.009, True), (0.012, False)])
def test_the_ends_of_an_arc_may_lie_a_thousandth_of_its_radius_off_one_circle(
    apart_mm: float, is_taken: bool
) -> None:
    lines = ["G1 X10 Y0 F100", f"G3 X{-10 - apart_mm} Y0 I-10 J0", "M2"]
    if is_taken:
        assert parse_rs274(lines).moves[-1].end_mm[0] == pytest.approx(-10 - apart_mm)
        return
    with pytest.raises(ProgramFault, match=r"may differ by 0.0100 mm"):
        parse_rs274(lines)


def test_the_number_of_a_program_may_stand_before_its_words() -> None:
    """As LinuxCNC's rs274 takes it. (Fails without `PROGRAM_NUMBER`, and if it is passed over anywhere.)"""
    moves = ["G21 G90", "G0 X1", "G1 X5 F100", "M30"]
    for number in ("O0000(PART 7)", "o1234"):
        assert len(parse_rs274(["%", number, *moves]).moves) == 2
    for lines in ([moves[0], "O1234", *moves[1:]], ["O12 G1 X3", *moves]):
        with pytest.raises(ProgramFault, match="O12"):
            parse_rs274(lines)
