"""Which processor kernels are compiled for: one that most machines have, so that machine code serves them.

    x86-64 with AVX2, FMA and what else came with them (2013)  -> x86-64-v3
    any other                                                  -> this machine's own processor

So a wheel can bring kernels along, and a path is the same to the bit on all machines of the first line.

Signals in: Linux's features of the processor; if it lacks one of the level, or of another system, llvmlite's
name and features; `NUMBA_CPU_NAME`, which goes before all of this.
Signals out: a name and features as numba's settings `CPU_NAME` and `CPU_FEATURES` take them.

Source: x86-64 psABI, 3.1.1, micro-architecture levels. Questions: on other processors there is no such level
that all of a kind have, and kernels are compiled on the machine itself.
"""

from __future__ import annotations

import os
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from typing import Any, NamedTuple

LEVEL = "x86-64-v3"
# what the psABI lists for the levels 1, 2 and 3, in LLVM's words
LEVEL_HAS = frozenset(
    {"cmov", "cx8", "fxsr", "mmx", "sse", "sse2"}
    | {"cx16", "sahf", "popcnt", "sse3", "sse4.1", "sse4.2", "ssse3"}
    | {"avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "xsave"}
)
# those that Linux calls otherwise
IN_LINUX = {"sahf": "lahf_lm", "sse3": "pni", "sse4.1": "sse4_1", "sse4.2": "sse4_2"}
IN_LINUX |= {"bmi": "bmi1", "lzcnt": "abm"}
CPUINFO = Path("/proc/cpuinfo")
LINUX = "x86_64-unknown-linux-gnu"  # the kind of machine, in LLVM's words


class Processor(NamedTuple):
    """A processor to compile for, in LLVM's words."""

    name: str
    features: str  # what it has beyond its name; empty: nothing


def here() -> tuple[str, Processor]:
    """The kind of machine, and the processor to compile for on it; llvmlite is loaded where it must tell."""
    if "x86_64-linux-gnu" in EXTENSION_SUFFIXES[0] and has_level(CPUINFO):
        return LINUX, given() or Processor(LEVEL, "")
    import llvmlite.binding as llvm

    return llvm.get_process_triple(), target(llvm)


def has_level(cpuinfo: Path) -> bool:
    """Whether Linux says that the processor has all of the level."""
    try:
        lines = cpuinfo.read_text().splitlines()
    except OSError:
        return False
    has = next((set(line.split()) for line in lines if line.startswith("flags")), set[str]())
    return has >= {IN_LINUX.get(name, name) for name in LEVEL_HAS}


def given() -> Processor | None:
    """The processor that numba's settings ask for; None if they ask for none."""
    name = os.environ.get("NUMBA_CPU_NAME")
    return Processor(name, os.environ.get("NUMBA_CPU_FEATURES", "")) if name else None


def target(llvm: Any) -> Processor:
    """The processor to compile for on this machine; `llvm` is `llvmlite.binding`."""
    if (asked := given()) is not None:
        return asked
    features = llvm.get_host_cpu_features()
    has = {name for name, there in features.items() if there}
    if llvm.get_process_triple().startswith("x86_64-") and has >= LEVEL_HAS:
        return Processor(LEVEL, "")
    return Processor(llvm.get_host_cpu_name(), features.flatten())


def aim(at: Processor) -> Processor:
    """Have numba compile for a processor; give the one that it does compile for.

    That is another one where the process has compiled kernels of others before.
    """
    import numba
    from numba.core.registry import cpu_target

    config: Any = numba.config
    config.CPU_NAME, config.CPU_FEATURES = at
    _, name, features = cpu_target.target_context.codegen().magic_tuple()
    return Processor(name, features)
