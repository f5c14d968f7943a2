"""A file of settings: read as it was written, and each mistake pointed at."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.faults import CardFault, FileFault
from morfax.tracer.head.settings import BOUNDS, HEADS, choose
from morfax.tracer.operator.settings_file import as_toml, read_changes


def changes_in(text: str) -> dict[str, float]:
    """What a file with a text changes."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "head.toml"
        file.write_text(text)
        return read_changes(file)


@pytest.mark.parametrize("head", list(HEADS))
def test_what_is_written_is_read_as_the_same_head(head: str) -> None:
    assert choose(head, changes_in(as_toml(HEADS[head]))) == HEADS[head]


@given(
    st.fixed_dictionaries(
        {}, optional={n: st.floats(b.least, b.most) for n, b in BOUNDS.items()}
    )
)
def test_any_settings_go_round_to_the_last_digit(changes: dict[str, float]) -> None:
    settings = choose(changes=changes)
    assert choose(changes=changes_in(as_toml(settings))) == settings


def test_every_setting_is_written_with_what_it_may_hold() -> None:
    lines = as_toml(HEADS["precise"]).splitlines()
    assert len(lines) == len(BOUNDS)
    assert lines[4].startswith("sweep_hz = 250.0 ") and lines[4].endswith("; 1 to 750")
    assert lines[5].startswith("# aperture_mm = ") and "follows from the line" in lines[5]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            '\nsweep_hz = "fast"',
            'head.toml, line 2: sweep_hz holds "fast"; it may hold a number from 1 to 750, in',
        ),
        (
            "lead_mm = -1",
            "head.toml, line 1: lead_mm holds -1; it may hold a number from 0.01 to 20",
        ),
        (
            "gap_mm = true",
            "head.toml, line 1: gap_mm holds true; it may hold a number from 0 to 20",
        ),
        ("gap_mm = nan", "head.toml, line 1: gap_mm holds NaN; it may hold"),
        (
            "colour = 1",
            "head.toml, line 1: colour holds 1; there is no such field;"
            " the file of settings may hold speed_mm_s, slow",
        ),
        ("lead_mm 1", "head.toml, line 1: the file of settings holds"),
    ],
)
def test_a_mistake_is_refused_with_its_line(text: str, said: str) -> None:
    with pytest.raises(CardFault) as caught:
        changes_in(text)
    assert str(caught.value).startswith(said)


def test_a_file_that_is_not_there_says_so(tmp_path: Path) -> None:
    with pytest.raises(
        FileFault, match=r"cannot read the file of settings .*give another one with --settings"
    ):
        read_changes(tmp_path / "head.toml")
