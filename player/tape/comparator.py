"""Comparator and decoder: how far the edges of the screw's pick-up lie behind those of the tape, in cycles.

Signals in: the edges of two pulse trains, each as a count of them and the share of a cycle since the last.
Signal out: the error in cycles, at each step of the drives.

    track's carrier ──► trigger 152    ┌─┐   ┌─┐   ┌─┐
                                    ───┘ └───┘ └───┘ └──     comparator 153:  time from edge to edge, cycles
    cell 141 ──► trigger 157          ┌─┐   ┌─┐   ┌─┐        decoder 158:     edges of the tape counted up,
                                   ───┘ └───┘ └───┘ └─                        those of the cell down

    error = (count of the tape - count of the cell) + (share of the tape - share of the cell)

The comparator alone knows the error within a cycle; the decoder knows how many cycles there are besides.
A cell that gives no edges leaves the tape's uncounted: the error grows by a cycle with each of them.

Source: patent ES 361967, figure 5 (triggers 152 and 157, comparator 153, decoder 158), claims 5 and 17.
Questions: the patent compares once in a cycle, at the edges. Here the trigger of the tape is the
discriminator, which has the phase of the whole wave, and the time between two edges of the cell is divided
evenly, so that each step of the drives has a comparison.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.compiled import njit


@njit(cache=True, inline="always")
def track_edges(reference, cycles):  # type: ignore[no-untyped-def]
    """Edges that a track has given (152), and the share since the last; `cycles`: against the reference."""
    phase = reference + cycles
    count = np.floor(phase)
    return count, phase - count


@njit(cache=True, inline="always")
def compared(tape, cell):  # type: ignore[no-untyped-def]
    """The error in cycles (153 and 158), of (count, share) of the tape and of the cell."""
    return (tape[0] - cell[0]) + (tape[1] - cell[1])
