"""Calls of generated functions by address, from kernels that are compiled once for all potentials.

A kernel that calls a function by name contains a copy of this function, and would have to be compiled again for every structure
of a potential. Kernels therefore take the addresses of `step`, `limited_step`, `jets`, `tangent`, `potential_value` and
`potential_slopes` as arguments, and contain only the types of these functions.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class _Call:
    """A function for use in kernels that calls the generated function of a name, given its address and its arguments."""

    name: str

    @property
    def _numba_type_(self) -> Any:
        # Numba is imported when a kernel is compiled, see `engine.integrator.jit.decorator`.
        from engine.integrator.jit.function_types import find_call_type

        return find_call_type(self.name)


call_step: Any = _Call("step")
call_limited_step: Any = _Call("limited_step")
call_jets: Any = _Call("jets")
call_tangent: Any = _Call("tangent")
call_potential_value: Any = _Call("potential_value")
call_potential_slopes: Any = _Call("potential_slopes")
