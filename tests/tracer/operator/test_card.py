"""The operator's card: what it says is what is set, and every mistake is refused with its line, field,
contents and what may stand there.
"""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.faults import CardFault, FileFault
from morfax.motion.toml_lines import lines_of
from morfax.tracer.operator.card import Card, Drill, Stop
from morfax.tracer.operator.zunit import LARGEST_COUNT, Counters, Preset, moves, z_moves

WHOLE = """\
# a plate with two holes
start = "2mm"
passes = [
    "2mm",
    "4mm",  # the last is the depth
]
restart = "manual"
turns = ["straight", "left"]
override = [3]

[speeds]
trace = "600mm/min"
feed = "5mm/s"
rapid = 50

[[stop]]
number = 1
moves = [
    { down = "7mm", feed = "2mm/s" },
    { dwell = "500ms" },
    { up = "0.1in" },
]
restart = "automatic"

[[stop]]
drill = { depth = "8mm", peck = "3mm", dwell = 0.2 }
"""


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


# round trips


def decades(least: int = 1) -> st.SearchStrategy[float]:
    return st.integers(least, 99_999).map(lambda counts: counts / 100)


SPEEDS = st.floats(0.01, 100)
DWELLS = st.floats(0, 600)
RESTARTS = st.sampled_from(["automatic", "manual"])
PASSES = st.lists(st.integers(1, 99_999), min_size=1, max_size=4, unique=True).map(
    lambda counts: tuple(c / 100 for c in sorted(counts))
)
PRESETS = st.builds(
    Preset, st.integers(1, 99_999), st.sampled_from(["up", "down"]), SPEEDS, DWELLS
)
DRILLS = st.builds(
    lambda pecks, **rest: Drill(max(pecks), min(pecks), **rest),
    st.tuples(st.integers(1, 99_999), st.integers(1, 99_999)),
    clear_counts=st.integers(1, 99_999),
    feed_mm_s=SPEEDS,
    dwell_s=DWELLS,
)
WHAT = st.one_of(
    st.just({}),
    st.fixed_dictionaries({"moves": st.lists(PRESETS, min_size=1, max_size=3).map(tuple)}),
    st.fixed_dictionaries({"drill": DRILLS}),
    st.fixed_dictionaries({"passes_mm": PASSES}),
)
STOPS = st.builds(
    lambda number, what, dwell_s, restart: Stop(
        number, dwell_s=dwell_s, restart=restart, **what
    ),
    st.none() | st.integers(1, 99),
    WHAT,
    DWELLS,
    st.none() | RESTARTS,
)
CARDS = st.builds(
    Card,
    st.none() | decades(6),
    st.just(()) | PASSES,
    st.none() | SPEEDS,
    st.none() | SPEEDS,
    st.none() | SPEEDS,
    st.none() | decades(1),
    RESTARTS,
    st.lists(st.sampled_from(["straight", "left", "right"]), max_size=3).map(tuple),
    st.sampled_from(["none", "all"])
    | st.lists(st.integers(1, 9), min_size=1, max_size=3).map(tuple),
    st.lists(STOPS, max_size=3, unique_by=lambda stop: stop.number).map(tuple),
)


def in_toml(value: Any) -> str:
    """A value as it stands in TOML."""
    if isinstance(value, dict):
        return (
            "{ "
            + ", ".join(
                f"{key} = {in_toml(held)}" for key, held in value.items() if held is not None
            )
            + " }"
        )
    if isinstance(value, list | tuple):
        return "[" + ",\n".join(in_toml(held) for held in value) + "]"
    return f'"{value}"' if isinstance(value, str) else repr(value)


def move_row(preset: Preset) -> dict[str, Any]:
    return {
        preset.sense: preset.counts / 100,
        "feed": preset.feed_mm_s,
        "dwell": preset.dwell_s,
    }


def stop_row(stop: Stop) -> dict[str, Any]:
    drill = stop.drill and {
        "depth": f"{stop.drill.depth_counts / 100}mm",
        "peck": f"{stop.drill.peck_counts / 100}mm",
        "clear": stop.drill.clear_counts / 100,
        "feed": stop.drill.feed_mm_s,
        "dwell": stop.drill.dwell_s,
    }
    moves, passes = [move_row(preset) for preset in stop.moves], list(stop.passes_mm)
    row = {
        "number": stop.number,
        "moves": moves or None,
        "drill": drill,
        "passes": passes or None,
    }
    return {**row, "dwell": stop.dwell_s, "restart": stop.restart}


def written(card: Card) -> str:
    """The card as an operator would write it."""
    rows = {
        "start": card.start_mm,
        "passes": card.depths_mm or None,
        "entry": card.entry_mm,
        "restart": card.restart,
    }
    rows |= {
        "turns": card.turns or None,
        "override": card.override,
        "stop": [stop_row(s) for s in card.stops] or None,
    }
    speeds = {"trace": card.trace_mm_s, "feed": card.feed_mm_s, "rapid": card.rapid_mm_s}
    rows |= {f"speeds.{name}": speed for name, speed in speeds.items()}
    return "\n".join(
        f"{key} = {in_toml(value)}" for key, value in rows.items() if value is not None
    )


@given(CARDS)
def test_a_card_written_and_read_is_the_same(card: Card) -> None:
    assert Card.parse(written(card)) == card


# lines

TEXTS = st.text(alphabet="ab[]{}=,.#\"'\\\n\t -", max_size=6)
VALUES = st.recursive(
    st.integers() | st.floats(allow_nan=False) | TEXTS,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXTS, inner, max_size=3),
    max_leaves=8,
)


def quoted(value: Any) -> str:
    """Any value in TOML, an element of an array on each line."""
    if isinstance(value, dict):
        return (
            "{"
            + ", ".join(f"{json.dumps(key)} = {quoted(held)}" for key, held in value.items())
            + "}"
        )
    if isinstance(value, list):
        return "[ # of\n" + ",\n\n".join(quoted(held) for held in value) + "]"
    return json.dumps(value) if isinstance(value, str) else str(value)


def paths_of(value: Any, path: tuple[str | int, ...] = ()) -> set[tuple[str | int, ...]]:
    """The paths of all fields."""
    inside = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    return {path}.union(*(paths_of(held, (*path, key)) for key, held in inside))


@given(
    st.dictionaries(TEXTS, VALUES, max_size=3),
    st.lists(st.dictionaries(TEXTS, VALUES, max_size=3), max_size=3),
)
def test_every_field_of_a_card_has_a_line(
    top: dict[str, Any], rows: list[dict[str, Any]]
) -> None:
    lines = [f"{json.dumps(key)} = {quoted(value)}" for key, value in top.items()]
    for row in rows:
        lines += [
            "[[ zz . 'rows' ]]",
            *(f"{json.dumps(key)}={quoted(value)} # a" for key, value in row.items()),
        ]
    text = "\n".join(lines)
    assert set(lines_of(text)) == paths_of(tomllib.loads(text))


def test_the_line_is_that_of_the_key() -> None:
    lines = lines_of(WHOLE)
    text = WHOLE.splitlines()
    for path, begins in {
        ("start",): "start =",
        ("passes", 1): '    "4mm"',
        ("speeds",): "[speeds]",
        ("speeds", "rapid"): "rapid =",
        ("stop",): "[[stop]]",
        ("stop", 0, "moves", 2, "up"): "    { up",
        ("stop", 1, "drill", "dwell"): "drill =",
    }.items():
        assert text[lines[path] - 1].startswith(begins)
    assert lines["stop", 1] > lines["stop", 0, "restart"]


def test_strings_of_several_lines_hide_what_is_in_them() -> None:
    text = 'a = """\n[b]\n\\"""c = 1""""\nd = \'\'\'\n#\'\'\'\'\ne.f = 1979-05-27 07:32:00\n'
    assert lines_of(text) == {(): 1, ("a",): 1, ("d",): 4, ("e",): 6, ("e", "f"): 6}
    assert set(lines_of(text)) == paths_of(tomllib.loads(text))


# what is done at a stop


@given(DRILLS, st.integers(-500, 500), SPEEDS)
def test_a_drill_goes_down_to_depth_peck_by_peck_and_comes_back(
    drill: Drill, at: int, rapid_mm_s: float
) -> None:
    if drill.depth_counts / drill.peck_counts > 500:
        return
    if at + drill.depth_counts > LARGEST_COUNT:  # the way out of the hole is longer
        with pytest.raises(ValueError, match="cannot be set on five decades"):
            drill.presets(Counters(at), rapid_mm_s)
        return
    presets = drill.presets(Counters(at), rapid_mm_s)
    bottom, here = max(0, -at), at
    for preset in presets:
        if preset.sense == "up":
            assert here + preset.counts == at  # all the way out, to clear the chips
        elif preset.feed_mm_s == rapid_mm_s and rapid_mm_s != drill.feed_mm_s:
            assert here - preset.counts >= -bottom  # at the rapid only where the hole is
        here += preset.signed
        assert here >= -bottom - drill.peck_counts
        bottom = max(bottom, -here)
    assert bottom == max(-at, drill.depth_counts, 0) and here == at


def test_a_hole_too_deep_to_come_out_of_in_one_move_is_refused_in_the_field_s_words() -> None:
    (stop,) = Card.parse('[[stop]]\ndrill = { depth = "999.99mm" }', "part.toml").stops
    assert stop.motor_moves(0.0, 50.0, "at stop 1")[-1].to_mm == 0.0
    with pytest.raises(
        CardFault, match=r"at stop 1: a move of 1000\.49 mm cannot be set"
    ) as told:
        stop.motor_moves(2.0, 50.0, "at stop 1")
    assert str(told.value).startswith("part.toml, line 2: stop[1].drill holds ")
    assert (told.value.line, told.value.field) == (2, "stop[1].drill")


@given(STOPS, st.integers(-LARGEST_COUNT, LARGEST_COUNT), SPEEDS)
def test_whatever_a_stop_asks_for_is_made_or_refused_as_a_mistake_of_the_card(
    stop: Stop, at: int, rapid_mm_s: float
) -> None:
    if stop.drill is not None and stop.drill.depth_counts / stop.drill.peck_counts > 500:
        return
    try:
        made = stop.motor_moves(at / 100, rapid_mm_s, "at stop 1")
    except CardFault as fault:
        assert "cannot" in str(fault)
    else:
        assert all(abs(move.to_mm) <= LARGEST_COUNT / 100 for move in made)


def test_a_stop_s_moves_are_made_by_the_z_unit_exactly() -> None:
    (stop,) = Card.parse("[[stop]]\ndwell = 0.5\ndrill = { depth = 8, peck = 3 }").stops
    z_mm = z_moves(2.0, moves(Counters(200), stop.presets(Counters(200), 50.0)))
    assert (z_mm[0], z_mm.min(), z_mm[-1]) == (2.0, -8.0, 2.0)
    assert (z_mm[-3000:] == 2.0).all()  # the dwell
    assert Stop(1, (Preset(5),)).presets(Counters(), 50.0) == (Preset(5),)
