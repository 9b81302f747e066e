"""Compiled kernels, bound to the coefficients of a potential.

All potentials of the same structure share generated functions (`engine.integrator.source`), and all potentials share the kernels
that call them (`engine.integrator.kernels`). Each potential has callables that pass its coefficients and the addresses of its
generated functions.
"""

from __future__ import annotations

import functools
import inspect
import linecache
import sys
import threading
from collections.abc import Hashable
from functools import partial
from types import ModuleType
from typing import Any

import numpy as np
from numba.core.dispatcher import Dispatcher

from engine.expressions.graph import make_graph
from engine.expressions.nodes import Expression
from engine.integrator.jit.compiled_operations import compiled_operations
from engine.integrator.jit.decorator import kernel
from engine.integrator.jit.disk_cache import DEFINE
from engine.integrator.jit.function_pointers import SIGNATURES
from engine.integrator.jit.llvm_emitter import straight_line, table_reader
from engine.integrator.kernels import fixed_step, interior, orbit_lanes, periodic_shooting, propagate
from engine.integrator.source.recurrence import Definition, GeneratedCode, Structure, find_structure, generate
from engine.integrator.source.series import Setting

_KERNEL_MODULES = (propagate, periodic_shooting, fixed_step, orbit_lanes, interior)
# Number of potentials whose bound kernels are cached. Binding another potential of a known structure takes milliseconds.
_BOUND_POTENTIALS = 256
# Held while code is generated.
_lock = threading.Lock()
# Code, module name and functions of each structure. Entries stay, because machine code is never unloaded.
_code_by_structure: dict[Structure, tuple[GeneratedCode, str, dict[str, CompiledFunction]]] = {}
# Outlines (see `_outline`) and settings of all potentials for which functions were generated.
_outlines: set[tuple[Hashable, Setting]] = set()


@functools.lru_cache(maxsize=_BOUND_POTENTIALS)
def load_kernels(definition: Definition, setting: Setting, rotation: float = 0.0) -> ModuleType:
    """Return the kernels of a potential: ``step``, ``fixed_step``, ``jets``, ``tangent``, ``propagate``, ``shoot``, …

    Parameters
    ----------
    definition
        ((i, j, c), …) of V = Σ c x^i y^j, or an expression.
    setting
        The facts besides V on which the generated code depends.
    rotation
        Ω of the frame, finite, dimensionless; 0 unless ``setting.rotates``.

    Returns
    -------
    A module with these functions. Call them without the leading addresses and without `coefficients`. The first use of a kernel
    for this structure loads the generated functions that it calls from the cache, or compiles them within some seconds.
    """
    code, module_name, generated_functions = _find_or_generate(find_structure(definition, setting))
    _outlines.add((_outline(definition), setting))
    coefficients = code.tabulate(definition, rotation)
    bound_module = ModuleType(module_name)
    for name, function in generated_functions.items():
        setattr(bound_module, name, _BoundKernel(function, (), coefficients))
    for module in _KERNEL_MODULES:
        for name, function in vars(module).items():
            if isinstance(function, Dispatcher) and function.py_func.__module__ == module.__name__:
                # Parameters for addresses have the names of the generated functions.
                parameters = inspect.signature(function.py_func).parameters
                callees = tuple(generated_functions[each] for each in parameters if each in generated_functions)
                # Kernels without such parameters depend on no potential.
                if callees:
                    setattr(bound_module, name, _BoundKernel(function, callees, coefficients))
    return bound_module


def is_generated(definition: Definition, setting: Setting) -> bool:
    """Return whether functions were generated for the structure of a potential. Generating them takes up to 0.3 s."""
    # Outlines are compared first, because finding the structure of a new formula takes up to 0.2 s.
    return (_outline(definition), setting) in _outlines and find_structure(definition, setting) in _code_by_structure


class CompiledFunction:
    """The machine code of a generated function, compiled at its first use, for the types in `SIGNATURES` only."""

    def __init__(self, dispatcher: Any) -> None:
        self._dispatcher = dispatcher
        self._signature = SIGNATURES[dispatcher.__name__]
        self._address: int | None = None
        self._compiling = threading.Lock()

    @property
    def signatures(self) -> list[Any]:
        """Argument types compiled so far."""
        return list(self._dispatcher.signatures)

    @property
    def address(self) -> int:
        """Address of the machine code, for calls from other kernels."""
        return self._ensure_compiled() if self._address is None else self._address

    def _ensure_compiled(self) -> int:
        """Compile the function unless it is compiled, and return the address of the machine code."""
        if self._address is None:
            with self._compiling:
                if self._address is None:
                    self._address = self._compile()
        return self._address

    def _compile(self) -> int:
        self._dispatcher.compile(self._signature)
        self._dispatcher.disable_compile()
        result = self._dispatcher.get_compile_result(self._signature)
        return result.library.get_pointer_to_function(result.fndesc.llvm_func_name)

    @property
    def py_func(self) -> Any:
        """The Python function; code compiled from it can be inspected, unlike code from the cache."""
        return self._dispatcher.py_func

    def __call__(self, *arguments: Any) -> Any:
        """Call the function with arguments that can be cast to the types of its signature; TypeError for other arguments."""
        self._ensure_compiled()
        return self._dispatcher(*arguments)


class _BoundKernel:
    """Calls a kernel with the addresses of generated functions and the coefficients of one potential as first arguments."""

    def __init__(self, function: Any, callees: tuple[CompiledFunction, ...], coefficients: np.ndarray) -> None:
        self.function = function
        self._callees = callees
        self._coefficients = coefficients

    @property
    def signatures(self) -> list[Any]:
        """Argument types compiled so far."""
        return list(self.function.signatures)

    def __call__(self, *arguments: Any) -> Any:
        return self.function(*(callee.address for callee in self._callees), self._coefficients, *arguments)


def _find_or_generate(structure: Structure) -> tuple[GeneratedCode, str, dict[str, CompiledFunction]]:
    """Return the entry of `_code_by_structure`, made if it is missing. For a known structure, a thread never waits for others."""
    if structure not in _code_by_structure:
        with _lock:
            if structure not in _code_by_structure:
                code = generate(structure)
                _code_by_structure[structure] = code, *_define_module(code)
    return _code_by_structure[structure]


def _outline(definition: Definition) -> Hashable:
    """Return a quick key that identifies most structures: the powers of a polynomial, or the graph of an expression."""
    return make_graph((definition,))[0] if isinstance(definition, Expression) else frozenset((i, j) for i, j, _ in definition)


@functools.cache
def _define_module(code: GeneratedCode) -> tuple[str, dict[str, CompiledFunction]]:
    """Execute generated source as a module named after its hash. Return this name, and the functions, not compiled yet."""
    compiled_operations.add(code.digest, code.operations)
    name = f"kernels_{code.digest[:16]}"
    module = ModuleType(name)
    # Numba finds the module of a kernel here when it loads the kernel from the cache.
    sys.modules[name] = module
    source = "\n\n".join(function.kernel for function in code.functions)
    # Numba reads the source of a function through this cache.
    linecache.cache[f"<{name}>"] = (len(source), None, source.splitlines(keepends=True), f"<{name}>")
    programs = {function.program.name: straight_line(function.program) for function in code.functions}
    vars(module).update(kernel=kernel, read_table=table_reader(len(code.entries)), **programs)
    setattr(module, DEFINE, partial(_define_module, code))
    exec(compile(source, f"<{name}>", "exec"), vars(module))
    return name, {function.name: CompiledFunction(getattr(module, function.name)) for function in code.functions}
