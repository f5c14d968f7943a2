"""Exchanges of partners: the ways to pair legs that are a step from one that is known."""

from __future__ import annotations

import numpy as np

from morfax.tracer.ink.exchanges import exchanges

ANY = np.ones((4, 4), bool)
ALL = {0, 1, 2, 3}


def test_two_lines_exchange_their_partners() -> None:
    assert set(exchanges(((0, 1), (2, 3)), ANY, ALL)) == {((0, 2), (1, 3)), ((0, 3), (1, 2))}


def test_a_line_that_ends_takes_a_partner_from_another() -> None:
    assert set(exchanges(((0, 1),), ANY[:3, :3], {0, 1, 2})) == {((0, 2),), ((1, 2),)}


def test_two_legs_that_are_no_line_are_joined_only_if_both_end() -> None:
    """Over a side between them, wherever they lead; else they are no line, and no leg is left alone."""
    are_lines = ANY.copy()
    are_lines[[0, 2], [2, 0]] = are_lines[[0, 1], [1, 0]] = False
    assert ((0, 1),) in exchanges((), are_lines, set())
    assert exchanges(((0, 1), (2, 3)), are_lines, ALL) == [((0, 3), (1, 2))]


def test_only_lines_about_what_is_wrong_have_others_partners() -> None:
    assert exchanges(((0, 1), (2, 3)), ANY, {0}) == []
