"""Settings of the head: named sets, changes by name, and mistakes said in one line."""

from __future__ import annotations

from dataclasses import fields

import pytest

from tracer.settings import HEADS, Settings, choose


def test_the_precise_set_is_the_default() -> None:
    assert choose() == Settings() == HEADS["precise"]


def test_every_setting_can_be_changed_by_name() -> None:
    for field in fields(Settings):
        if field.name != "drive":
            assert getattr(choose("historic", {field.name: "1.5"}), field.name) == 1.5
    assert choose(changes={"drive_lag_s": 0.004}).drive.lag_s == 0.004


@pytest.mark.parametrize(
    ("head", "changes", "said"),
    [
        ("modern", {}, "there is no head 'modern'; give one of precise, historic"),
        ("precise", {"colour": 1}, "the head has no setting 'colour'; it has speed_mm_s"),
        ("precise", {"lead_mm": "two"}, "lead_mm is 'two'; it must be a number"),
        ("precise", {"lead_mm": -1}, "lead_mm is -1; it must be a number of at least 0"),
        ("precise", {"lead_mm": "nan"}, "lead_mm is 'nan'"),
    ],
)
def test_a_mistake_is_said_in_one_line(head: str, changes: dict[str, object], said: str) -> None:
    with pytest.raises(ValueError, match=said) as caught:
        choose(head, changes)
    assert "\n" not in str(caught.value)
