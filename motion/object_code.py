"""Object code of a kernel: numba as a compiler, and nothing more.

numba optimises each function by itself, makes its machine code and loads it, as it may be called by itself.
Of the functions within a kernel nobody calls one: they are linked into the kernel, and optimised there once
more. So here nothing is loaded, and nothing is optimised before all parts are together:

    parts -> types, LLVM's code ─┐
    kernel -> types, LLVM's code ┴> linked -> optimised -> object code

All kernels of the list take 0.45 times the processor time of before, and run as fast (CHANGELOG).

Signals in: a plain function, numba's options, numba's types of its arguments. Signals out: numba's result,
whose library is linked and optimised but not loaded, and the object code.

Source: numba's own `core.codegen` and `core.typed_passes.NativeLowering`. Questions: where numba has no such
names any more, nothing can be made here (`NotImplementedError`), and numba runs the kernels.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any, Literal

from morfax.motion import machine_code, shape_faults

# numba runs it; its object code is made; it is part of a kernel whose object code is made
Role = Literal["run", "whole", "part"]
OPTIONS: dict[Role, dict[str, bool]] = {
    "run": {},
    "whole": {"no_cfunc_wrapper": True},
    "part": {"no_cfunc_wrapper": True, "no_cpython_wrapper": True},
}
_NOW = threading.local()


def is_making() -> bool:
    """Whether this thread makes object code now, so that kernels that are asked for are parts."""
    return getattr(_NOW, "making", False)


def dispatcher(py_func: Callable[..., Any], options: dict[str, Any], role: Role) -> Any:
    """numba's dispatcher of a function, for what it is to do; it keeps code itself only where we cannot."""
    import numba

    shape_faults.short()
    if machine_code.can_be_kept():
        machine_code.aim()
        options = {**options, "cache": False}
    njit: Any = numba.njit
    return njit(**options, **OPTIONS[role])(py_func)


def make(whole: Any, signature: tuple[Any, ...]) -> tuple[Any, bytes]:
    """Compile a dispatcher for arguments of these types; give numba's result and the object code.

    Raises NotImplementedError where numba is made otherwise.
    """
    from numba.core.compiler_lock import global_compiler_lock

    with global_compiler_lock, _nothing_is_loaded():
        _NOW.making = True
        try:
            with _nothing_is_optimised():
                whole.compile(signature)
        finally:
            _NOW.making = False
        result = whole.overloads[signature]
        library = result.library
        library.finalize()  # links and optimises
        return result, library.codegen._tm.emit_object(library._final_module)


def _nothing_is_loaded() -> ExitStack:
    """Within it numba makes no machine code of a library, and loads none into the process."""
    from numba.core.codegen import JITCodeLibrary, JITCPUCodegen

    within = ExitStack()
    within.enter_context(_instead(JITCodeLibrary, "get_pointer_to_function", lambda *_: 0))
    within.enter_context(_instead(JITCodeLibrary, "_finalize_specific", lambda *_: None))
    within.enter_context(_instead(JITCPUCodegen, "_add_module", lambda *_: None))
    within.enter_context(_instead(JITCPUCodegen, "set_env", lambda *_: None))
    return within


def _nothing_is_optimised() -> Any:
    """Within it numba links the parts of a library, but does not optimise what comes of it."""
    from numba.core.codegen import JITCodeLibrary

    return _instead(JITCodeLibrary, "_optimize_final_module", lambda *_: None)


@contextmanager
def _instead(owner: type, name: str, stand_in: Callable[..., Any]) -> Iterator[None]:
    """Put a function in the place of a method, for a while."""
    if not hasattr(owner, name):
        raise NotImplementedError(f"numba's {owner.__name__} has no {name}")
    own = vars(owner).get(name)  # None: of a class above
    setattr(owner, name, stand_in)
    try:
        yield
    finally:
        if own is None:
            delattr(owner, name)
        else:
            setattr(owner, name, own)
