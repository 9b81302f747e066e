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
from collections.abc import Iterable
from functools import partial
from types import ModuleType
from typing import Any

import numpy as np

from engine.integrator.jit.code_outlines import find_outline
from engine.integrator.jit.compiled_operations import compiled_operations
from engine.integrator.jit.compiling_process import DEFINE
from engine.integrator.jit.decorator import Kernel, kernel
from engine.integrator.kernels import interior, limited_steps, orbit_lanes, periodic_shooting, propagate
from engine.integrator.source.recurrence import CodeOutline, Definition, Structure, find_structure, generate_code
from engine.integrator.source.series import Setting
from engine.integrator.source.straight_line import StraightLine

_KERNEL_MODULES = (propagate, periodic_shooting, limited_steps, orbit_lanes, interior)
# Number of potentials whose bound kernels are cached. Binding another potential of a known structure takes milliseconds.
_CACHED_POTENTIALS = 256
# Held while code is generated.
_generation_lock = threading.Lock()
# Outline and functions of the code of each structure. Entries stay, because machine code is never unloaded.
_code_by_structure: dict[Structure, tuple[CodeOutline, dict[str, CompiledFunction]]] = {}


@functools.lru_cache(maxsize=_CACHED_POTENTIALS)
def load_kernels(definition: Definition, setting: Setting, rotation: float = 0.0) -> ModuleType:
    """Return the kernels of a potential: ``step``, ``limited_step``, ``jets``, ``tangent``, ``propagate``, ``shoot``, …

    Parameters
    ----------
    definition
        Terms ((i, j, c), …) of the polynomial V = Σ c x^i y^j, dimensionless, or an expression.
    setting
        The facts besides V on which the generated code depends.
    rotation
        Ω of the frame, finite, dimensionless; 0 unless ``setting.rotates``.

    Returns
    -------
    A module with these functions, bound to the potential: they are called without the leading addresses and `coefficients`. The
    first use of a kernel for this structure loads the generated functions that it calls from the disk cache, or compiles them,
    which takes seconds.
    """
    outline, functions = _find_or_generate(find_structure(definition, setting._replace(section=None)))
    coefficients = outline.tabulate(definition, rotation)
    if setting.section is not None:
        # The section has an influence on the step alone, which reads the same coefficients.
        _, own = _find_or_generate(find_structure(definition, setting))
        functions = functions | own
    bound_module = ModuleType(_module_name(outline))
    for name, function in functions.items():
        setattr(bound_module, name, _BoundKernel(function, (), coefficients))
    _bind_kernels(bound_module, functions, coefficients)
    return bound_module


def is_compiled(structure: Structure, names: Iterable[str]) -> bool:
    """Return whether kernels with these names are compiled for the potentials of a structure."""
    if structure not in _code_by_structure:
        return False
    _, functions = _code_by_structure[structure]
    kernels: dict[str, Any] = {**_shared_kernels(), **functions}
    return all(kernels[name].signatures for name in names)


class CompiledFunction:
    """A generated function that is compiled on first use, for the types in `SIGNATURES`."""

    def __init__(self, function: Kernel) -> None:
        self._function = function
        self._address: int | None = None
        self._lock = threading.Lock()

    @property
    def signatures(self) -> list[Any]:
        """Argument types for which the function has been compiled."""
        return self._function.signatures

    @property
    def address(self) -> int:
        """Address of the machine code, for calls from other kernels. The first use compiles the function."""
        if self._address is None:
            with self._lock:
                if self._address is None:
                    self._address = self._compile()
        return self._address

    def _compile(self) -> int:
        """Compile the function, and return the address of its machine code."""
        # Numba is imported at the first use of a kernel.
        from engine.integrator.jit.function_types import SIGNATURES

        dispatcher, signature = self._function.dispatcher, SIGNATURES[self.py_func.__name__]
        dispatcher.compile(signature)
        dispatcher.disable_compile()
        result = dispatcher.get_compile_result(signature)
        return result.library.get_pointer_to_function(result.fndesc.llvm_func_name)

    @property
    def py_func(self) -> Any:
        """The Python function; code compiled from it can be inspected, unlike code from the cache."""
        return self._function.py_func

    def __call__(self, *arguments: Any) -> Any:
        """Call the function. Raises TypeError if the arguments cannot be cast to the types of its signature."""
        # The first use of the address compiles the function.
        _ = self.address
        return self._function(*arguments)


class _BoundKernel:
    """Calls a kernel with the addresses of generated functions and the coefficients of one potential as first arguments."""

    def __init__(self, function: Any, callees: tuple[CompiledFunction, ...], coefficients: np.ndarray) -> None:
        self.function = function
        self._callees = callees
        self._coefficients = coefficients

    @property
    def signatures(self) -> list[Any]:
        """Argument types for which the kernel has been compiled."""
        return list(self.function.signatures)

    def __call__(self, *arguments: Any) -> Any:
        return self.function(*(callee.address for callee in self._callees), self._coefficients, *arguments)


def _bind_kernels(bound_module: ModuleType, functions: dict[str, CompiledFunction], coefficients: np.ndarray) -> None:
    """Add the kernels that call generated functions to the module of a potential."""
    for name, function in _shared_kernels().items():
        # Parameters for addresses have the names of the generated functions.
        parameters = inspect.signature(function.py_func).parameters
        callees = tuple(functions[each] for each in parameters if each in functions)
        # Kernels without such parameters depend on no potential.
        if callees:
            setattr(bound_module, name, _BoundKernel(function, callees, coefficients))


@functools.cache
def _shared_kernels() -> dict[str, Kernel]:
    """Return the kernels that all potentials share, by name."""
    return {
        name: function
        for module in _KERNEL_MODULES
        for name, function in vars(module).items()
        if isinstance(function, Kernel) and function.py_func.__module__ == module.__name__
    }


def _find_or_generate(structure: Structure) -> tuple[CodeOutline, dict[str, CompiledFunction]]:
    """Return the entry of `_code_by_structure`, made if it is missing. For a known structure, no thread waits for the lock."""
    if structure not in _code_by_structure:
        with _generation_lock:
            if structure not in _code_by_structure:
                outline = find_outline(structure)
                _code_by_structure[structure] = outline, _define_functions(outline)
    return _code_by_structure[structure]


def _module_name(outline: CodeOutline) -> str:
    """Return the name of the module of generated functions."""
    return f"kernels_{outline.digest[:16]}"


@functools.cache
def _define_functions(outline: CodeOutline) -> dict[str, CompiledFunction]:
    """Define a module of generated functions, which are not compiled yet, and return the functions."""
    from engine.integrator.jit.llvm_emitter import straight_line, table_reader

    compiled_operations.add(outline.digest, outline.operations)
    name = _module_name(outline)
    module = ModuleType(name)
    # Numba finds the module of a kernel here when it loads the kernel from the cache.
    sys.modules[name] = module
    source = "\n\n".join(source for _, _, source in outline.sources)
    # Numba reads the source of a function through this cache.
    linecache.cache[f"<{name}>"] = (len(source), None, source.splitlines(keepends=True), f"<{name}>")
    programs = {program: straight_line(partial(_find_program, outline.structure, program)) for _, program, _ in outline.sources}
    vars(module).update(kernel=kernel, read_table=table_reader(len(outline.entries)), **programs)
    setattr(module, DEFINE, partial(_define_functions, outline))
    exec(compile(source, f"<{name}>", "exec"), vars(module))
    return {function: CompiledFunction(getattr(module, function)) for function, _, _ in outline.sources}


def _find_program(structure: Structure, name: str) -> StraightLine:
    """Return a program of the generated functions of a structure. Programs take megabytes, so they are not kept."""
    return next(function.program for function in generate_code(structure).functions if function.program.name == name)
