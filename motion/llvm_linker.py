"""llvmlite's linker, for object code that is not placed by ourselves (`placed_code`): of other machines.

Signals in: object code, addresses by names. Signals out: what tells the addresses of functions in it.

Source: llvmlite's MCJIT. Questions: none.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import cast

import llvmlite.binding as llvm


class LlvmLinker:
    """LLVM's own linker, which finds these names, and those of the process."""

    def __init__(self, addresses: Mapping[str, int]) -> None:
        """Begin with the addresses of names that object code asks for."""
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
        for name, address in addresses.items():
            llvm.add_symbol(name, address)
        triple = llvm.get_process_triple()
        machine = llvm.Target.from_triple(triple).create_target_machine(
            jit=True, cpu=llvm.get_host_cpu_name()
        )
        empty = llvm.parse_assembly(f'target triple = "{triple}"')
        self._engine = llvm.create_mcjit_compiler(empty, machine)

    def placed(self, code: bytes) -> Callable[[str], int]:
        """Put object code where it can run; give what tells addresses by names, 0 of what is not there."""
        self._engine.add_object_file(llvm.ObjectFileRef.from_data(code))
        self._engine.finalize_object()
        return cast("Callable[[str], int]", self._engine.get_global_value_address)
