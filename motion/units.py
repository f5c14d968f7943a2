"""Units at the edge: "10mm" becomes 10.0 and back again. All other modules know mm, s, Hz and rad only.

A bare number has one documented unit: mm, mm/s, Hz, s or degrees. A space may stand between number and unit,
and capitals do not matter.

    length      um µm mm cm m in " 1/8in     speed    mm/s mm/min m/min um/s cm/s in/s in/min
    frequency   Hz kHz MHz                   time     us ms s min h
    angle       deg ° rad turn               share    % or a bare number (1 is 100 %)
"""

from __future__ import annotations

import math
import re

LONGEST_MM = 1e6  # a kilometre: a longer length is a slip of the pen
MM_PER_INCH = 25.4  # exact since the international yard and pound agreement, 1959
POINTS_PER_INCH = 72.0  # of letters and of pages

_LENGTH_MM = {
    "mm": 1.0,
    "um": 1e-3,
    "cm": 10.0,
    "m": 1000.0,
    "in": MM_PER_INCH,
    '"': MM_PER_INCH,
}
_TIME_S = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0}
_FREQUENCY_HZ = {"hz": 1.0, "khz": 1e3, "mhz": 1e6}
_SPEED_MM_S = {
    "mm/s": 1.0,
    "mm/min": 1.0 / 60.0,
    "m/min": 1000.0 / 60.0,
    "um/s": 1e-3,
    "cm/s": 10.0,
    "in/s": MM_PER_INCH,
    "in/min": MM_PER_INCH / 60.0,
}
_ANGLE_RAD = {
    "": math.pi / 180,
    "deg": math.pi / 180,
    "°": math.pi / 180,
    "rad": 1.0,
    "turn": 2 * math.pi,
}
_SHARE = {"%": 0.01}
_MEMORY_BYTES = {"mb": 1e6, "gb": 1e9, "tb": 1e12, "mib": 2.0**20, "gib": 2.0**30}
_NUMBER_AND_UNIT = re.compile(
    r"([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*([a-z/\"°%]*)", re.ASCII
)
_INCHES = re.compile(r"(?:(\d+)[ -])?(\d+)/([1-9]\d*)\s*(?:in|\")", re.ASCII)


def parse_length_mm(text: str) -> float:
    """Length in mm of "10mm", "50um", "1/8in" or a bare number of mm, within a kilometre either way."""
    allowed = "10mm, 50um, 1cm, 0.4in, 1/8in or a bare number of mm, up to 1000m"
    if inches := _INCHES.fullmatch(text.strip().lower()):
        whole, above, below = (float(number or 0) for number in inches.groups())
        length_mm = (whole + above / below) * MM_PER_INCH
    else:
        length_mm = _parse(text, "length", _LENGTH_MM, allowed)
    if abs(length_mm) > LONGEST_MM:
        raise ValueError(_refusal(text, "length", allowed))
    return length_mm


def parse_speed_mm_s(text: str) -> float:
    """Speed in mm/s of "10mm/s", "1200mm/min", "24in/min" or a bare number of mm/s; above zero."""
    allowed = "10mm/s, 1200mm/min, 24in/min or a bare number of mm/s, above zero"
    return _positive(_parse(text, "speed", _SPEED_MM_S, allowed), text, "speed", allowed)


def parse_frequency_hz(text: str) -> float:
    """Frequency in Hz of "6kHz" or a bare number of Hz; above zero."""
    allowed = "6kHz, 400Hz or a bare number of Hz, above zero"
    return _positive(
        _parse(text, "frequency", _FREQUENCY_HZ, allowed), text, "frequency", allowed
    )


def parse_time_s(text: str) -> float:
    """Time in s of "2s", "300ms" or a bare number of s; zero or more."""
    allowed = "2s, 300ms, 1min or a bare number of s, zero or more"
    time_s = _parse(text, "time", _TIME_S, allowed)
    if time_s < 0:
        raise ValueError(_refusal(text, "time", allowed))
    return time_s


def parse_memory_bytes(text: str) -> float:
    """Memory in bytes of "2GB", "500MB", "1.5GiB"; a bare number is one of GB. Above zero."""
    allowed = "2GB, 800MB or 1.5GiB, above zero"
    words = text.strip()
    words = f"{words}GB" if words[-1:].isdigit() else words
    return _positive(_parse(words, "memory", _MEMORY_BYTES, allowed), text, "memory", allowed)


def parse_angle_rad(text: str) -> float:
    """Angle in rad of "90deg", "1.57rad", "0.25turn" or a bare number of degrees; it may be negative."""
    allowed = "90deg, -45deg, 1.57rad or a bare number of degrees"
    return _parse(text, "angle", _ANGLE_RAD, allowed)


def parse_share(text: str) -> float:
    """Share of "120%" or a bare number (1.2); above zero."""
    allowed = "120%, 50% or a bare number such as 1.2, above zero"
    return _positive(_parse(text, "share", _SHARE, allowed), text, "share", allowed)


def parse_place_mm(text: str) -> tuple[float, float]:
    """Place (x, y) in mm of "X,Y", each a length: "12.5,30" or "0.5in, 2cm"."""
    allowed = "two lengths with a comma between, such as 12.5,30 (mm) or 0.5in,2cm"
    parts = text.split(",")
    if len(parts) != 2:
        raise ValueError(_refusal(text, "place", allowed))
    try:
        return parse_length_mm(parts[0]), parse_length_mm(parts[1])
    except ValueError:
        raise ValueError(_refusal(text, "place", allowed)) from None


def format_length_mm(length_mm: float) -> str:
    """Length with four significant figures: um below 0.1 mm, m from ten metres, mm in between."""
    if 0 < abs(length_mm) < 0.1:
        return f"{_figures(length_mm * 1e3)} um"
    if abs(length_mm) >= 1e4:
        return f"{_figures(length_mm / 1e3)} m"
    return f"{_figures(length_mm)} mm"


def drawn_length_mm(length_mm: float) -> str:
    """The same for a picture, whose letters have a µ: not every terminal's have."""
    return format_length_mm(length_mm).replace(" um", " µm")


def format_speed_mm_s(speed_mm_s: float) -> str:
    """Speed in mm/s with four significant figures."""
    return f"{_figures(speed_mm_s)} mm/s"


def format_feed_mm_s(feed_mm_s: float) -> str:
    """Feed of a program in mm/min, as its F says it, with four significant figures."""
    return f"{_figures(60 * feed_mm_s)} mm/min"


def format_frequency_hz(frequency_hz: float) -> str:
    """Frequency with six significant figures: kHz from 1000 Hz, Hz below."""
    if abs(frequency_hz) >= 1000:
        return f"{_figures(frequency_hz / 1000, 6)} kHz"
    return f"{_figures(frequency_hz, 6)} Hz"


def format_time_s(time_s: float) -> str:
    """Time with four significant figures: ms below a second, minutes and seconds from 100 s."""
    if 0 < abs(time_s) < 1:
        return f"{_figures(time_s * 1e3)} ms"
    if abs(time_s) >= 100:
        minutes, seconds = divmod(round(abs(time_s)), 60)
        return f"{'-' if time_s < 0 else ''}{minutes} min {seconds:02d} s"
    return f"{_figures(time_s)} s"


def format_place_mm(x_mm: float, y_mm: float) -> str:
    """Place as "X, Y mm" to a hundredth of a mm."""
    return f"{_zeroed(x_mm, 2):.2f}, {_zeroed(y_mm, 2):.2f} mm"


def _parse(text: str, kind: str, units: dict[str, float], allowed: str) -> float:
    """Number times unit; raises ValueError that says what was got and what is allowed."""
    # micro sign, Greek mu
    plain = text.strip().lower().replace("\u00b5", "u").replace("\u03bc", "u")
    found = _NUMBER_AND_UNIT.fullmatch(plain)
    scale = {"": 1.0, **units}.get(found[2]) if found else None
    value = float(found[1]) * scale if found and scale is not None else math.nan
    if not math.isfinite(value):
        raise ValueError(_refusal(text, kind, allowed))
    return value


def _positive(value: float, text: str, kind: str, allowed: str) -> float:
    """The value itself if above zero; else ValueError."""
    if value <= 0:
        raise ValueError(_refusal(text, kind, allowed))
    return value


def _refusal(text: str, kind: str, allowed: str) -> str:
    """The message of a refused text, cut short so that it stays one line."""
    return f"{text.strip()[:40]!r} is no {kind}; give {allowed}"


def _figures(value: float, figures: int = 4) -> str:
    """Plain decimal notation with so many significant figures, and no minus before a zero."""
    if value == 0 or not math.isfinite(value):
        return f"{abs(value):g}"
    decimals = max(0, figures - 1 - math.floor(math.log10(abs(value))))
    plain = f"{_zeroed(value, decimals):.{decimals}f}"
    return plain.rstrip("0").rstrip(".") if "." in plain else plain


def _zeroed(value: float, decimals: int) -> float:
    """The value rounded; what rounds to zero is +0.0."""
    return round(value, decimals) + 0.0
