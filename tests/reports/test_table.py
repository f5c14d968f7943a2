"""Figures as text and as JSON."""

from __future__ import annotations

import json

import numpy as np

from morfax.jobs.figures import MOST_PLACES
from morfax.reports.table import as_json, as_text

FIGURES = {
    "tape": "cam.wav",
    "paths": ["cam.csv", "cam.svg"],
    "incomplete": None,
    "within_tolerance": True,
    "duration_s": 26.412,
    "start_place_mm": np.array([40.1234567, 12.0, 2.0]),
    "reference_hz": 6000.0,
    "cycles_per_mm": 20.0,
    "missed_ink_share": 0.0123,
    "solid_mm2": 12.3456,
    "played_to_traced": {"rms_mm": 0.00012, "max_mm": np.float64(0.5)},
    "played_to_ink": {"rms_mm": 3.0},
}


def test_json_keeps_the_keys_with_their_units_and_leaves_out_what_is_not_there() -> None:
    read = json.loads(as_json(FIGURES))
    assert read["duration_s"] == 26.412
    assert read["start_place_mm"] == [40.12346, 12.0, 2.0]
    assert read["within_tolerance"] is True
    assert read["played_to_traced"] == {"rms_mm": 0.00012, "max_mm": 0.5}
    assert "incomplete" not in read


def test_text_tells_each_figure_in_the_unit_that_reads_best() -> None:
    lines = {line.split("  ")[0]: line for line in as_text(FIGURES).splitlines()}
    assert lines["duration"].endswith("26.41 s")
    assert lines["start"].endswith("40.12, 12.00 mm")
    assert lines["reference"].endswith("6 kHz")
    assert lines["cycles"].endswith("20 per mm")
    assert lines["missed ink share"].endswith("1.23 %")
    assert lines["solid"].endswith("12.3 mm2")
    assert lines["paths"].endswith("cam.csv, cam.svg")
    assert lines["within tolerance"].endswith("yes")


def test_a_feed_is_told_as_the_program_says_it() -> None:
    assert as_text({"fastest_feed_mm_s": 10.0}).split("  ") == ["fastest feed", "600 mm/min"]
    assert as_text({"largest_speed_mm_s": 10.0}).split("  ") == ["largest speed", "10 mm/s"]


def test_dictionaries_inside_become_one_table() -> None:
    *_, head, played, ink = as_text(FIGURES).splitlines()
    assert head.split() == ["RMS", "largest"]
    assert played.split() == ["played", "to", "traced", "0.12", "um", "0.5", "mm"]
    assert ink.split() == ["played", "to", "ink", "3", "mm", "–"]


def test_rows_of_a_list_are_named_by_their_place_in_its_unit_and_by_files_as_they_are_called() -> (
    None
):
    text = as_text(
        {
            "places": [{"unexplained_place_mm": (33.0411666667, 36.5548333333), "what": "ink"}],
            "drawings": [{"drawing": "my_part.png", "ending": "closed"}],
        }
    )
    rows = [line.split("  ")[0] for line in text.splitlines()]
    assert rows[1] == "unexplained 33.04, 36.55 mm"
    assert rows[3] == "drawing my_part.png"


def test_columns_stand_below_each_other_whatever_letters_are_in_them() -> None:
    text = as_text(
        {
            "drawing": "日本.png",
            "lines": [{"line": 1, "of": "日本"}, {"line": 20, "of": "abcdef"}],
        }
    )
    first, _, one, twenty = text.splitlines()
    assert first == "drawing  日本.png"
    assert (one, twenty) == (
        "line 1     日本",
        "line 20  abcdef",
    )  # a wide letter takes two columns


def test_a_place_and_a_list_of_lengths_in_a_table_read_as_such() -> None:
    """What a cutter cannot reach has a place, and a stop a list of positions of Z."""
    text = as_text(
        {
            "unreached": [
                {"unreached": 1, "place_mm": (30.0, 12.5), "left_mm": 1.5, "z_mm": [-5.0, 2.0]}
            ]
        }
    )
    head, row = (line.split("  ") for line in text.splitlines())
    assert [word.strip() for word in head if word] == ["place", "left", "z"]
    assert [word.strip() for word in row if word] == [
        "unreached 1",
        "30.00, 12.50 mm",
        "1.5 mm",
        "-5 mm, 2 mm",
    ]


def test_a_line_that_is_cut_in_two_pieces_has_two_rows() -> None:
    _, *rows = as_text(
        {"lines": [{"line": 1, "length_mm": 40.0}, {"line": 1, "length_mm": 30.0}]}
    ).splitlines()
    assert [row.split() for row in rows] == [
        ["line", "1", "40", "mm"],
        ["line", "1", "30", "mm"],
    ]


def test_of_very_many_places_the_worst_are_listed_and_of_lines_all() -> None:
    """A page of small lettering filled the terminal with 325 rows; the figures have all of them."""
    many = [
        {"unexplained_place_mm": (k, 0.0), "unexplained_mm": 99.0 - k, "what": "off"}
        for k in range(MOST_PLACES + 5)
    ]
    rows = [{"line": k, "length_mm": 1.0} for k in range(MOST_PLACES + 5)]
    told = as_text({"unexplained": many, "lines": rows}).splitlines()
    assert sum(row.startswith("unexplained ") for row in told) == MOST_PLACES
    assert "and 5 more, which --json lists" in told
    assert sum(row.startswith("line ") for row in told) == MOST_PLACES + 5
    assert len(json.loads(as_json({"unexplained": many}))["unexplained"]) == len(many)
