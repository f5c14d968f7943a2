"""The tape format: a line of JSON that is taken whole or not at all."""

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.faults import TapeFault
from morfax.recorder.tape.format import (
    LARGEST_TEXT_BYTES,
    TapeFormat,
    columns_of,
    is_format_text,
)

GOOD = json.loads(TapeFormat(end_mm=(1.0, 2.0, 3.0)).to_json())

millimetres = st.floats(-1e6, 1e6)


@given(
    st.floats(1.0, 17_999.0),
    st.floats(1e-3, 1e4),
    st.lists(
        st.tuples(st.text("xyzabcuvw", min_size=1, max_size=5), millimetres, millimetres),
        min_size=1,
        max_size=15,
    ),
)
def test_a_format_reads_back(
    reference_hz: float, cycles_per_mm: float, axes: list[tuple[str, float, float]]
) -> None:
    of_axis = {name: (start, end) for name, start, end in axes}
    names, starts, ends = tuple(of_axis), *zip(*of_axis.values(), strict=True)
    fmt = TapeFormat(
        reference_hz=reference_hz,
        cycles_per_mm=cycles_per_mm,
        axes=names,
        start_mm=starts,
        end_mm=ends,
    )
    text = fmt.to_json()
    assert TapeFormat.from_json(text) == fmt
    assert is_format_text(text)
    assert "\n" not in text
    assert len(text) <= LARGEST_TEXT_BYTES


def test_the_defaults_are_those_of_the_design() -> None:
    fmt = TapeFormat()
    assert (fmt.tracks, fmt.motion_rate_hz, fmt.mm_per_cycle) == (4, 6000.0, 0.05)
    assert (fmt.largest_deviation_hz, fmt.largest_speed_mm_s) == (2000.0, 100.0)
    assert fmt.start_mm == (0.0, 0.0, 0.0)
    assert fmt.end_mm is None


@pytest.mark.parametrize(
    ("entry", "value", "fault"),
    [
        ("version", 4, "version 4; this program reads 3"),
        ("version", "1", "version is 1; it must be 1 to 3"),
        ("version", True, "version is True"),
        ("sample_rate_hz", 48000.5, "sample_rate_hz is 48000.5; it must be a whole number"),
        ("sample_rate_hz", 0, "sample_rate_hz is 0"),
        ("reference_hz", -6000, "reference_hz is -6000; it must be a number above zero"),
        ("reference_hz", float("nan"), "reference_hz is nan"),
        ("reference_hz", 18000, "below half the sample rate of 48000 Hz"),
        ("reference_hz", 10**400, "reference_hz is 1000"),
        ("cycles_per_mm", None, "cycles_per_mm is None"),
        ("axes", [], "1 to 15 different names"),
        ("axes", ["x", "x", "z"], "1 to 15 different names"),
        ("axes", "xyz", "1 to 15 different names"),
        ("axes", [["x"], "y", "z"], "1 to 15 different names"),
        ("start_mm", [1, 2], r"start_mm is \(1, 2\); it must be 3 numbers of mm"),
        ("start_mm", [1, 2, "3"], "3 numbers of mm"),
        ("end_mm", [1, 2, float("inf")], "3 numbers of mm"),
        ("dwell_s", -1, "dwell_s is -1"),
        ("level", 1.5, "level is 1.5; it must be at most 1"),
        ("samples_per_motion", 1, "whole number from 2"),
    ],
)
def test_an_entry_that_cannot_be_is_refused(entry: str, value: Any, fault: str) -> None:
    with pytest.raises(TapeFault, match=fault) as caught:
        TapeFormat.from_json(json.dumps({**GOOD, entry: value}))
    assert "\n" not in str(caught.value)


def test_entries_too_many_or_too_few_are_refused() -> None:
    with pytest.raises(TapeFault, match="unknown entry 'waveform'"):
        TapeFormat.from_json(json.dumps({**GOOD, "waveform": "square"}))
    for entry in GOOD:
        with pytest.raises(TapeFault, match=f"lacks {entry}"):
            TapeFormat.from_json(
                json.dumps({name: value for name, value in GOOD.items() if name != entry})
            )


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "null", "remark", "[" * 1900, '{"version": 1' + " " * 3000 + "}"]
)
def test_what_is_no_object_is_refused(text: str) -> None:
    with pytest.raises(TapeFault, match="text chunk"):
        TapeFormat.from_json(text)


@given(
    st.recursive(
        st.none() | st.booleans() | st.floats() | st.text(max_size=5),
        lambda inner: st.lists(inner, max_size=4),
    )
)
def test_any_value_is_a_format_or_a_fault_of_one_line(value: Any) -> None:
    for entry in GOOD:
        try:
            TapeFormat.from_json(json.dumps({**GOOD, entry: value}))
        except TapeFault as fault:
            assert "\n" not in str(fault)


def test_a_remark_is_no_format() -> None:
    assert not is_format_text("made with a sound editor")
    assert not is_format_text("")


AXES = tuple(f"a{k}" for k in range(16))


@pytest.mark.parametrize(
    ("good", "bad"),
    [
        ({"sample_rate_hz": 2**31}, {"sample_rate_hz": 2**31 + 1}),
        ({"samples_per_motion": 2}, {"samples_per_motion": 1}),
        ({"samples_per_motion": 10_000}, {"samples_per_motion": 10_001}),
        ({"reference_hz": 17_999.0}, {"reference_hz": 18_000.0}),  # a third more is 24 kHz
        ({"cycles_per_mm": 1e-9}, {"cycles_per_mm": 0.0}),
        ({"cycles_per_mm": 9e11}, {"cycles_per_mm": 1e12}),
        ({"dwell_s": 0.0}, {"dwell_s": -1e-9}),
        ({"dwell_s": 3600.0}, {"dwell_s": 3601.0}),
        ({"level": 1.0}, {"level": 1.001}),
        # the check signal takes a fifth of the carrier more
        ({"level": 1 / 1.2, "checked": True}, {"level": 0.84, "checked": True}),
        ({"reference_hz": 5000.0, "checked": True}, {"reference_hz": 4999.0, "checked": True}),
        ({"reference_hz": 4999.0}, {"reference_hz": 0.0}),
        ({"axes": AXES[:15]}, {"axes": AXES}),
        ({"axes": ("a" * 10,)}, {"axes": ("a" * 11,)}),
        ({"axes": ("x",)}, {"axes": ("ä",)}),
        ({"still": ("x", "z")}, {"still": ("x", "w")}),
        ({"alike": ("x", "y")}, {"alike": ("w",)}),
        ({"pickup": "coil"}, {"pickup": "needle"}),
    ],
)
def test_a_format_is_taken_at_its_bounds_and_refused_beyond_them(
    good: dict[str, Any], bad: dict[str, Any]
) -> None:
    fmt = TapeFormat(**good)
    for name, value in good.items():
        assert getattr(fmt, name) == value
    with pytest.raises(ValueError, match="; it must be"):
        TapeFormat(**bad)


def test_the_version_is_the_lowest_that_can_say_it() -> None:
    assert TapeFormat().version == 1
    assert TapeFormat(pickup="coil").version == 2
    for entry in ("still", "alike"):
        assert TapeFormat(**{entry: ("x",)}).version == 3  # type: ignore[arg-type]
    assert "pickup" not in json.loads(TapeFormat().to_json())
    assert "still" not in json.loads(TapeFormat(pickup="coil").to_json())


def test_speeds_and_travel_follow_from_reference_and_cycles() -> None:
    """A third of the reference is the most; 8 samples to a period of the motion."""
    fmt = TapeFormat(
        sample_rate_hz=96_000, reference_hz=9000.0, cycles_per_mm=50.0, axes=("x", "y")
    )
    assert (fmt.largest_deviation_hz, fmt.largest_speed_mm_s) == (3000.0, 60.0)
    assert (fmt.tracks, fmt.motion_rate_hz, fmt.mm_per_cycle) == (3, 12_000.0, 0.02)
    assert fmt.carrier.reference_cycles == 0.75
    assert fmt.can_be_checked and not TapeFormat(reference_hz=4000.0).can_be_checked


@pytest.mark.parametrize("order", [(1, 2, 2, 3), (0, 1, 2, 3), (2, 3, 4, 5), (1, 2, 3)])
def test_an_order_names_each_track_once(order: tuple[int, ...]) -> None:
    with pytest.raises(TapeFault, match="are no order; name each of the tracks 1 to 4 once"):
        columns_of(order, 4)
    assert columns_of((2, 1, 4, 3), 4) == [1, 0, 3, 2] and columns_of(None, 4) is None
