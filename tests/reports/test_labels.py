"""Labels: names beside places hide neither each other nor the path, and the legend hides nothing."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from morfax.motion.motion import Path
from morfax.reports import labels, overlay
from morfax.reports.overlay import Picture
from morfax.reports.plate import Caption, Plate, Polyline, Spot, free_corner

WIDE_PT = HIGH_PT = 400.0
SIZE_PT = 8.0
VIEW = (0.0, 100.0, 0.0, 100.0)


def boxes_pt(plate: Plate) -> np.ndarray:
    """Left, low, right and high of all words on square axes, points."""
    found = []
    for words in plate.words:
        x, y = 4.0 * np.array(words.place_mm) + words.offset_pt
        found.append((x, y, x + labels.LETTER * SIZE_PT * len(words.text), y + SIZE_PT))
    return np.array(found)


def crowd(count: int, *lines: np.ndarray) -> Plate:
    """A plate with as many named places within 20 mm of each other, and lines."""
    plate = Plate(VIEW)
    plate.add(*(Polyline(line, "#c1121f", 1.0) for line in lines))
    for k, (x, y) in enumerate(np.random.default_rng(4).uniform(40, 60, (count, 2)).tolist()):
        plate.add(Spot((x, y), "D", 6, "#1f5fbf"))
        plate.add(Caption((x, y), f"unexplained {k}", SIZE_PT, offset_pt=(7, 7)))
    labels.spread(plate, WIDE_PT, HIGH_PT)
    return plate


@pytest.mark.parametrize("count", [2, 8, labels.FEW_NAMES])
def test_names_of_places_near_to_each_other_do_not_lie_over_one_another(count: int) -> None:
    boxes = boxes_pt(crowd(count))
    for k, (left, low, right, high) in enumerate(boxes):
        others = np.delete(boxes, k, axis=0)
        beside = (others[:, 0] >= right) | (others[:, 2] <= left)
        assert np.all(beside | (others[:, 1] >= high) | (others[:, 3] <= low))


def test_a_line_leads_to_every_name_that_does_not_stand_beside_its_place() -> None:
    """(Fails without `leaders`, and with a leader that ends elsewhere than at the name.)"""
    plate = crowd(labels.FEW_NAMES)
    boxes, leaders = boxes_pt(plate), [m for m in plate.marks if isinstance(m, Polyline)]
    led = 0
    for words, (left, low, right, high) in zip(plate.words, boxes, strict=True):
        place_pt = 4.0 * np.array(words.place_mm)
        nearest_pt = np.clip(place_pt, (left, low), (right, high))
        own = [m for m in leaders if np.allclose(m.places_mm[0], words.place_mm)]
        assert len(own) == (np.hypot(*(nearest_pt - place_pt)) >= labels.TITLE_PT)
        if own:
            assert 4.0 * own[0].places_mm[1] == pytest.approx(nearest_pt)
        led += len(own)
    assert 0 < led < len(plate.words)


def test_a_name_leaves_the_path_free_and_stays_on_the_axes() -> None:
    """One upright line through the place where the name would stand, and a place at the right border."""
    plate = Plate(VIEW)
    plate.add(Polyline(np.array([[53.0, 0], [53.0, 100]]), "#c1121f", 1.0))
    plate.add(Caption((50.0, 50.0), "stop 1", SIZE_PT, offset_pt=(7, 7)))
    plate.add(Caption((98.0, 20.0), "stop 2", SIZE_PT, offset_pt=(7, 7)))
    labels.spread(plate, WIDE_PT, HIGH_PT)
    (left, _, right, _), (_, _, outermost, _) = boxes_pt(plate)
    assert right < 4 * 53.0 or left > 4 * 53.0
    assert outermost <= WIDE_PT


def test_many_names_are_letters_and_numbers_which_the_legend_explains() -> None:
    few = {f"stop {k}": (0.0, 0.0) for k in range(1, 4)}
    assert labels.shortened(few)["stop 3"] == ("stop 3", "")
    many = {f"unexplained {k}": (0.0, 0.0) for k in range(1, 20)} | few | {"stub 1": (0.0, 0.0)}
    written = labels.shortened(many)
    assert written["unexplained 12"] == ("u12", "u  unexplained")
    assert written["stop 2"] == ("sto2", "sto  stop") and written["stub 1"] == (
        "stu1",
        "stu  stub",
    )


def test_a_legend_stands_beside_the_sheet_where_lines_are_in_all_corners() -> None:
    """A frame up to the borders: nothing of it lies in the corner that the legend takes."""
    corners = np.array([[1.0, 1], [99, 1], [99, 99], [1, 99], [1, 1]])
    places = np.vstack([np.linspace(a, b, 50) for a, b in pairwise(corners)])
    path = Path(
        t_s=np.arange(len(places), dtype=float),
        positions_mm=np.column_stack([places, np.full(len(places), -1.0)]),
    )
    picture = Picture("frame", path)
    view = overlay.view_of(picture)
    shown = overlay._with_margin(view)
    for seen, is_free in ((view, False), (shown, True)):
        page, plate, _ = overlay._laid_out(picture, seen, 0)
        share = overlay._legend_share(plate, page)
        left, right, low, high = plate.view
        is_upper, is_right = free_corner(plate, share)
        x = (places[:, 0] - left) / (right - left)
        y = (places[:, 1] - low) / (high - low)
        aside = x > 1 - share[0] if is_right else x < share[0]
        level = y > 1 - share[1] if is_upper else y < share[1]
        within = aside & level
        assert bool(within.any()) != is_free


def test_of_very_many_lines_only_the_longest_have_numbers() -> None:
    """A page of lettering has hundreds, whose rings hid the path. The lowest numbers are the longest."""
    t_s = np.arange(5.0)
    path = Path(t_s=t_s, positions_mm=np.column_stack([20 * t_s, 20 * t_s, -1 - 0 * t_s]))
    numbers = [(str(n), (float(n % 97), float(n % 89))) for n in range(300, 0, -1)]
    picture = Picture("page", path, numbers_mm=numbers)
    _, plate, _ = overlay._laid_out(picture, overlay.view_of(picture), 0)
    written = {int(words.text) for words in plate.words if words.ring}
    assert written == set(range(1, overlay.MOST_NUMBERED + 1))
    assert plate.title == "page; the 60 longest of 300 lines have numbers"
