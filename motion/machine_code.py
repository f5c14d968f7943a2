"""Machine code of kernels on disk: kept once numba has compiled a kernel, and linked later without numba.

    first process    numba compiles -> object code, as numba's own cache has it -> NAME.kernel
    every other one  NAME.kernel -> llvmlite links the object code -> a Python function

numba's object code needs little of numba to run: the C functions of its three extension modules, which are
loaded by themselves here, and the names of the built-in exceptions. What a kernel was made with is kept
beside it (versions, processor, numba's settings, sources of all kernels in it, values of constants); a kernel
whose makings have changed is compiled anew, and so is one whose file is damaged. Where something is not as it
was with the versions that this was written for (numba 0.68), nothing is kept here, and numba runs the kernels
with its own cache. `MORFAX_KERNELS=numba` asks for that.

Signals in: a kernel, the types of its arguments as a text. Signals out: a Python function.
Files: `MODULE.NAME-LINE.TAG.kernel` in `__pycache__` beside the module, or in `NUMBA_CACHE_DIR`: a SHA-256
digest, then what the kernel was made with and its entries, marshalled.

Questions: shared objects made with the wheel would need a compiler there, a wheel for each kind of machine,
and code for the oldest processor of that kind (docs/design.md, rejected designs).
"""

from __future__ import annotations

import builtins
import ctypes
import importlib.machinery
import importlib.util
import marshal
import os
import pickle
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from morfax.motion.compiled import Kernel

# an entry: object code, name of the function in it, environments: name, module, pickled dtypes
Entry = tuple[bytes, str, list[tuple[str, str, list[bytes]]]]
FORMAT = 1  # of the files; another number with every change of Entry
DIGEST = 32  # bytes of a SHA-256 digest, which stands before the rest of a file
EXTENSIONS = ("_dynfunc", "_helperlib", "core.runtime._nrt_python")


def kept(kernel: Kernel, types: str) -> Callable[..., Any] | None:
    """The function that runs kept machine code for arguments of these types; None if none fits."""
    if not can_be_kept():
        return None
    entries = _read(kernel)
    entry = entries.get(types)
    return None if entry is None else _linker().function(kernel, entry)


def keep(kernel: Kernel, types: str, compiled: Any) -> None:
    """Keep what numba has compiled for arguments of these types, if it can run without numba."""
    entry = _entry(compiled)
    if entry is None:
        return
    entries = {**_read(kernel), types: entry}
    file = _file(kernel)
    content = marshal.dumps((_makings(kernel), entries))
    unfinished = None
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        number, name = tempfile.mkstemp(dir=file.parent, prefix=file.name)
        unfinished = Path(name)
        with os.fdopen(number, "wb") as stream:
            stream.write(sha256(content).digest() + content)
        unfinished.replace(file)
    except OSError:  # a folder that cannot be written: compiled again next time
        if unfinished is not None:
            unfinished.unlink(missing_ok=True)


@cache
def can_be_kept() -> bool:
    """Whether machine code can be run without numba here."""
    if os.environ.get("MORFAX_KERNELS") == "numba":
        return False
    try:
        _linker()
    except (ImportError, AttributeError, OSError, TypeError, RuntimeError):
        return False
    return True


def _entry(compiled: Any) -> Entry | None:
    """What is kept of one compiled function; None if it holds more than machine code."""
    module = compiled.library._final_module
    known = _linker().names
    for function in module.functions:
        name = function.name
        if function.is_declaration and not (
            name.startswith("llvm.") or name in known or _in_process(name)
        ):
            return None
    others = [
        held
        for held in compiled._find_referenced_environments()
        if held is not compiled.environment
    ]
    held = [compiled.environment, *others]
    constants = [constant for environment in held for constant in environment.consts]
    if compiled.objectmode or not all(isinstance(constant, np.dtype) for constant in constants):
        return None
    environments = [
        (
            of.env_name,
            of.globals["__name__"],
            [pickle.dumps(constant) for constant in of.consts],
        )
        for of in held
    ]
    _, _, (code, _) = compiled.library.serialize_using_object_code()
    return code, compiled.fndesc.llvm_cpython_wrapper_name, environments


def _in_process(name: str) -> bool:
    """Whether the process has a C function or variable of this name."""
    return hasattr(ctypes.pythonapi, name)


class _Linker:
    """llvmlite's linker, with the C functions of numba that object code asks for."""

    def __init__(self) -> None:
        import llvmlite.binding as llvm

        self._llvm = llvm
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
        self.cpu = f"{llvm.get_host_cpu_name()} {llvm.get_host_cpu_features().flatten()}"
        self.names: set[str] = set()
        dynfunc, helpers, runtime = (_extension(name) for name in EXTENSIONS)
        self._make_function, self._environment = dynfunc.make_function, dynfunc.Environment
        self._name_all(dynfunc.c_helpers, helpers.c_helpers, runtime.c_helpers)
        _serve_pickles(helpers.c_helpers["unpickle"])
        machine = llvm.Target.from_triple(llvm.get_process_triple()).create_target_machine(
            jit=True, cpu=llvm.get_host_cpu_name()
        )
        empty = llvm.parse_assembly(f'target triple = "{llvm.get_process_triple()}"')
        self._engine = llvm.create_mcjit_compiler(empty, machine)
        self._environments: dict[str, Any] = {}

    def function(self, kernel: Kernel, entry: Entry) -> Callable[..., Any]:
        """Link the object code of an entry; give its Python function."""
        code, name, environments = entry
        self._engine.add_object_file(self._llvm.ObjectFileRef.from_data(code))
        self._engine.finalize_object()
        for held in environments:
            self._set_environment(*held)
        own = self._environments[environments[0][0]]
        plain = kernel.py_func
        address = self._engine.get_function_address(name)
        module = sys.modules[plain.__module__]
        return self._make_function(
            module, plain.__name__, plain.__doc__ or "", address, own, (kernel,)
        )

    def _set_environment(self, name: str, module: str, constants: list[bytes]) -> None:
        """Give compiled code the names of the module that it was written in, as numba does."""
        if name not in self._environments:
            # code of numba's own modules looks nothing up: they need not be there
            names = vars(sys.modules[module]) if module in sys.modules else {"__name__": module}
            self._environments[name] = self._environment(names)
            self._environments[name].consts.extend(
                pickle.loads(constant) for constant in constants
            )
        address = self._engine.get_global_value_address(name)
        if address:
            ctypes.c_void_p.from_address(address).value = id(self._environments[name])

    def _name_all(
        self, dynfunc: dict[str, int], helpers: dict[str, int], runtime: dict[str, int]
    ) -> None:
        """Give names to C functions and exceptions as numba's `base`, `externals` and `nrt` do."""
        self._name("_Py_NoneStruct", id(None))
        for name, address in {**helpers, **dynfunc}.items():
            self._name(f"numba_{name}", address)
            if _in_process(name):
                self._name(name, address)
        for name, address in runtime.items():
            self._name(name if name.startswith("_") else f"NRT_{name}", address)
        for kind in vars(builtins).values():
            if isinstance(kind, type) and issubclass(kind, BaseException):
                self._name(f"PyExc_{kind.__name__}", id(kind))

    def _name(self, name: str, address: int) -> None:
        self._llvm.add_symbol(name, address)
        self.names.add(name)


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
def _linker() -> _Linker:
    """The linker of this process."""
    return _Linker()


def _extension(name: str) -> Any:
    """One of numba's extension modules, loaded without the package's `__init__`."""
    full = f"numba.{name}"
    if full not in sys.modules:
        folder = _numba_folder().joinpath(*name.split(".")[:-1])
        stem = name.split(".")[-1]
        endings = importlib.machinery.EXTENSION_SUFFIXES
        file = next(file for ending in endings if (file := folder / f"{stem}{ending}").exists())
        spec = importlib.util.spec_from_file_location(full, file)
        if spec is None or spec.loader is None:
            raise ImportError(full)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        sys.modules[full] = module
    return sys.modules[full]


@cache
def _numba_folder() -> Path:
    """Where numba is installed."""
    spec = importlib.machinery.PathFinder.find_spec("numba")
    if spec is None or spec.origin is None:
        raise ImportError("numba")
    return Path(spec.origin).parent


def _read(kernel: Kernel) -> dict[str, Entry]:
    """The entries of a kernel that were made with what is there now; none if there is no such file."""
    try:
        data = _file(kernel).read_bytes()
    except OSError:
        return {}
    digest, content = data[:DIGEST], data[DIGEST:]
    if sha256(content).digest() != digest:
        return {}  # damaged
    made_with, entries = marshal.loads(content)
    return entries if made_with == _makings(kernel) else {}


def _makings(kernel: Kernel) -> str:
    """What the machine code of a kernel depends on, as a text to compare."""
    called = kernel.called()
    sources = sorted({part.py_func.__code__.co_filename for part in called})
    values = sorted(part.frozen() for part in called)
    return repr((_surroundings(), [_stamp(source) for source in sources], values))


@cache
def _surroundings() -> str:
    """Versions, processor and numba's settings."""
    settings = {name: value for name, value in os.environ.items() if name.startswith("NUMBA_")}
    settings.pop("NUMBA_CACHE_DIR", None)
    versions = [
        _numba_folder() / "_version.py",
        _numba_folder().parent / "llvmlite" / "_version.py",
    ]
    return repr(
        (FORMAT, sys.version, _linker().cpu, settings, [_stamp(str(file)) for file in versions])
    )


@cache
def _stamp(file: str) -> tuple[str, int, int]:
    """Name, time and size of a file."""
    status = Path(file).stat()
    return Path(file).name, status.st_mtime_ns, status.st_size


def _file(kernel: Kernel) -> Path:
    """Where the machine code of a kernel is kept."""
    code = kernel.py_func.__code__
    source = Path(code.co_filename)
    given = os.environ.get("NUMBA_CACHE_DIR")
    mark = sha256(str(source.parent).encode()).hexdigest()[:16]
    folder = (
        Path(given) / f"{source.parent.name}_{mark}" if given else source.parent / "__pycache__"
    )
    tag = sys.implementation.cache_tag
    return folder / f"{source.stem}.{code.co_name}-{code.co_firstlineno}.{tag}.kernel"
