"""A plugin of pytest for mutants: which functions each test comes by, and kernels kept but for those changed.

    MORFAX_COVERED=FILE      write the functions and the processor time of each test there, as JSON
    MORFAX_MUTANT=FILE       read there what is changed, and compile only kernels that it matters to

What is run while a test's fixtures are made counts for all tests of its file, as they may share them. Of a
kernel that is called all kernels within count. A test that starts processes may come by anything.
"""

from __future__ import annotations

import json
import os
import resource
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

import pytest

from morfax.motion import compiled, machine_code
from morfax.motion.compiled import Kernel

ROOT = Path(__file__).parents[2]
ANYTHING = "*"
CHILD_S = 0.05  # of processor time: a process that a test started


def function_of(code: CodeType) -> str:
    """A function as `users` tells it, without the functions within it; empty for code that is not ours."""
    name = code.co_qualname.split(".<locals>")[0]
    file = Path(code.co_filename)
    if not file.is_relative_to(ROOT):
        return ""
    place = file.relative_to(ROOT)
    return f"{place.relative_to('morfax') if place.parts[0] == 'morfax' else place}:{name}"


class Covered:
    """Which functions each test comes by."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self.shared = dict[str, set[CodeType]]()
        self.own = dict[str, set[CodeType]]()
        self.took_s = dict[str, float]()
        self.with_processes = set[str]()
        self.now = self.everywhere = set[CodeType]()
        run = Kernel.__call__

        def call(kernel: Kernel, *args: Any) -> Any:
            self.now.update(part.py_func.__code__ for part in kernel.called())
            return run(kernel, *args)

        compiled.Kernel.__call__ = call  # type: ignore[method-assign]
        threading.setprofile(self._note)
        sys.setprofile(self._note)

    def _note(self, frame: FrameType, event: str, _arg: Any) -> None:
        if event == "call":
            self.now.add(frame.f_code)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """Note what a test comes by and how long it takes."""
        own_s, children_s = _processor_s()
        self.own[item.nodeid] = set()
        result = yield
        more_s, more_children_s = _processor_s()
        self.took_s[item.nodeid] = more_s - own_s + more_children_s - children_s
        if more_children_s - children_s > CHILD_S:
            self.with_processes.add(item.nodeid)
        return result

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> Iterator[None]:
        """What is run for a test's fixtures is of all tests of the file."""
        self.now = self.shared.setdefault(item.nodeid.split("::")[0], set())
        return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Iterator[None]:
        """What a test itself runs is its own."""
        self.now = self.own[item.nodeid]
        return (yield)

    def pytest_sessionfinish(self) -> None:
        """Write what each test comes by."""
        sys.setprofile(None)
        told = {}
        for test, own in self.own.items():
            every = own | self.shared[test.split("::")[0]] | self.everywhere
            names = {function_of(code) for code in every} - {""}
            if test in self.with_processes:
                names.add(ANYTHING)
            told[test] = [self.took_s[test], sorted(names)]
        self.file.write_text(json.dumps(told), encoding="utf-8")


def _processor_s() -> tuple[float, float]:
    """Processor time of this process and of those that it has waited for, s."""
    used = [resource.getrusage(w) for w in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    own, children = (one.ru_utime + one.ru_stime for one in used)
    return own, children


def keep_kernels(file: str, stamp: tuple[str, str], functions: set[str]) -> None:
    """Have kernels that a change of a file does not matter to taken as they were kept without it."""
    makings, stamped = machine_code._makings, machine_code._stamp
    as_before = False

    def stamp_of(place: str) -> tuple[str, str]:
        return stamp if as_before and Path(place).samefile(ROOT / file) else stamped(place)

    def makings_of(kernel: Kernel) -> str:
        nonlocal as_before
        named = {function_of(part.py_func.__code__) for part in kernel.called()}
        as_before = not named & functions
        return makings(kernel)

    machine_code._stamp = stamp_of  # type: ignore[assignment]
    machine_code._makings = makings_of
    machine_code.VERSIONS = sys.maxsize  # none of before is cleared away for those of mutants


def pytest_configure(config: pytest.Config) -> None:
    """Do what is asked for by the environment."""
    if covered := os.environ.get("MORFAX_COVERED"):
        config.pluginmanager.register(Covered(Path(covered)))
    if mutant := os.environ.get("MORFAX_MUTANT"):
        file, stamp, functions = json.loads(Path(mutant).read_text("utf-8"))
        keep_kernels(file, tuple(stamp), set(functions))
