"""Settings of the head: named sets, changes by name, and mistakes said in one line."""

from __future__ import annotations

from dataclasses import fields

import pytest

from morfax.motion.drive import Drive
from morfax.tracer.head.settings import BOUNDS, HEADS, Settings, choose, value_of

# what messages and the settings file promise, in the unit of the name
ALLOWED = {
    "speed_mm_s": (0.01, 1000),
    "slowed": (0.01, 1),
    "slow_s": (0, 10),
    "acceleration_mm_s2": (1, 100000),
    "sweep_hz": (1, 750),
    "aperture_mm": (0, 10),
    "steering_lag_s": (0, 1),
    "swivel_rad_s": (0.1, 1000),
    "gap_mm": (0, 20),
    "recatch_mm": (0, 50),
    "line_width_mm": (0.01, 20),
    "lead_mm": (0.01, 20),
    "amplitude_mm": (0.01, 20),
    "look_ahead_mm": (0.01, 100),
    "direct_rad_s_mm": (0, 10000),
    "cell_gain": (0, 10),
    "detector_gain": (-10, 10),
    "cell_noise": (0, 10),
    "drive_lag_s": (0, 1),
    "drive_acceleration_mm_s2": (1, 1000000),
}


def test_the_precise_set_is_the_default() -> None:
    assert choose() == Settings() == HEADS["precise"]


def test_every_setting_can_be_changed_by_name() -> None:
    for name, bounds in BOUNDS.items():
        assert value_of(choose("historic", {name: str(bounds.most)}), name) == bounds.most
    assert (
        len(BOUNDS) == len(fields(Settings)) - 1 + len(fields(Drive)) - 1
    )  # all but the machine's top speed
    assert choose(changes={"drive_lag_s": 0.004}).drive.lag_s == 0.004


@pytest.mark.parametrize(
    ("head", "changes", "said"),
    [
        ("modern", {}, "there is no head 'modern'; give one of precise, historic"),
        ("precise", {"colour": 1}, "the head has no setting 'colour'; it has speed_mm_s"),
        ("precise", {"lead_mm": "two"}, "lead_mm is 'two'; it must be a number"),
        ("precise", {"lead_mm": -1}, "lead_mm is -1; it must be a number from 0.01 to 20"),
        ("precise", {"lead_mm": "nan"}, "lead_mm is 'nan'"),
        (
            "precise",
            {"sweep_hz": 0},
            "sweep_hz is 0; it must be a number from 1 to 750, in the unit",
        ),
    ],
)
def test_a_mistake_is_said_in_one_line(
    head: str, changes: dict[str, object], said: str
) -> None:
    with pytest.raises(ValueError, match=said) as caught:
        choose(head, changes)
    assert "\n" not in str(caught.value)


def test_the_historic_head_swings_as_often_as_the_mains() -> None:
    """Motor 45 turns with the mains of 50 Hz; its servo and its cells are as slow as servos were."""
    historic = choose("historic")
    assert (historic.sweep_hz, historic.aperture_mm, historic.steering_lag_s) == (
        50.0,
        0.3,
        0.03,
    )
    # steered straight: damped to 0.71, 2 v / a² for a lead of 2 mm
    assert historic.lead_mm is not None
    assert historic.direct_rad_s_mm == 2 * historic.speed_mm_s / historic.lead_mm**2


def test_settings_are_allowed_what_is_promised() -> None:
    assert {name: (bounds.least, bounds.most) for name, bounds in BOUNDS.items()} == ALLOWED
