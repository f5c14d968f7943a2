"""Shape faults: what numba raises where an array is put into a slice of another shape, without its shapes.

numba names both shapes in the message. To put numbers together to a text takes it half a second of compiling,
in each kernel that puts an array into a slice: 15 s of the 231 s that all kernels took. A kernel that raises
this is broken, and its plain function (`py_func`) tells the shapes.

Signals: none; `short` changes numba in this process, before a kernel is compiled. Where numba has no such
names its own message stays.

Source: our own; numba.np.arrayobj, `fancy_setslice`.
"""

from __future__ import annotations

from contextlib import suppress
from functools import cache
from typing import Any


@cache
def short() -> None:
    """Have numba raise the message that it has for processors without texts."""
    from numba.extending import overload
    from numba.np import arrayobj

    def raise_with_shape_context(src_shapes: Any, index_shape: Any) -> None:
        raise NotImplementedError  # numba compiles what stands for it below

    with suppress(AttributeError):
        overload(raise_with_shape_context)(arrayobj.ol_raise_with_shape_context_generic)
        arrayobj.raise_with_shape_context = raise_with_shape_context
