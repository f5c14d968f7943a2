"""Things by their numbers in a sentence: all of a few, the first of many."""

from __future__ import annotations

import pytest

from morfax.motion.by_number import numbered


@pytest.mark.parametrize(
    ("numbers", "said"),
    [
        ([4], "line 4 is"),
        ([4, 7], "lines 4, 7 are"),
        ([1, 2, 3, 4, 5, 6], "lines 1, 2, 3, 4, 5, 6 are"),
        (list(range(11, 121)), "lines 11, 12, 13, 14, 15, 16 and 104 more are"),
    ],
)
def test_a_sentence_names_a_few_numbers_and_counts_many(numbers: list[int], said: str) -> None:
    assert numbered("line", numbers) == said
