"""A copy of the tree that is broken, one mutant at a time, and its tests.

Kernels that a mutant does not matter to are taken as the user's own folder has them; only the others are
compiled (`watch`). A mutant is run against the tests that come by a function which it can matter to, the
quickest first. It is found where one fails, or where they take three times the processor time that they
should, or wait for ever.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from morfax.motion import machine_code
from morfax.motion.kernel_folder import kernel_folder
from tests.mutants.changes import Mutant
from tests.mutants.users import Users, users_of
from tests.mutants.watch import ANYTHING

ROOT = Path(__file__).parents[2]
SLOWER = 3.0  # times the tests' own time, for a mutant
SPARE_S = 30.0  # to compile the kernels of a mutant
# times that limit, by the clock: a mutant may also wait for ever, and take no time
WAITS = 10.0


@dataclass(frozen=True)
class WatchedTest:
    """A test: what it comes by, and its processor time, s."""

    name: str
    took_s: float
    functions: frozenset[str]

    def comes_by(self, users: Users, root: Path) -> bool:
        """Whether a change may matter to a test."""
        if self.functions & (users.functions | {ANYTHING}):
            return True
        text = (root / self.name.split("::")[0]).read_text("utf-8") if users.symbols else ""
        return any(symbol in text for symbol in users.symbols)


class Copy:
    """A copy of the tree, with its own folder of compiled kernels."""

    def __init__(self, folder: Path) -> None:
        hidden = shutil.ignore_patterns(".*", "__pycache__", "demo", "site")
        self.root = folder / "tree"
        if not self.root.exists():
            shutil.copytree(ROOT, self.root, symlinks=True, ignore=hidden)
            # tests that ask for the vectors would be left out without them, and notice nothing
            if (ROOT.parent / "shared").exists():
                (folder / "shared").symlink_to(ROOT.parent / "shared")
            if (kept := kernel_folder()) is not None:
                shutil.copytree(kept, folder / "kernels")
        self._change, self._covered = folder / "change.json", folder / "covered.json"
        kernels = {"NUMBA_CACHE_DIR": str(folder / "kernels"), "PYTHONDONTWRITEBYTECODE": "1"}
        self._environment = os.environ | kernels
        self.said = ""  # by pytest, of the tests that were run last

    def passes(self, tests: list[str], limit_s: float | None = None, **more: str) -> bool:
        """Whether tests pass, in time: processor time, as the machine may have other work."""
        limited = ["prlimit", f"--cpu={math.ceil(limit_s)}"] if limit_s else []
        plugins = ["-p", "no:cacheprovider", "-p", "tests.mutants.watch"]
        command = [*limited, sys.executable, "-m", "pytest", "-x", "-q", *plugins, *tests]
        try:
            done = subprocess.run(
                command,
                cwd=self.root,
                env=self._environment | more,
                capture_output=True,
                text=True,
                check=False,
                timeout=WAITS * limit_s if limit_s else None,
            )
        except subprocess.TimeoutExpired:
            return False
        self.said = done.stdout + done.stderr
        return done.returncode == 0

    def watched(self, tests: list[str]) -> list[WatchedTest] | None:
        """What each test of some files comes by, the quickest first; None if one fails, see `said`."""
        if not self.passes(tests, MORFAX_COVERED=str(self._covered)):
            return None
        told = json.loads(self._covered.read_text("utf-8")).items()
        every = [WatchedTest(name, took_s, frozenset(names)) for name, (took_s, names) in told]
        return sorted(every, key=lambda test: test.took_s)

    def tests_for(self, mutant: Mutant, tests: list[WatchedTest]) -> list[WatchedTest]:
        """Those tests that come by a function which a mutant can matter to."""
        users = users_of(self.root, mutant.file, mutant.line)
        return [test for test in tests if test.comes_by(users, self.root)]

    def finds(self, mutant: Mutant, tests: list[WatchedTest]) -> bool:
        """Whether one of the tests that come by a mutant fails with it."""
        asked = self.tests_for(mutant, tests)
        limit_s = SLOWER * sum(test.took_s for test in asked) + SPARE_S
        return bool(asked) and self.notices(mutant, [test.name for test in asked], limit_s)

    def notices(self, mutant: Mutant, tests: list[str], limit_s: float) -> bool:
        """Whether a test fails with a mutant, which is taken out again."""
        file = self.root / mutant.file
        source = file.read_text(encoding="utf-8")
        users = users_of(self.root, mutant.file, mutant.line)
        change = (str(mutant.file), machine_code._stamp(str(file)), sorted(users.functions))
        self._change.write_text(json.dumps(change), encoding="utf-8")
        file.write_text(mutant.text(source), encoding="utf-8")
        try:
            return not self.passes(tests, limit_s, MORFAX_MUTANT=str(self._change))
        finally:
            file.write_text(source, encoding="utf-8")
