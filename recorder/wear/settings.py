"""The wear of a tape as settings: every part by itself, and named sets as makers state them.

Shares are of the speed, dB of the carrier's peak unless stated otherwise. Every part does nothing at its
default.

Source: figures of the sets and their sources: docs/background/transport.md.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from morfax.recorder.wear.codec import CODECS

# of wow, flutter and scrape together: the transport reads ahead for no more
MOST_FLUTTER = 0.05
LONGEST_TURN_S = 10.0  # of the reel; print-through holds one turn in memory
LARGEST_RATE_HZ = np.iinfo(np.int32).max  # of a header
# error of the speed: a tape at a tenth, or at ten times its speed
LEAST_SPEED, LARGEST_SPEED = -0.9, 9.0


@dataclass(frozen=True, slots=True)
class Wear:
    """The wear of a tape; shares are of the speed, dB of the carrier's peak unless stated otherwise."""

    speed: float = 0.0
    wow: float = 0.0
    flutter: float = 0.0
    scrape: float = 0.0
    skew_s: float = 0.0
    weave_s: float = 0.0
    noise_db: float | None = None
    level_db: float = 0.0
    uneven_db: float = 0.0
    crosstalk_db: float | None = None
    print_db: float | None = None
    print_s: float = 1.5
    dropouts_per_min: float = 0.0
    dropout_s: float = 0.003
    dropout_db: float = 30.0
    dropout_all: bool = False
    hum_db: float | None = None
    hum_hz: float = 50.0
    dc: float = 0.0
    third: float = 0.0
    bandwidth_hz: float | None = None
    band_hz: tuple[float, float] | None = None  # steep, as of a telephone
    codec: str | None = None  # one of codec.CODECS
    clip: float | None = None
    stamped_hz: int | None = None
    order: tuple[int, ...] = ()
    inverted: tuple[int, ...] = ()
    cut_start_s: float = 0.0
    cut_end_s: float = 0.0


SETS = {
    "studio-15ips": Wear(
        speed=0.002, wow=3e-4, flutter=4e-4, scrape=3e-4, skew_s=1.5e-6, weave_s=2e-7,
        noise_db=60, crosstalk_db=50, print_db=56, print_s=0.8, third=0.01, uneven_db=0.2,
        bandwidth_hz=20_000, dropouts_per_min=0.2, dropout_s=0.0005, dropout_db=6,
    ),
    "instrumentation": Wear(
        speed=0.001, wow=5e-4, flutter=1e-3, scrape=1e-3, skew_s=5e-7, weave_s=2e-7,
        noise_db=46, crosstalk_db=40, print_db=60, print_s=0.5, third=0.01, uneven_db=0.3,
        dropouts_per_min=1, dropout_s=0.0003, dropout_db=12,
    ),
    "cassette": Wear(
        speed=0.015, wow=1.2e-3, flutter=1.2e-3, scrape=6e-4, skew_s=1.2e-5, weave_s=1e-6,
        noise_db=46, crosstalk_db=40, print_db=50, print_s=1.2, third=0.03, uneven_db=0.7,
        bandwidth_hz=12_500, dropouts_per_min=4, dropout_s=0.001, dropout_db=20, hum_db=55,
    ),
    "reel": Wear(
        speed=0.002, wow=5e-4, flutter=6e-4, scrape=5e-4, skew_s=5.4e-6, weave_s=5e-7,
        noise_db=52, crosstalk_db=45, print_db=54, print_s=1.0, third=0.02, uneven_db=0.3,
        bandwidth_hz=20_000, dropouts_per_min=1, dropout_s=0.0005, dropout_db=10,
    ),
    "answering-machine": Wear(
        speed=0.03, wow=2e-3, flutter=2e-3, scrape=1e-3, skew_s=2.4e-5, weave_s=2e-6,
        noise_db=35, third=0.05, uneven_db=1.5, band_hz=(300, 3_400),
        dropouts_per_min=4, dropout_s=0.001, dropout_db=20,
    ),
    "mp3": Wear(codec="mp3-64"),
}  # fmt: skip

_NEVER_NEGATIVE = (
    "wow",
    "flutter",
    "scrape",
    "weave_s",
    "uneven_db",
    "dropouts_per_min",
    "cut_start_s",
    "cut_end_s",
)


def check(wear: Wear, tracks: int) -> None:
    """Raise ValueError for wear that no transport makes of a tape with this many tracks."""
    numbers = (getattr(wear, field.name) for field in fields(wear))
    if not all(np.isfinite(n) for n in numbers if isinstance(n, int | float)):
        raise ValueError("a part of the wear is no finite number; give finite numbers")
    _check_ranges(wear)
    if wear.codec is not None and wear.codec not in CODECS:
        raise ValueError(f"codec is {wear.codec!r}; it must be one of {', '.join(CODECS)}")
    if wear.order and sorted(wear.order) != list(range(1, tracks + 1)):
        raise ValueError(
            f"order is {wear.order}; it must name each of the tracks 1 to {tracks} once"
        )
    if any(not 1 <= track <= tracks for track in wear.inverted):
        raise ValueError(f"inverted is {wear.inverted}; the tracks are 1 to {tracks}")


def _check_ranges(wear: Wear) -> None:
    """Raise ValueError for a part out of its range."""
    if not LEAST_SPEED < wear.speed < LARGEST_SPEED:
        raise ValueError(
            f"speed error is {wear.speed:g}; it must lie between {LEAST_SPEED:g} and {LARGEST_SPEED:g}"
        )
    if wear.stamped_hz is not None and not 0 < wear.stamped_hz <= LARGEST_RATE_HZ:
        raise ValueError(
            f"stamped_hz is {wear.stamped_hz}; a header holds 1 to {LARGEST_RATE_HZ} Hz"
        )
    for name in _NEVER_NEGATIVE:
        if getattr(wear, name) < 0:
            raise ValueError(f"{name} is {getattr(wear, name):g}; it must be zero or more")
    if wear.wow + wear.flutter + wear.scrape > MOST_FLUTTER:
        raise ValueError(
            f"wow, flutter and scrape are more than {MOST_FLUTTER:g} together; give less"
        )
    if not 0 < wear.print_s <= LONGEST_TURN_S or not wear.dropout_s > 0:
        raise ValueError(
            f"print_s must lie between 0 and {LONGEST_TURN_S:g} s, and dropout_s above zero"
        )
