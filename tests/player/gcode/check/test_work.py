"""What the work would not take: rapids, the tool, the stock, the travel; and places that are followed."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.player.gcode.check.checked import Checked, check_lines
from morfax.player.gcode.check.motion_rules import Stock
from morfax.player.gcode.check.steps import Step, bounds_mm
from morfax.player.gcode.moves import Move
from morfax.recorder.gcode.machine import Machine, machine

ROUTER, LINUXCNC, LASER = machine("grbl-router"), machine("linuxcnc"), machine("grbl-laser")
HEAD = ["G21 G90 G94", "M3 S1000", "G0 Z5", "G0 X0 Y0"]  # lines 1 to 4
ROUNDED_MM = 1e-9  # arithmetic of a few sums
CHORD_SHARE = 1e-3  # of the radius: what chords of 5 degrees cut off


def check(*lines: str, on: Machine = ROUTER, stock: Stock | None = None) -> Checked:
    return check_lines([*HEAD, *lines, "M2"], on, stock)


def rules(checked: Checked) -> list[tuple[int, str]]:
    """Line and kind of what stops the program."""
    return [(each.line, each.rule) for each in checked.findings if each.stops]


def test_a_sound_program_may_be_started() -> None:
    checked = check("G1 Z-2 F100", "G1 X10 F600", "G0 Z5", "G0 X0 Y0", "M5")
    assert checked.may_start and checked.findings == []


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        (("G0 Z-1",), [(5, "rapid")]),  # plunges
        (("G0 X5 Z-1",), [(5, "rapid")]),  # on a slope
        (("G1 Z-1 F100", "G0 X5"), [(6, "rapid")]),  # across
        (("G1 Z-1 F100", "G0 X5 Z5"), [(6, "rapid")]),  # out on a slope
        (("G1 Z0.04 F100", "G0 X5"), [(6, "rapid")]),  # along the surface
        (("G1 Z-1 F100", "G0 Z5", "G0 X5"), []),
        (("G1 Z-4 F100", "G0 Z1", "G0 Z-3.9", "G1 Z-8", "G0 Z1"), []),  # pecks
        (("G1 Z-4 F100", "G0 Z1", "G0 Z-4.1"), [(7, "rapid")]),  # a peck too deep
        (("G1 Z-4 F100", "G0 Z1", "G0 X1", "G0 Z-3"), [(8, "rapid")]),  # not in that hole
    ],
)
def test_rapids_in_the_work_are_found(
    lines: tuple[str, ...], found: list[tuple[int, str]]
) -> None:
    assert rules(check(*lines)) == found


def test_cutting_with_the_tool_off_is_found() -> None:
    assert rules(check("M5", "G1 Z-1 F100", "G1 X5", "G0 Z5")) == [(6, "tool")]
    assert rules(check("S0", "G1 Z-1 F100", "G0 Z5")) == [(6, "tool")]
    assert rules(check("M5", "G1 Z1 F100", "G1 X5")) == []  # above the work


def test_a_laser_is_on_or_off_by_its_s() -> None:
    head = ["G21 G90", "M4 S0", "G0 X0 Y0"]
    burned = check_lines([*head, "G1 X5 S500 F600", "G0 X9 S0", "M5", "M2"], LASER)
    assert burned.may_start and [step.in_work for step in burned.steps] == [False, True, False]
    dragged = check_lines([*head, "G1 X5 S500 F600", "G0 X9", "M5", "M2"], LASER)
    assert rules(dragged) == [(5, "rapid")]
    over_run = check_lines([*head, "G1 X5 F600", "X9 S500", "X12 S0", "M5", "M2"], LASER)
    assert over_run.may_start and [each.rule for each in over_run.findings] == ["tool"]


def test_work_beside_and_below_the_stock_is_found() -> None:
    stock = Stock(20, 10, 18, corner_mm=(-1, -1), through_mm=0.3)
    part = ("G1 Z-18.3 F100", "G1 X19", "G0 Z5")
    assert check(*part, stock=stock).may_start
    assert rules(check(*part, stock=replace(stock, width_mm=19))) == [(6, "stock")]
    assert rules(check(*part, stock=replace(stock, through_mm=0.2))) == [(5, "depth")]
    # an arc that leaves the stock between its ends
    arc = ("G1 Z-1 F100", "G2 X0 Y8 I0 J4", "G0 Z5")
    assert rules(check(*arc, stock=stock)) == [(6, "stock")]


def test_a_surface_is_where_it_is_said_to_be() -> None:
    """Z0 on the table, below a board of 18 mm."""
    stock = Stock(100, 100, 18, surface_mm=18)
    assert rules(check("G0 X5", stock=stock)) == [(5, "rapid")]
    assert rules(check("G1 Z-1 F100", stock=stock))[-1] == (5, "depth")


def test_travel_out_of_the_machine_s_limits_is_found_where_it_gets_there() -> None:
    small = replace(ROUTER, travel_mm=(100.0, math.inf, 6.0))
    assert check("G0 X-50", "G0 X50", "G0 Y900", on=small).may_start
    found = check("G0 X-50", "G0 X50.1", on=small)
    assert rules(found) == [(6, "travel")] and "100.1 mm of X" in found.findings[0].what
    assert rules(check("G1 Z-1.1 F100", "G0 Z5", on=small)) == [(5, "travel")]


def test_a_missing_feed_is_found_once() -> None:
    assert rules(check("G1 X5", "G1 X6", "G1 X7 F100", "G1 X8")) == [(5, "feed")]


@pytest.mark.parametrize(
    ("line", "low", "high"),
    [
        ("G2 X0 Y10 I0 J5", (-5, 0, 5), (0, 10, 5)),
        ("G3 X10 Y0 Z-3 I5 J0", (0, -5, -3), (10, 0, 5)),  # a helix
        ("G18 G3 X10 Z5 I5 K0", (0, 0, 5), (10, 0, 10)),  # a bridge in Z X
        ("G19 G2 Y10 Z5 J5 K0", (0, 0, 5), (0, 10, 10)),
        ("G91 G1 X3 F1", (0, 0, 5), (3, 0, 5)),
        ("G20 G1 X1 F1", (0, 0, 5), (25.4, 0, 5)),
        ("G92 X100", (0, 0, 5), (0, 0, 5)),
    ],
)
def test_places_are_followed(
    line: str, low: tuple[float, ...], high: tuple[float, ...]
) -> None:
    bounds = bounds_mm(check("F600", line).steps)
    assert bounds is not None
    assert bounds[0] == pytest.approx(low, abs=5 * CHORD_SHARE)
    assert bounds[1] == pytest.approx(high, abs=5 * CHORD_SHARE)


def test_g92_moves_the_zero_and_not_the_tool() -> None:
    ends = [
        step.move.end_mm for step in check("G0 X10", "G92 X0", "G0 X5", "G92.1", "G0 X5").steps
    ]
    assert [end[0] for end in ends[-3:]] == pytest.approx([10, 15, 5], abs=ROUNDED_MM)


def test_a_canned_cycle_drills_where_it_stands() -> None:
    checked = check("G81 X10 Y5 Z-8 R1 F100", "X20", "G80", "G0 X0", on=LINUXCNC)
    assert checked.may_start
    depths = [step.move.end_mm for step in checked.steps if step.in_work and not step.is_rapid]
    assert depths == [(10, 5, -8), (20, 5, -8)]
    assert rules(check("G81 X1 Z-8 R1 F100"))[0] == (5, "word")  # Grbl has none


def test_g28_goes_up_and_not_through_the_work() -> None:
    checked = check("G1 Z-1 F100", "G91 G28 Z0", "G90", "G28 X0 Y0", "G0 X5")
    assert checked.may_start and checked.steps[-1].move.end_mm[2] == 5


def test_inverse_time_and_dwells_are_in_seconds() -> None:
    checked = check("G93 G1 X10 F6", "G94", "G4 P0.5")
    assert checked.steps[-2].move.feed_mm_s == pytest.approx(1.0, abs=ROUNDED_MM)
    assert checked.steps[-1].move.dwell_s == 0.5
    of_marlin = check_lines(["G90", "G4 P500", "G4 S2"], machine("marlin"))
    assert [step.move.dwell_s for step in of_marlin.steps] == [0.5, 2.0]


def test_what_cannot_be_read_keeps_the_program_from_being_started() -> None:
    for line in ("#1=5", "G0 X#1", "o100 call", "G5 X1 Y1 I1 J1 P1 Q1"):
        checked = check("F100", line, on=LINUXCNC)
        unread = [each.rule for each in checked.findings if each.stops]
        assert unread == ([] if line == "#1=5" else ["not read"]), line


def test_findings_of_one_cause_are_one_with_their_number() -> None:
    (found,) = [each for each in check("G64", "G0 X1", "G64", "G64").findings if each.stops]
    assert (found.line, found.lines, found.last_line) == (5, 3, 8)
    assert found.text.startswith(
        "line 5 (and 2 more, to line 8): grbl-router does not take G64"
    )


def test_programs_without_an_end_or_without_a_line_are_found() -> None:
    assert [each.rule for each in check_lines(["G0 X1"], LINUXCNC).findings][-1] == "end"
    assert check_lines(["G0 X1"], ROUTER).may_start
    assert not check_lines([""], ROUTER).may_start


@pytest.mark.parametrize("line", ["(caf\xe9)", "(stop!)", "G0 X1 ~"])
def test_characters_that_grbl_obeys_are_found_even_in_comments(line: str) -> None:
    """Grbl 1.1, serial.c: these never reach the line, and hold or start the machine."""
    assert (5, "character") in rules(check(line))
    assert "character" not in [rule for _, rule in rules(check(line, on=LINUXCNC))]


@given(st.floats(0, 6.28), st.floats(-6.28, 6.28).filter(lambda turn: abs(turn) > 0.01))
def test_the_bounds_of_an_arc_hold_all_of_it_and_no_more(first: float, turned: float) -> None:
    """Against 3600 places along it, 0.1 degrees apart at most."""
    radius_mm, apart_mm = 10.0, 10.0 * (1 - math.cos(math.radians(0.1)))
    angles = [first + turned * k / 3600 for k in range(3601)]
    places = [(radius_mm * math.cos(a), radius_mm * math.sin(a)) for a in angles]
    begin, end = (*places[0], 0.0), (*places[-1], 0.0)
    step = Step(Move(1, "G3", end, 1.0, (0.0, 0.0), turned), begin, True, True)
    low, high = step.bounds_mm()
    for axis in (0, 1):
        along = [place[axis] for place in places]
        assert low[axis] <= min(along) + ROUNDED_MM and low[axis] >= min(along) - apart_mm
        assert high[axis] >= max(along) - ROUNDED_MM and high[axis] <= max(along) + apart_mm


@pytest.mark.parametrize(
    ("on", "longest"),
    [(ROUTER, 79), (LINUXCNC, 252)],
    ids=["grbl-router", "linuxcnc"],
)
def test_the_longest_line_is_taken_and_one_more_is_not(on: Machine, longest: int) -> None:
    """Grbl counts words alone (protocol.c), LinuxCNC the whole line (interp_read.cc)."""
    line = "G0X1." + "0" * (longest - 5)
    assert check(line, on=on).may_start
    assert rules(check(line + "0", on=on)) == [(5, "length")]
    spaced = "G0 X1." + "0" * (longest - 5) + " (x)"
    assert check(spaced, on=on).may_start == (on is ROUTER)


def test_words_with_a_letter_that_is_not_taken_are_one_finding() -> None:
    found = [each for each in check("G1 X1 E1.5 F9", "G1 X2 E2.5").findings if each.stops]
    assert [(each.line, each.lines) for each in found] == [(5, 2)]
    assert "does not take E1.5; allowed: letters: G M F I J K" in found[0].text


def test_a_value_that_is_set_moves_nothing() -> None:
    lines = ["N10 #<holes> = 4", "#1=5", "M190 P-1"]  # a number of the user's own command
    assert check(*lines, on=LINUXCNC).may_start


def test_a_place_after_a_computed_one_is_not_held_against_an_arc() -> None:
    lost = ["G0 X#1", "G3 X10 Y0 I5 J0 F600"]
    assert rules(check(*lost, on=LINUXCNC)) == [(5, "not read")]
    found = check(*lost, "G3 X20 Y0 I5.2 J0", on=LINUXCNC)  # X10 has been read by now
    assert rules(found) == [(5, "not read"), (7, "arc")]


def test_a_helix_has_its_turns_and_a_slip_of_the_finger_does_not_take_for_ever() -> None:
    deep = check("G1 Z0 F100", "G3 X0 Y0 Z-6 I5 P3", "G0 Z5", on=LINUXCNC)
    length_mm = sum(step.length_mm for step in deep.steps if step.move.line == 6)
    # chords of 5 degrees are shorter than their arc by 0.03 %
    assert length_mm == pytest.approx(math.hypot(3 * 10 * math.pi, 6), rel=1e-3)
    for line in ("G3 X0 Y0 I5 P1000000000 F100", "G91 G81 X1 R0 Z-1 L1000000000 F100"):
        assert check(line, on=LINUXCNC).steps
