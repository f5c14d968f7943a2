"""Units: what is understood, what is refused, and that printing and reading agree."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion import units


@pytest.mark.parametrize(
    ("text", "length_mm"),
    [
        ("10mm", 10.0),
        ("10", 10.0),
        (" 10 mm ", 10.0),
        ("0.4in", 10.16),
        ("1/8in", 3.175),
        ('1 1/2"', 38.1),
        ("1-1/4 in", 31.75),
        ('0.4"', 10.16),
        ("50um", 0.05),
        ("50µm", 0.05),  # micro sign
        ("50μm", 0.05),  # Greek mu
        ("1CM", 10.0),
        ("-3.5", -3.5),
        (".5", 0.5),
        ("1e-2mm", 0.01),
        ("0.1 m", 100.0),
    ],
)
def test_lengths(text: str, length_mm: float) -> None:
    assert units.parse_length_mm(text) == pytest.approx(length_mm, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "speed_mm_s"),
    [
        ("10mm/s", 10.0),
        ("10", 10.0),
        ("1200mm/min", 20.0),
        ("24in/min", 10.16),
        ("1.2 m/min", 20.0),
        ("1in/s", 25.4),
    ],
)
def test_speeds(text: str, speed_mm_s: float) -> None:
    assert units.parse_speed_mm_s(text) == pytest.approx(speed_mm_s, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "hz"), [("6kHz", 6000.0), ("48000", 48000.0), ("400 hz", 400.0), ("0.5KHZ", 500.0)]
)
def test_frequencies(text: str, hz: float) -> None:
    assert units.parse_frequency_hz(text) == hz


@pytest.mark.parametrize(
    ("text", "time_s"),
    [("2s", 2.0), ("300ms", 0.3), ("0", 0.0), ("1min", 60.0), ("1h", 3600.0)],
)
def test_times(text: str, time_s: float) -> None:
    assert units.parse_time_s(text) == pytest.approx(time_s, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "angle_deg"),
    [
        ("90deg", 90.0),
        ("-45", -45.0),
        ("30°", 30.0),
        ("0.25turn", 90.0),
        ("3.141592653589793rad", 180.0),
    ],
)
def test_angles(text: str, angle_deg: float) -> None:
    assert math.degrees(units.parse_angle_rad(text)) == pytest.approx(angle_deg, rel=1e-15)


@pytest.mark.parametrize(("text", "share"), [("120%", 1.2), ("50 %", 0.5), ("1.5", 1.5)])
def test_shares(text: str, share: float) -> None:
    assert units.parse_share(text) == pytest.approx(share, rel=1e-15)


@pytest.mark.parametrize("text", ["0%", "-5%", "90deg", ""])
def test_a_share_that_is_none(text: str) -> None:
    with pytest.raises(ValueError, match=r"is no share; give 120%"):
        units.parse_share(text)


def test_places() -> None:
    assert units.parse_place_mm("12.5,-30") == (12.5, -30.0)
    assert units.parse_place_mm("1in, 2 cm") == (25.4, 20.0)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "mm",
        "ten mm",
        "10 furlongs",
        "1,5",
        "nan",
        "inf",
        "1e999",
        "1.1km",
        "1001m",
        "1e300",
        "10mm/s",
        "0x10",
        "1 0mm",
        "1/8",
        "1/8mm",
        "1/0in",
    ],
)
def test_a_length_that_is_none_says_what_is_allowed(text: str) -> None:
    with pytest.raises(ValueError, match=r"no length; give 10mm, 50um") as caught:
        units.parse_length_mm(text)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("text", ["0", "-1mm/s", "5mm", "fast"])
def test_a_speed_must_be_above_zero(text: str) -> None:
    with pytest.raises(ValueError, match="above zero"):
        units.parse_speed_mm_s(text)


@pytest.mark.parametrize("text", ["-1s", "5mm"])
def test_a_time_is_not_negative(text: str) -> None:
    with pytest.raises(ValueError, match="zero or more"):
        units.parse_time_s(text)


@pytest.mark.parametrize("text", ["0Hz", "6kh", "-6kHz"])
def test_a_frequency_must_be_above_zero(text: str) -> None:
    with pytest.raises(ValueError, match="above zero"):
        units.parse_frequency_hz(text)


@pytest.mark.parametrize("text", ["5", "1,2,3", "a,b", ","])
def test_a_place_is_two_lengths(text: str) -> None:
    with pytest.raises(ValueError, match="two lengths with a comma"):
        units.parse_place_mm(text)


@pytest.mark.parametrize(
    ("length_mm", "text"),
    [
        (10.0, "10 mm"),
        (0.05, "50 um"),
        (0.0005, "0.5 um"),
        (0.0, "0 mm"),
        (-0.0, "0 mm"),
        (123.456, "123.5 mm"),
        (2e4, "20 m"),
    ],
)
def test_printed_lengths(length_mm: float, text: str) -> None:
    assert units.format_length_mm(length_mm) == text


def test_other_printed_quantities() -> None:
    assert units.format_frequency_hz(6000) == "6 kHz"
    assert units.format_frequency_hz(400) == "400 Hz"
    assert units.format_time_s(0.3) == "300 ms"
    assert units.format_time_s(59.5) == "59.5 s"
    assert units.format_time_s(3599.6) == "60 min 00 s"
    assert units.format_speed_mm_s(20) == "20 mm/s"
    assert units.format_place_mm(-0.001, 3.0) == "0.00, 3.00 mm"


FOUR_FIGURES = 0.51e-3  # half a unit in the fourth figure, at its worst relative to 1.000


@given(st.floats(1e-4, 1e6) | st.floats(-1e6, -1e-4))
def test_a_printed_length_reads_back(length_mm: float) -> None:
    assert units.parse_length_mm(units.format_length_mm(length_mm)) == pytest.approx(
        length_mm, rel=FOUR_FIGURES
    )


@given(st.floats(1e-3, 1e6))
def test_a_printed_speed_and_frequency_read_back(value: float) -> None:
    assert units.parse_speed_mm_s(units.format_speed_mm_s(value)) == pytest.approx(
        value, rel=FOUR_FIGURES
    )
    assert units.parse_frequency_hz(units.format_frequency_hz(value)) == pytest.approx(
        value, rel=FOUR_FIGURES
    )


@given(st.text(max_size=30))
def test_any_text_is_a_finite_length_or_a_value_error(text: str) -> None:
    try:
        assert math.isfinite(units.parse_length_mm(text))
    except ValueError as refusal:
        assert "\n" not in str(refusal)
