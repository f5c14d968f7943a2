"""Orders of Superior Electric's tape, and what the control makes of rows of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from morfax.player.steps.stepping import (
    decode,
    pulses_of,
)
from morfax.recorder.steps.file import (
    StepFormat,
    StepProgram,
)

LINEAR = (1, 2, 3, 4, 5, 6, 7)
SAME, X_UP, X_DOWN, Y_UP, Y_DOWN = 0b10000, 0b10001, 0b10010, 0b10100, 0b11000
PREVIOUS, NEXT, REPEAT = 0b00001, 0b00010, 0b00000
INTO_RING_OF_SIX = [X_UP] * 6  # to (6, 0)


def program(rows: list[int], **fmt: Any) -> StepProgram:
    """Rows of a tape of five channels, one vector command in each unless told otherwise."""
    return StepProgram(
        StepFormat(**{"vectors": 1, "channels": 5, **fmt}), np.array(rows, np.uint16)
    )


def counts(rows: list[int], **fmt: Any) -> list[list[int]]:
    """Counts of X and Y in each interval."""
    return [count[:2] for count in decode(program(rows, **fmt))[0].tolist()]


def pulses_in(rows: list[int], **fmt: Any) -> list[list[int]]:
    """Pulses to X and Y in each interval."""
    tape = program(rows, **fmt)
    return [steps[:2] for steps in pulses_of(decode(tape)[0], tape.format.rates).tolist()]
