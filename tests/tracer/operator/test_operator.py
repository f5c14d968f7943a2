"""What Z does at each halt: from the marks, the card, and somebody at the panel."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from morfax.motion.faults import CardFault
from morfax.tracer.following.line import Line
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.marks.marks import Mark
from morfax.tracer.operator.card import Card, Stop
from morfax.tracer.operator.operator import STAND_S, Operator
from morfax.tracer.operator.work import Halt, Work
from morfax.tracer.operator.zunit import QuillMove

Z = list[tuple[float, ...]]
WAY = np.column_stack([np.linspace(0, 100, 1001), np.zeros(1001)])  # position k is at k / 10 mm


def tick(at: float) -> Mark:
    return Mark("tick", (at / 10, 0.0), at)


def line(*marks: Mark, guides: tuple[GuideLine, ...] = (), ending: str = "joined") -> Line:
    """A lead line of 30 mm from a reference point, and its loop; or a guide line that ends."""
    loop_from = 300 if ending == "joined" else None
    return Line(
        WAY,
        ending,
        0.5,
        100.0,
        loop_from=loop_from,
        marks=marks,
        guides=guides,
        reference_mm=(0.0, 0.0),
    )


def done(operator: Operator, *lines: Line) -> list[list[tuple[str, list[float]]]]:
    """Kind of each halt where something is done, and where Z goes."""
    return [
        [(a.halt.kind, [m.to_mm for m in a.moves]) for a in actions]
        for actions in operator.actions(lines)
    ]


WORK = Work(depth_mm=4.0, clearance_mm=2.0)
PLAIN = Operator(WORK)


def test_the_tool_goes_down_at_the_last_tick_of_the_lead_line() -> None:
    made = done(PLAIN, line(tick(100), tick(250), tick(600)))
    assert made == [[("tick", [2.0]), ("tick", [-4.0]), ("tick", [-4.0])]]
    dwell = PLAIN.actions([line(tick(100), tick(250), tick(600))])[0]
    assert [action.moves[-1].dwell_s for action in dwell] == [STAND_S, 0.0, STAND_S]


def test_a_dwell_alone_is_added_to_what_is_usual_at_a_stop() -> None:
    card = Card.parse("[[stop]]\ndwell = 2\n")
    made = Operator(WORK, card).actions([line(tick(100), tick(250), tick(600))])[0]
    assert [[move.to_mm for move in action.moves] for action in made] == [[2.0], [-4.0], [-4.0]]
    assert [action.moves[-1].dwell_s for action in made] == [2.0, 2.0, 2.0]


def test_without_a_tick_it_goes_down_where_the_loop_begins() -> None:
    assert done(PLAIN, line()) == [[("loop", [-4.0])]]


def test_a_guide_line_is_run_raised_and_a_hole_is_drilled_at_its_end() -> None:
    guide = GuideLine(500, 600, 700)
    made = done(PLAIN, line(tick(250), guides=(guide,)))
    assert made == [
        [("tick", [-4.0]), ("leave", [2.0]), ("hole", [-4.0, 2.0]), ("back", [-4.0])]
    ]


def test_a_guide_line_from_the_reference_point_is_drilled_at_its_end() -> None:
    assert done(PLAIN, line(ending="ended")) == [[("hole", [-4.0, 2.0])]]


def test_a_dot_at_the_end_is_the_hole_and_no_other() -> None:
    halts = PLAIN.actions([line(Mark("dot", (99.5, 0.0), 995.0), ending="ended")])[0]
    assert [(action.halt.kind, action.halt.number, action.halt.at) for action in halts] == [
        ("hole", 1, 995.0)
    ]


def test_stops_are_numbered_over_all_lines() -> None:
    lines = [line(tick(100), tick(250)), line(tick(200))]
    numbers = [action.halt.number for actions in PLAIN.actions(lines) for action in actions]
    assert numbers == [1, 2, 3]


@pytest.mark.parametrize(("override", "left"), [((2,), [1, 3]), ("all", []), ((1, 3), [2])])
def test_overridden_marks_are_passed_by(override: object, left: list[int]) -> None:
    operator = Operator(WORK, Card(override=override))  # type: ignore[arg-type]
    made = operator.actions([line(tick(400), tick(500), tick(600))])[0]
    assert [a.halt.number for a in made if a.halt.number is not None] == left


def test_the_card_says_what_is_done_at_a_stop() -> None:
    card = Card.parse('[[stop]]\nnumber = 2\nmoves = [{ down = "1mm" }, { up = "3mm" }]\n')
    assert done(Operator(WORK, card), line(tick(250), tick(600)))[0][1] == (
        "tick",
        [-5.0, -2.0],
    )


def test_passes_of_the_stop_where_the_tool_goes_down_are_the_lines() -> None:
    operator = Operator(WORK, Card.parse('[[stop]]\nnumber = 1\npasses = ["1mm", "3mm"]\n'))
    assert done(operator, line(tick(250)))[0][0] == ("tick", [-1.0])
    first, second = operator.actions([line(tick(250)), line(tick(250))])
    assert operator.depths_mm(first) == (1.0, 3.0) and operator.depths_mm(second) == (
        4.0,
    )  # which is stop 2


def test_passes_below_a_tool_that_has_gone_up_are_refused() -> None:
    """The further passes have no stops: they were left out, and nothing was said."""
    up = '[[stop]]\nnumber = 2\nmoves = [{ up = "9mm" }]\n'
    card = 'passes = ["1mm", "3mm"]\n' + up
    operator = Operator(replace(WORK, passes_mm=(1.0,), depth_mm=3.0), Card.parse(card))
    with pytest.raises(
        CardFault,
        match=r"at stop 2, .* the tool goes up .* further passes, at 3 mm, have no stops",
    ):
        operator.actions([line(tick(250), tick(600))])
    again = Card.parse(card + '[[stop]]\nnumber = 3\nmoves = [{ down = "9mm" }]\n')
    assert (
        len(replace(operator, card=again).actions([line(tick(250), tick(600), tick(700))])[0])
        == 3
    )
    assert (
        len(Operator(WORK, Card.parse(up)).actions([line(tick(250), tick(600))])[0]) == 2
    )  # one depth


@pytest.mark.parametrize(
    ("entry", "number", "said"),
    [
        (
            'moves = [{ up = "1mm" },\n{ up = "999.99mm" }]',
            3,
            'stop[1].moves[2] holds {"up": "999.99mm"}',
        ),
        (
            'drill = { depth = "999.99mm", peck = "1mm" }\ndwell = 1',
            2,
            'stop[1].drill holds {"depth": "999.99mm"',
        ),
    ],
)
def test_a_move_that_five_digits_cannot_show_names_its_line_its_field_and_its_stop(
    entry: str, number: int, said: str
) -> None:
    card = Card.parse(f"[[stop]]\n{entry}\n", "part.toml")
    with pytest.raises(CardFault) as caught:
        Operator(WORK, card).actions([line(tick(250))])
    assert (
        str(caught.value).startswith(f"part.toml, line {number}: {said}")
        and caught.value.line == number
    )
    assert re.search(
        r"; at stop 1, 25\.00,0\.00 mm: .* (cannot show|cannot be set on) ", str(caught.value)
    )


@dataclass
class Present:
    """Somebody at the panel, who drills one millimetre at every stop and takes 3 s to press the button."""

    asked: list[int | None] = field(default_factory=list)

    def ask(self, halt: Halt, z_mm: float, usual: Sequence[QuillMove]) -> Stop | None:
        self.asked.append(halt.number)
        return Card.parse('[[stop]]\nmoves = [{ up = "1mm" }]\n').stop(1)

    def wait(self, halt: Halt) -> float:
        return 3.0


def test_somebody_at_the_panel_is_asked_at_every_stop_in_order() -> None:
    panel = Present()
    assert done(Operator(WORK, panel=panel), line(tick(100), tick(250)))[0][:2] == [
        ("tick", [3.0]),
        ("tick", [4.0]),
    ]
    assert panel.asked == [1, 2]


def test_the_button_takes_its_time_and_needs_somebody() -> None:
    card = Card(restart="manual")
    made = Operator(WORK, card, Present()).actions([line(tick(250))])[0]
    assert made[0].moves[-1].dwell_s == 3.0
    with pytest.raises(CardFault, match="nobody is at the panel"):
        Operator(WORK, card).actions([line(tick(250))])


def test_stops_that_the_card_names_and_the_drawing_lacks_are_known() -> None:
    card = Card.parse(
        "override = [1, 5]\n[[stop]]\nnumber = 3\ndwell = 1\n[[stop]]\nnumber = 2\ndwell = 1\n"
    )
    assert Operator(WORK, card).not_there([line(tick(250)), line(tick(600))]) == ([3, 5], 2)
    assert PLAIN.not_there([line(tick(250))]) == ([], 1)
