"""Mutation testing of one room: put one wrong line at a time into the code, and see whether a test fails.

    python -m tests.mutants player/gcode --sample 60 --seed 1

`changes` makes the mutants of a file, `users` tells which functions a change can matter to, `watch` which
tests come by those (a plugin of pytest), `tree` is the copy that is broken, and `__main__` runs them in turn.
"""

from tests.mutants.changes import Mutant, mutants_of
from tests.mutants.tree import Copy

__all__ = ["Copy", "Mutant", "mutants_of"]
