"""What ends is ended once, with the error that ended it; and both halves of a tape are."""

from __future__ import annotations

from typing import Any

import pytest

from morfax.motion.ending import Ending
from morfax.recorder.tape.halves import Halves


class Ended(Ending):
    """Takes down how it was ended, and may fail at that."""

    def __init__(self, fails: bool = False) -> None:
        self.fails, self.by = fails, list[Any]()

    def end(self, error: BaseException | None) -> None:
        """Take the error down."""
        self.by.append(error)
        if self.fails:
            raise OSError("no room")


def test_the_end_hears_what_ended_the_work() -> None:
    with Ended() as well:
        pass
    assert well.by == [None]
    with pytest.raises(ValueError, match="wrong") as caught, Ended() as badly:
        raise ValueError("wrong")
    assert badly.by == [caught.value]


@pytest.mark.parametrize("first_fails", [True, False])
def test_both_halves_are_closed_where_one_is_not_whole(first_fails: bool) -> None:
    spools: Any = Ended(first_fails), Ended(not first_fails)
    with pytest.raises(OSError, match="no room"), Halves(spools):
        pass
    assert [spool.by for spool in spools] == [[None], [None]]
