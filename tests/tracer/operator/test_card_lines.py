"""A card written and read again, the line of each of its fields, and what is done at a stop."""

from __future__ import annotations

import json
import tomllib
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.faults import CardFault
from morfax.motion.toml_lines import lines_of
from morfax.tracer.operator.card import Card, Drill, Stop
from morfax.tracer.operator.zunit import LARGEST_COUNT, Counters, Preset, moves, z_moves
from tests.tracer.operator.cards import WHOLE

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
