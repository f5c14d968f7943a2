"""The operator's card: what it says is what is set, and every mistake is refused with its line, field,
contents and what may stand there.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.faults import CardFault, FileFault
from morfax.tracer.operator.card import Card, Drill, Stop
from morfax.tracer.operator.zunit import Preset
from tests.tracer.operator.cards import WHOLE


def test_a_card_says_what_is_set() -> None:
    assert Card.parse(WHOLE) == Card(
        start_mm=2.0,
        depths_mm=(2.0, 4.0),
        trace_mm_s=10.0,
        feed_mm_s=5.0,
        rapid_mm_s=50.0,
        restart="manual",
        turns=("straight", "left"),
        override=(3,),
        stops=(
            Stop(
                1,
                (Preset(700, "down", 2.0), Preset(0, dwell_s=0.5), Preset(254, "up", 5.0)),
                restart="automatic",
            ),
            Stop(None, drill=Drill(800, 300, dwell_s=0.2)),
        ),
    )


def test_the_card_of_the_documentation_is_one() -> None:
    text = (Path(__file__).parents[3] / "docs" / "reference" / "card.md").read_text(
        encoding="utf-8"
    )
    card = Card.parse(text.split("```toml\n")[1].split("```")[0])
    assert (
        card.depths_mm == (2.0, 4.0)
        and card.stop(1).moves
        and card.stop(2).drill == Drill(800, 300, dwell_s=0.2)
    )


def test_an_empty_card_says_nothing() -> None:
    assert Card.parse("") == Card.parse("# nothing\r\n") == Card()


def test_a_stop_has_its_own_entry_or_that_of_all_others() -> None:
    card = Card.parse(WHOLE)
    assert card.stop(1).moves and card.stop(2) == card.stop(9) == card.stops[1]
    assert Card().stop(4) == Stop(4)


def test_moves_that_name_no_feed_have_that_of_the_card() -> None:
    (stop,) = Card.parse(
        'speeds.feed = 3\n[[stop]]\nmoves = [{ down = 1 }, { up = 1, feed = "60mm/min" }]'
    ).stops
    assert [preset.feed_mm_s for preset in stop.moves] == [3.0, 1.0]


# mistakes


LENGTH = "it may hold 0.01 to 999.99 mm in steps of 0.01 mm"
SPEED = "it may hold a speed of 0.01 to 100 mm/s"
TIME = "it may hold a time of 0 to 600 s"
TOML = 'a line may hold key = "value"'
MISTAKES = [
    # text, line, field, what it holds, what it may hold
    ("depth = 5mm", 1, "the card", '"depth = 5mm"', TOML),
    ("start = 2\ndepth", 2, "the card", '"depth"', TOML),
    ("depth = 1\ndepth = 2", 2, "the card", '"depth = 2"', TOML),
    (
        "x = " + "[" * 9999,
        1,
        "the card",
        "too many brackets in one another",
        "it may hold 8",
    ),
    ("a = " + "9" * 5000, 1, "the card", '"a = ' + "9" * 35 + "…", TOML),
    (
        "\n\ndeep = 5",
        3,
        "deep",
        "5",
        "no such field; the card may hold start, depth, passes, entry, restart",
    ),
    (
        "[speeds]\nfede = 5",
        2,
        "speeds.fede",
        "5",
        "no such field; speeds may hold trace, feed, rapid",
    ),
    ('depth = "5kg"', 1, "depth", '"5kg"', LENGTH),
    ('depth = "0.015mm"', 1, "depth", '"0.015mm"', LENGTH),
    ("depth = 0", 1, "depth", "0", LENGTH),
    ("depth = -1", 1, "depth", "-1", LENGTH),
    ('depth = "1m"', 1, "depth", '"1m"', LENGTH),
    ("depth = nan", 1, "depth", "NaN", LENGTH),
    ("depth = 1e400", 1, "depth", "Infinity", LENGTH),
    ("depth = true", 1, "depth", "true", LENGTH),
    ("depth = [1]", 1, "depth", "[1]", LENGTH),
    ("depth = 2026-01-01", 1, "depth", '"2026-01-01"', LENGTH),
    ("depth = 0x" + "f" * 5000, 1, "depth", "a number too long", LENGTH),
    (
        'start = "50um"',
        1,
        "start",
        '"50um"',
        "it may hold 0.06 to 999.99 mm",
    ),  # that is in the work
    ("passes = 3", 1, "passes", "3", "it may hold depths, each deeper than the one before"),
    ("passes = []", 1, "passes", "[]", "it may hold depths, each deeper than the one before"),
    (
        "passes = [\n1,\n  2,\n2]",
        4,
        "passes[3]",
        "2",
        "it may hold more than the pass before, 2 mm",
    ),
    ("passes = [1]\ndepth = 2", 2, "depth", "2", "give passes or depth, not both"),
    ('restart = "by hand"', 1, "restart", '"by hand"', 'it may hold "automatic" or "manual"'),
    ('turns = "left"', 1, "turns", '"left"', 'a list of "straight", "left" and "right"'),
    (
        'turns = ["left",\n"back"]',
        2,
        "turns[2]",
        '"back"',
        'it may hold "straight" or "left" or "right"',
    ),
    (
        'override = "some"',
        1,
        "override",
        '"some"',
        'it may hold "none", "all" or a list of stops, such as [1, 3]',
    ),
    ("override = [0]", 1, "override[1]", "0", "it may hold a whole number from 1"),
    ("override = [true]", 1, "override[1]", "true", "it may hold a whole number from 1"),
    ("speeds = 5", 1, "speeds", "5", "it may hold a table with trace, feed, rapid"),
    ("[speeds]\nfeed = 0", 2, "speeds.feed", "0", SPEED),
    ('[speeds]\n\nrapid = "1m/s"', 3, "speeds.rapid", '"1m/s"', SPEED),
    ('speeds.trace = "10mm"', 1, "speeds.trace", '"10mm"', SPEED),
    ("stop = 3", 1, "stop", "3", "it may hold entries [[stop]]"),
    ("stop = [1]", 1, "stop[1]", "1", "it may hold a table with number, moves, drill"),
    ("[[stop]]\nnumber = 1.0", 2, "stop[1].number", "1.0", "it may hold a whole number from 1"),
    (
        "[[stop]]\n[[stop]]",
        2,
        "stop[2]",
        "{}",
        "an entry before it is for the same stops; it may hold a number",
    ),
    (
        "[[stop]]\nnumber=2\n[[stop]]\nnumber=2",
        3,
        "stop[2]",
        '{"number": 2}',
        "it may hold another number",
    ),
    (
        "[[stop]]\npasses = [1]\ndrill.depth = 1",
        2,
        "stop[1].passes",
        "[1]",
        "give drill or passes, not both",
    ),
    ("[[stop]]\ndwell = -1", 2, "stop[1].dwell", "-1", TIME),
    ("[[stop]]\ndwell = '1h'", 2, "stop[1].dwell", '"1h"', TIME),
    (
        "[[stop]]\nmoves = {}",
        2,
        "stop[1].moves",
        "{}",
        'it may hold moves such as [{ down = "7mm"',
    ),
    (
        "[[stop]]\nmoves = [\n{},\n]",
        3,
        "stop[1].moves[1]",
        "{}",
        "it may hold either down or up",
    ),
    (
        "[[stop]]\nmoves = [{up=1,down=1}]",
        2,
        "stop[1].moves[1]",
        '{"up": 1, "down": 1}',
        "either down or up",
    ),
    (
        "[[stop]]\nmoves = [{dwell=1,feed=1}]",
        2,
        "stop[1].moves[1]",
        '{"dwell": 1, "feed": 1}',
        "a dwell alone",
    ),
    (
        "[[stop]]\n[[stop.moves]]\nup = 1\nby = 2",
        4,
        "stop[1].moves[1].by",
        "2",
        "may hold down, up, feed, dwell",
    ),
    (
        "[[stop]]\n[stop.drill]\npeck = 1",
        2,
        "stop[1].drill",
        '{"peck": 1}',
        "it must hold a depth",
    ),
    (
        "[[stop]]\n[stop.drill]\ndepth = 1\npeck = 2",
        4,
        "stop[1].drill.peck",
        "2",
        "it may hold the depth at most, 1 mm",
    ),
]


@pytest.mark.parametrize(("text", "line", "field", "holds", "allowed"), MISTAKES)
def test_a_mistake_is_refused_with_its_line_field_contents_and_what_may_stand_there(
    text: str, line: int, field: str, holds: str, allowed: str
) -> None:
    with pytest.raises(CardFault) as caught:
        Card.parse(text, "part.toml")
    fault = caught.value
    assert (fault.line, fault.field, fault.holds) == (line, field, holds)
    assert str(fault).startswith(
        f"part.toml, line {line}: {field} holds {holds}; "
    ) and allowed in str(fault)
    assert "\n" not in str(fault) and len(str(fault)) < 400


@given(st.text())
def test_whatever_stands_on_a_card_it_is_read_or_refused(text: str) -> None:
    try:
        assert isinstance(Card.parse(text), Card)
    except CardFault as fault:
        assert 1 <= fault.line <= text.count("\n") + 1


def test_a_file_that_is_no_card_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "part.toml"
    with pytest.raises(FileFault, match=r"cannot read the card .*part.toml: No such file"):
        Card.open(file)
    file.write_bytes(b"# part\ndepth = '\xff'")
    with pytest.raises(
        CardFault, match=r"part.toml, line 2: the card holds bytes that are no UTF-8; "
    ):
        Card.open(file)
    file.write_bytes(b"\xef\xbb\xbfdepth = 3\r\n")  # as some editors write it
    assert Card.open(file).depths_mm == (3.0,)
