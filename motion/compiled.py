"""Compiled kernels: `@njit` as numba has it, but a kernel that is kept on disk runs without numba.

Importing numba and its registries takes longer than following a page, and a kernel that is on disk already
needs none of it. So `njit` puts a Kernel in the function's place. When a Kernel is called, it looks for
machine code that was kept for arguments of these types (`machine_code`); only if there is none, numba is
imported and the function compiled, and its machine code is kept.

Signals in: a function in the part of Python that numba compiles; arguments: numbers, arrays, records, tuples
of these. Signals out: what the function returns. The plain function stays at hand as `py_func`, as with
numba; with `NUMBA_DISABLE_JIT=1` it is called itself.

Questions: numba's own cache finds a kernel by numba's types, which cannot be had without numba, and does not
see that a kernel within another one was changed. Hence an index of our own, by the Python types of the
arguments. The machine code is numba's, so results are the same to the bit.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from functools import cached_property, update_wrapper
from types import ModuleType
from typing import Any, TypeVar

import numpy as np

from morfax.motion import compile_ahead, machine_code, object_code
from morfax.motion.object_code import Role

_C, _F, _ALIGNED, _WRITEABLE = 0x1, 0x2, 0x100, 0x400  # numpy's flags of an array
_FLAGS = _C | _F | _ALIGNED | _WRITEABLE
Hearer = Callable[
    [int], None
]  # called before a kernel is compiled, with how many were before it


class _Compiler:
    """How many kernels this process has compiled, and who hears of it."""

    def __init__(self) -> None:
        self.lock = threading.RLock()
        self.count = 0
        self.hearer: Hearer | None = None

    def begins(self) -> None:
        """Tell that a kernel is compiled now; with the first one, other cores begin with the next ones."""
        if self.hearer is not None:
            self.hearer(self.count)
        if self.count == 0:
            compile_ahead.begin()
        self.count += 1


_COMPILER = _Compiler()


def hear(hearer: Hearer | None) -> None:
    """Have somebody told before each kernel that has to be compiled, or nobody any more."""
    _COMPILER.hearer = hearer


class Kernel:
    """A function that runs as machine code, for each combination of argument types that it is called with."""

    def __init__(self, py_func: Callable[..., Any], options: dict[str, Any]) -> None:
        """Take the plain function and numba's options."""
        self.py_func = py_func
        self.options = options
        self._ready: dict[tuple[Any, ...], Callable[..., Any]] = {}
        self._dispatchers: dict[Role, Any] = {}
        update_wrapper(self, py_func)

    def __call__(self, *args: Any) -> Any:
        """Run the machine code for arguments of these types; get it first if need be."""
        of: list[Any] = []
        _add_kinds(args, of)
        key = tuple(of)
        run = self._ready.get(key)
        if run is None:
            run = self._ready[key] = self._found(args)
        return run(*args)

    def __reduce__(self) -> str:
        """Be pickled by name, as a function is."""
        return self.py_func.__qualname__

    def called(self) -> list[Kernel]:
        """All kernels that this one calls, and those that they call, itself included."""
        every = {id(self): self}
        left = [self]
        while left:
            for kernel in left.pop()._within:
                if id(kernel) not in every:
                    every[id(kernel)] = kernel
                    left.append(kernel)
        return list(every.values())

    @property
    def targetoptions(self) -> dict[str, Any]:
        """numba's options: it reads here whether to put the function in place of a call."""
        return self.options

    @property
    def _numba_type_(self) -> Any:
        """What numba takes a kernel for that another one calls: its dispatcher."""
        return self.dispatcher("part" if object_code.is_making() else "run")._numba_type_

    def dispatcher(self, role: Role) -> Any:
        """numba's dispatcher of the function, for what it is to do."""
        if role not in self._dispatchers:
            self._dispatchers[role] = object_code.dispatcher(self.py_func, self.options, role)
        return self._dispatchers[role]

    @cached_property
    def _within(self) -> list[Kernel]:
        """The kernels that the function itself names; looked up once, as other kernels ask for them again."""
        return [value for value in self._names.values() if isinstance(value, Kernel)]

    @cached_property
    def _names(self) -> dict[str, Any]:
        """What the function's names stand for, also within modules of ours; looked up once."""
        found, names = self.py_func.__globals__, _names_in(self.py_func.__code__)
        values = {name: found[name] for name in names if name in found}
        modules = [value for value in values.values() if isinstance(value, ModuleType)]
        for module in modules:
            if module.__name__.startswith("morfax."):
                within = vars(module)
                values |= {f"{module.__name__}.{n}": within[n] for n in names if n in within}
        return values

    @cached_property
    def frozen(self) -> str:
        """The plain values that the compiled function holds by names, as a text to compare."""
        plain = (bool, int, float, str, tuple)
        return repr(
            sorted((n, repr(v)) for n, v in self._names.items() if isinstance(v, plain))
        )

    def _found(self, args: tuple[Any, ...]) -> Callable[..., Any]:
        """The machine code for arguments like these: kept, or compiled now."""
        with _COMPILER.lock:
            if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0"):
                return self.py_func
            try:
                types = described(args)
            except TypeError:
                return self.dispatcher("run")
            return machine_code.kept(self, types) or self._compiled(types, args)

    def _compiled(self, types: str, args: tuple[Any, ...]) -> Callable[..., Any]:
        """Compile for arguments like these, and keep the machine code."""
        if not machine_code.can_be_kept():
            return self.dispatcher("run")
        _COMPILER.begins()
        with compile_ahead.claimed(f"{self.py_func.__module__}.{self.py_func.__name__}"):
            found = machine_code.kept(self, types)  # by a process that had claimed it
            return found or self._compiled_here(types, args)

    def _compiled_here(self, types: str, args: tuple[Any, ...]) -> Callable[..., Any]:
        """Compile in this process; numba runs what cannot run without it."""
        from numba import typeof

        signature = tuple(typeof(arg) for arg in args)
        try:
            entry = machine_code.entry(*object_code.make(self.dispatcher("whole"), signature))
        except NotImplementedError:
            entry = None
        if entry is None:
            return self.dispatcher("run")
        machine_code.keep(self, types, entry)
        return machine_code.linker().function(self, entry)

    def compile_for(self, types: str, args: tuple[Any, ...]) -> None:
        """Have machine code kept for arguments like these, if there is none; the kernel is not run."""
        if machine_code.kept(self, types) is None:
            self._compiled(types, args)


def njit(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Make a Kernel of a function; the options are those of numba's `njit`."""
    return lambda py_func: Kernel(py_func, options)


def _names_in(code: Any) -> set[str]:
    """Names that code and the functions within it look up."""
    within = [const for const in code.co_consts if hasattr(const, "co_names")]
    return set(code.co_names).union(*(_names_in(inner) for inner in within))


Kind = TypeVar("Kind")
_LASTING: dict[int, tuple[Any, int]] = {}
_KEPT_KINDS: set[type] = set()  # of tuples that keep their number
_NUMBERS: dict[
    tuple[Any, ...], int
] = {}  # of what decides the machine code, each time the same


def lasting(arg: Any) -> Any:
    """A tuple that lives as long as the process: what decides the machine code is made out once."""
    _LASTING[id(arg)] = (arg, _number(arg))
    return arg


def keeps_kinds(kind: type[Kind]) -> type[Kind]:
    """A kind of tuples with attributes: each keeps what decides the machine code once it was made out."""
    _KEPT_KINDS.add(kind)
    return kind


def _number(arg: tuple[Any, ...]) -> int:
    """The number of what of a tuple decides the machine code."""
    of: list[Any] = [type(arg), len(arg)]
    _add_kinds(arg, of)
    return _NUMBERS.setdefault(tuple(of), len(_NUMBERS))


def _add_kinds(args: tuple[Any, ...], of: list[Any]) -> None:
    """Add what of some arguments decides the machine code, quick to make and to compare.

    One after the other, and not one within the other: that takes half as long. What begins an argument tells
    how much belongs to it.
    """
    for arg in args:
        kind = type(arg)
        if kind is _Array:
            of += (arg.dtype, arg.ndim, arg.flags.num & _FLAGS)
        elif kind in _PLAIN:
            of.append(kind)
        elif kind in _KEPT_KINDS:
            if not hasattr(arg, "number_of_kinds"):
                arg.number_of_kinds = _number(arg)
            of.append(arg.number_of_kinds)
        elif isinstance(arg, tuple):
            if (known := _LASTING.get(id(arg))) is not None:
                of.append(known[1])
            else:
                of += (kind, len(arg))
                _add_kinds(arg, of)
        else:
            of.append(kind)
            if isinstance(arg, np.void):
                of.append(_dtype(arg))
            elif isinstance(arg, np.ndarray):
                of.append(arg.dtype)


_Array = np.ndarray  # one look-up where there were two
_dtype = np.generic.dtype.__get__  # type: ignore[attr-defined]  # a record looks among its fields first
_PLAIN = {float: "f8", int: "i8", bool: "b1", np.float64: "f8", np.int64: "i8", np.bool_: "b1"}
_PLAIN |= {kind: kind.__name__ for kind in (np.float32, np.int32, np.uint8, np.uint32)}


def described(args: tuple[Any, ...]) -> str:
    """The types of arguments, as an expression that means the same in every process.

    `compile_ahead.examples` makes arguments of it again. Raises TypeError for types that only numba can tell.
    """
    return "".join(f"{_described(arg)}, " for arg in args).rstrip()


def _described(arg: Any) -> str:
    """The type of one argument."""
    kind = type(arg)
    if kind in _PLAIN:
        return _PLAIN[kind]
    if kind is np.ndarray:
        return _array_described(arg)
    if kind is np.void or kind is np.record:
        return f"{kind.__name__}({arg.dtype!r})"
    if isinstance(arg, tuple):
        fields = getattr(kind, "_fields", None)
        of = "" if fields is None else f"named({kind.__module__!r}, {kind.__qualname__!r})"
        return f"{of}({described(arg)})"
    if arg is None:
        return "None"
    raise TypeError(f"no key for {kind}")


def _array_described(array: np.ndarray[Any, Any]) -> str:
    """The kind of an array: its data, its dimensions, how it lies in memory, whether it may be written to."""
    flags = array.flags.num
    layout = "C" if flags & _C else "F" if flags & _F else "A"
    rest = f"{'' if flags & _ALIGNED else 'u'}{'' if flags & _WRITEABLE else 'r'}"
    return f"array({array.dtype!r}, {array.ndim}, {layout + rest!r})"
