"""The tape format: what a player must know of a tape, carried in the file's text chunk as one line of JSON.

    {"version": 1, "sample_rate_hz": 48000, "reference_hz": 6000.0, "cycles_per_mm": 20.0, "axes": ["x", "y",
    "z"],
     "start_mm": [40.1, 12.0, 2.0], "end_mm": [40.1, 12.0, 2.0], "dwell_s": 1.0, "level": 0.5,
     "samples_per_motion": 8}

A tape whose pick-ups are not resolvers has one more entry, `"pickup": "photocell"`, and is of version 2. A
tape on which X or Y stands throughout, or two axes run alike, says so with `"still": ["y"]` and `"alike":
["x", "z"]`, and is of version 3: nothing else tells such a track from a copy of another.

Signals: track 1 is the reference, then one per axis; phase of a track - phase of the reference = displacement
from `start_mm` times `cycles_per_mm`, in cycles. An axis may use a third of the reference as deviation, which
leaves room to tell the tracks from hum below and from the reference's own harmonics above.

Source: patent ES 361967 (the reference and the tracks of the axes side by side on one tape). Questions: the
patent gives no figures; the start position was set by hand on the machine, here the tape says it.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any, TypeGuard

from morfax.motion.faults import TapeFault
from morfax.motion.usual import REFERENCE_HZ, SAMPLE_RATE_HZ, SAMPLES_PER_MOTION
from morfax.recorder.tape.carrier import PickUp
from morfax.recorder.tape.check_frame import MOST_TRACKS
from morfax.recorder.tape.pickups import DEFAULT_PICK_UP, PICK_UPS, SCREW, Sensor
from morfax.recorder.tape.told_figures import StatedFigures
from morfax.recorder.textfile import demand

VERSION = 3  # the latest
_NEW_ENTRIES = {"pickup": 2, "still": 3, "alike": 3}  # the first version that has it
LARGEST_TEXT_BYTES = 2000  # libsndfile 1.2 reads no text chunk of a WAV from 2048 bytes on
LARGEST_DEVIATION = 1.0 / 3.0  # of the reference
# a phase that is off by less is miscounted by no cycle: half of the way to the next
SURE_CYCLES = 0.25
LEAST_CHECKED_HZ = 5000.0  # of the reference: a frame of the check signal is then 0.58 s
CHECK_SHARE = 0.2  # of the carrier: the amplitude of the check signal, 14 dB down
_MOST_AXES = MOST_TRACKS - 1  # beside the reference

_AGAIN = "record the tape again"


@dataclass(frozen=True, slots=True)
class TapeFormat:
    """Format of a tape; raises ValueError if it cannot be. `level`: amplitude of a carrier, full scale 1.

    `still`: axes that are meant to stand from start to end; `alike`: axes that are meant to run alike;
    `checked`: whether a check signal is recorded.

    Without `start_mm` the start is zero on all axes; `end_mm` is None where it is not known. The version is
    the lowest that can say it.
    """

    version: int = 1
    sample_rate_hz: int = SAMPLE_RATE_HZ
    reference_hz: float = REFERENCE_HZ
    cycles_per_mm: float = SCREW.cycles_per_mm
    axes: tuple[str, ...] = ("x", "y", "z")
    start_mm: tuple[float, ...] = ()
    end_mm: tuple[float, ...] | None = None
    dwell_s: float = 1.0
    level: float = 0.5
    samples_per_motion: int = SAMPLES_PER_MOTION
    pickup: str = DEFAULT_PICK_UP
    still: tuple[str, ...] = ()
    alike: tuple[str, ...] = ()
    # the check signal is recorded; the text does not say so, the tracks do
    checked: bool = field(default=False, compare=False)
    # what the text that it was read from states, whatever is given by hand
    stated: StatedFigures | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        _check_numbers(self)
        _check_axes(self)
        demand(self.pickup in PICK_UPS, "pickup", self.pickup, f"one of {', '.join(PICK_UPS)}")
        most = 1 / (self.sensor.largest + CHECK_SHARE * self.checked)
        demand(
            self.level <= most,
            "level",
            self.level,
            f"at most {most:.3g}, where a {self.pickup} reaches full scale",
        )
        demand(
            self.can_be_checked or not self.checked,
            "reference_hz",
            self.reference_hz,
            f"at least {LEAST_CHECKED_HZ:g} Hz for a check signal; record a lower one bare (--plain)",
        )
        for name in ("still", "alike"):
            _check_some_axes(self, name)
        lowest = 1 if self.pickup == DEFAULT_PICK_UP else 2
        object.__setattr__(self, "version", 3 if self.still or self.alike else lowest)
        object.__setattr__(self, "start_mm", self.start_mm or (0.0,) * len(self.axes))
        for name in ("start_mm", "end_mm"):
            _check_place(self, name)
        highest_hz = self.reference_hz + self.largest_deviation_hz
        demand(
            highest_hz < self.sample_rate_hz / 2,
            "reference_hz",
            self.reference_hz,
            f"so low that a third more is below half the sample rate of {self.sample_rate_hz} Hz",
        )

    @property
    def can_be_checked(self) -> bool:
        """Whether the reference leaves room for the check signal."""
        return self.reference_hz >= LEAST_CHECKED_HZ

    @property
    def tracks(self) -> int:
        """Tracks on the tape: the reference and one per axis."""
        return 1 + len(self.axes)

    @property
    def motion_rate_hz(self) -> float:
        """Rate of the motion that the tape carries, Hz."""
        return self.sample_rate_hz / self.samples_per_motion

    @property
    def mm_per_cycle(self) -> float:
        """Travel in one cycle of phase, q."""
        return 1.0 / self.cycles_per_mm

    @property
    def largest_deviation_hz(self) -> float:
        """How far a track may leave the reference, Hz."""
        return LARGEST_DEVIATION * self.reference_hz

    @property
    def largest_speed_mm_s(self) -> float:
        """The speed of an axis at that deviation, mm/s."""
        return self.largest_deviation_hz / self.cycles_per_mm

    @property
    def sensor(self) -> Sensor:
        """The kind of pick-up that made the tracks of the axes."""
        return PICK_UPS[self.pickup]

    @property
    def carrier(self) -> PickUp:
        """The figures that the carrier needs."""
        hz, rate = self.reference_hz, self.sample_rate_hz
        return PickUp(
            hz, self.cycles_per_mm, rate, self.samples_per_motion, self.level, self.sensor
        )

    def to_json(self) -> str:
        """The format as one line of JSON."""
        entries = _entries(self.version)
        return json.dumps(
            {name: value for name, value in asdict(self).items() if name in entries},
            allow_nan=False,
        )

    @classmethod
    def from_json(cls, text: str) -> TapeFormat:
        """Read a format; raises TapeFault for a text that is no format, or one of a later version."""
        values = _object(text)
        version = values.get("version")
        if _is_number(version) and version > VERSION:
            raise TapeFault(
                f"the tape's format is version {version:g}; this program reads {VERSION}: use a later one"
            )
        _check_entries(values)
        as_tuples: dict[str, Any] = {
            name: tuple(v) if isinstance(v, list) else v for name, v in values.items()
        }
        try:
            fmt = cls(**as_tuples)
            return replace(fmt, stated=StatedFigures(fmt.cycles_per_mm, fmt.axes, fmt.start_mm))
        except (TypeError, ValueError) as error:
            raise TapeFault(f"the tape's text chunk is wrong: {error}; {_AGAIN}") from None


def columns_of(order: Sequence[int] | None, tracks: int) -> list[int] | None:
    """Columns of a file whose tracks have this order (None: as they are); raises TapeFault for no order."""
    if order is None:
        return None
    if sorted(order) != list(range(1, tracks + 1)):
        raise TapeFault(
            f"tracks {','.join(map(str, order))} are no order; name each of the tracks 1 to {tracks} once"
        )
    return [track - 1 for track in order]


def is_format_text(text: str) -> bool:
    """Whether a text chunk is meant as a tape format, and is not somebody's remark."""
    return text.lstrip().startswith("{")


def _object(text: str) -> dict[str, Any]:
    """The JSON object in a text; raises TapeFault."""
    if len(text) > LARGEST_TEXT_BYTES:
        raise TapeFault(
            f"the tape's text chunk has {len(text)} characters; at most {LARGEST_TEXT_BYTES} are allowed"
        )
    try:
        values = json.loads(text)
    except (ValueError, RecursionError):
        values = None
    if not isinstance(values, dict):
        raise TapeFault(f"the tape's text chunk {text[:40]!r} is no JSON object; {_AGAIN}")
    return values


def _check_entries(values: dict[str, Any]) -> None:
    """Raise TapeFault unless exactly the entries of this version are there."""
    known = _entries(values.get("version"))
    missing = sorted(known - values.keys())
    unknown = sorted(values.keys() - known)
    if missing:
        raise TapeFault(f"the tape's text chunk lacks {missing[0]}; {_AGAIN}")
    if unknown:
        raise TapeFault(
            f"the tape's text chunk has an unknown entry {unknown[0][:30]!r}; {_AGAIN}"
        )


def _entries(version: object) -> set[str]:
    """The entries that a text of a version has."""
    number = version if _is_number(version) else 1
    return {
        field.name for field in fields(TapeFormat) if _NEW_ENTRIES.get(field.name, 1) <= number
    } - {"checked", "stated"}


def _check_numbers(fmt: TapeFormat) -> None:
    """Raise ValueError for the first number that cannot be."""
    known = _is_number(fmt.version) and fmt.version in range(1, VERSION + 1)
    demand(known, "version", fmt.version, f"1 to {VERSION}")
    for name, most in (("sample_rate_hz", 2**31), ("samples_per_motion", 10_000)):
        value = getattr(fmt, name)
        demand(
            isinstance(value, int) and 2 <= value <= most,
            name,
            value,
            f"a whole number from 2 to {most}",
        )
    for name in ("reference_hz", "cycles_per_mm", "level"):
        value = getattr(fmt, name)
        demand(_is_number(value) and value > 0, name, value, "a number above zero")
    demand(
        _is_number(fmt.dwell_s) and 0 <= fmt.dwell_s <= 3600,
        "dwell_s",
        fmt.dwell_s,
        "a number of s from 0 to 3600",
    )


def _check_axes(fmt: TapeFormat) -> None:
    """Raise ValueError unless the axes are a few different short names."""
    axes = fmt.axes
    good = isinstance(axes, tuple) and 1 <= len(axes) <= _MOST_AXES
    good = good and all(isinstance(a, str) and a.isascii() and a.isidentifier() for a in axes)
    good = good and len(set(axes)) == len(axes) and max(map(len, axes)) <= 10
    demand(good, "axes", axes, f"1 to {_MOST_AXES} different names such as x, y, z")


def _check_some_axes(fmt: TapeFormat, name: str) -> None:
    """Raise ValueError unless an entry names axes of the tape."""
    axes = getattr(fmt, name)
    good = isinstance(axes, tuple) and all(axis in fmt.axes for axis in axes)
    demand(good, name, axes, f"axes of the tape: {', '.join(fmt.axes)}")


def _check_place(fmt: TapeFormat, name: str) -> None:
    """Raise ValueError unless a place has a finite number of mm for each axis."""
    place = getattr(fmt, name)
    good = (
        isinstance(place, tuple)
        and len(place) == len(fmt.axes)
        and all(_is_number(mm) for mm in place)
    )
    demand(
        good or (place is None and name == "end_mm"),
        name,
        place,
        f"{len(fmt.axes)} numbers of mm",
    )


def _is_number(value: object) -> TypeGuard[float]:
    """Whether a value is a finite number; True and False are not."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e12
