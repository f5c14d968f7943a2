"""A file of settings of the head (TOML): read with each mistake pointed at, and written as it is read.

Signals in: a text with a line for each setting that is to differ from the head's own, by the names that
`--set` takes. Signals out: numbers by name, or a CardFault:

    head.toml, line 3: sweep_hz holds "fast"; it may hold a number from 1 to 750, in the unit that its name
    ends with

All settings are written. A setting that follows from the line is written as a comment, so that the file can
be read again and means the same.

Source: our own; the patent's follower has a knob for its speed (WC), and screws for all other settings.
"""

from __future__ import annotations

from pathlib import Path as FilePath

from morfax.motion.toml_fields import Field, opened
from morfax.tracer.head.settings import BOUNDS, Settings, allowed, value_of

CALLED = "the file of settings"


def read_changes(file: FilePath) -> dict[str, float]:
    """Settings in a file, by name; raises CardFault for a mistake, FileFault if the file cannot be read."""
    whole = opened(file, CALLED, "--settings")
    return {name: _number(name, held) for name, held in whole.table(*BOUNDS).items()}


def as_toml(settings: Settings) -> str:
    """All settings as a file that can be read again, each with its meaning and bounds."""
    return "".join(_line(name, value_of(settings, name)) for name in BOUNDS)


def _number(name: str, held: Field) -> float:
    """The value of a setting; refused if it is no number within its bounds."""
    value = held.value
    if isinstance(value, bool) or not isinstance(value, int | float):
        held.refuse(f"it may hold {allowed(name)}")
    if not BOUNDS[name].least <= value <= BOUNDS[name].most:
        held.refuse(f"it may hold {allowed(name)}")
    return float(value)


def _line(name: str, value: float | None) -> str:
    """One setting; as a comment if it follows from the line."""
    bounds = BOUNDS[name]
    says = f"# {name} =" if value is None else f"{name} = {value!r}"
    follows = "follows from the line; " if value is None else ""
    return f"{says:34s}  # {follows}{bounds.what}; {bounds.least:g} to {bounds.most:g}\n"
