"""Linking: object code that numba has made of a kernel becomes a Python function, without numba.

numba's object code needs little of numba to run: the C functions of its three extension modules, which are
loaded by themselves here, and the names of the built-in exceptions. Where these are not as they were with the
version that this was written for (numba 0.68), no linker can be made, and numba runs the kernels.

Object code for the usual kind of machine is placed here (`placed_code`); llvmlite is loaded only for others.

Signals in: a kernel and what is kept of it (`machine_code`). Signals out: a Python function.

Source: numba's own `core.runtime`, `core.base` and `_helperlib`; llvmlite's MCJIT. Questions: none.
"""

from __future__ import annotations

import builtins
import ctypes
import pickle
import sys
from collections.abc import Callable
from functools import cache, cached_property
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from morfax.motion import processor
from morfax.motion.extension import extension, folder_of
from morfax.motion.placed_code import placed

if TYPE_CHECKING:
    from morfax.motion.compiled import Kernel
    from morfax.motion.llvm_linker import LlvmLinker

# an entry: object code, name of the function in it, environments: name, module, pickled dtypes
Entry = tuple[bytes, str, list[tuple[str, str, list[bytes]]]]
EXTENSIONS = ("_dynfunc", "_helperlib", "core.runtime._nrt_python")


def in_process(name: str) -> bool:
    """Whether the process has a C function or variable of this name."""
    return hasattr(ctypes.pythonapi, name)


class Linker:
    """A linker with the C functions of numba that object code asks for."""

    def __init__(self) -> None:
        self.triple, self.target = processor.here()
        self.addresses: dict[str, int] = {}  # of what object code asks for, by names
        dynfunc, helpers, runtime = (extension("numba", name) for name in EXTENSIONS)
        self._make_function, self._environment = dynfunc.make_function, dynfunc.Environment
        self._name_all(dynfunc.c_helpers, helpers.c_helpers, runtime.c_helpers)
        _serve_pickles(helpers.c_helpers["unpickle"])
        self._environments: dict[str, Any] = {}

    def function(self, kernel: Kernel, entry: Entry) -> Callable[..., Any]:
        """Link the object code of an entry; give its Python function."""
        code, name, environments = entry
        if b"numba_xx" in code or b"numba_xgesv" in code or b"numba_ez_" in code:
            _load_algebra()
        address_of = self._placed(code)
        for held in environments:
            self._set_environment(address_of, *held)
        own = self._environments[environments[0][0]]
        plain = kernel.py_func
        module = sys.modules[plain.__module__]
        return self._make_function(
            module, plain.__name__, plain.__doc__ or "", address_of(name), own, (kernel,)
        )

    def _set_environment(
        self, address_of: Callable[[str], int], name: str, module: str, constants: list[bytes]
    ) -> None:
        """Give compiled code the names of the module that it was written in, as numba does."""
        if name not in self._environments:
            # code of numba's own modules looks nothing up: they need not be there
            names = vars(sys.modules[module]) if module in sys.modules else {"__name__": module}
            self._environments[name] = self._environment(names)
            self._environments[name].consts.extend(
                pickle.loads(constant) for constant in constants
            )
        address = address_of(name)
        if address:
            ctypes.c_void_p.from_address(address).value = id(self._environments[name])

    def _placed(self, code: bytes) -> Callable[[str], int]:
        """Put object code where it can run; give what tells addresses in it by names."""
        try:
            return placed(code, self._address).__getitem__
        except (NotImplementedError, OSError):
            return self._by_llvm.placed(code)

    @cached_property
    def _by_llvm(self) -> LlvmLinker:
        """llvmlite's linker, which knows the same names."""
        from morfax.motion.llvm_linker import LlvmLinker

        return LlvmLinker(self.addresses)

    def _address(self, name: str) -> int:
        """Where a C function is that object code asks for."""
        if name in self.addresses:
            return self.addresses[name]
        if not in_process(name):
            raise NotImplementedError(f"no {name} in this process")
        return ctypes.cast(getattr(ctypes.pythonapi, name), ctypes.c_void_p).value or 0

    def _name_all(
        self, dynfunc: dict[str, int], helpers: dict[str, int], runtime: dict[str, int]
    ) -> None:
        """Give names to C functions and exceptions as numba's `base`, `externals` and `nrt` do."""
        self._name("_Py_NoneStruct", id(None))
        for name, address in {**helpers, **dynfunc}.items():
            self._name(f"numba_{name}", address)
            if in_process(name):
                self._name(name, address)
        for name, address in runtime.items():
            self._name(name if name.startswith("_") else f"NRT_{name}", address)
        for kind in vars(builtins).values():
            if isinstance(kind, type) and issubclass(kind, BaseException):
                self._name(f"PyExc_{kind.__name__}", id(kind))

    def _name(self, name: str, address: int) -> None:
        self.addresses[name] = address


def _load_algebra() -> None:
    """Load scipy's BLAS and LAPACK, which numba's C functions would import at their first call.

    If Ctrl-C comes while they do, they end the process with a dump. The two are loaded by themselves, and not
    scipy.linalg, which loads much more.
    """
    try:
        for name in ("linalg.cython_blas", "linalg.cython_lapack"):
            extension("scipy", name)
    except ImportError:  # a scipy that keeps them elsewhere
        from scipy.linalg import cython_blas, cython_lapack

        assert cython_blas and cython_lapack


def _serve_pickles(unpickle_address: int) -> None:
    """Have numba's C function that unpickles types (of what kernels give back) do so without numba.

    At its first call it asks `numba.core.serialize` for the Python function that does it, and keeps that.
    """
    asked = "numba.core.serialize"
    if "numba" in sys.modules:
        return
    loaded: dict[tuple[int, bytes], Any] = {}

    def unpickled(address: int, data: bytes, digest: bytes) -> Any:
        if (address, digest) not in loaded:
            loaded[address, digest] = pickle.loads(data)
        return loaded[address, digest]

    stand_ins = {name: ModuleType(name) for name in ("numba", asked)}
    vars(stand_ins[asked])["_numba_unpickle"] = unpickled
    sys.modules.update(stand_ins)
    try:
        call = ctypes.PYFUNCTYPE(
            ctypes.py_object, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p
        )
        nothing = pickle.dumps(None)
        call(unpickle_address)(nothing, len(nothing), bytes(20))
    finally:
        for name in stand_ins:
            del sys.modules[name]


@cache
def linker() -> Linker:
    """The linker of this process."""
    return Linker()


@cache
def numba_folder() -> Path:
    """Where numba is installed."""
    return folder_of("numba")
