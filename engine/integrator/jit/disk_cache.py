"""A cache of compiled kernels on disk, with one file for each kernel and signature (`engine.foundations.cache_files`).

Numba's own cache loads any file without a check: a truncated file ends the program, a modified file may compute anything, and two
processes that compile at the same time can load each other's code. `cache_files` writes a file in one step and checks each file
that it reads. The name of a file contains a hash of everything on which its code depends.

Numba has no public interface for caches, so this module uses internal names of numba 0.68, which may change with any version:

- ``Dispatcher._cache``, set in `engine.integrator.jit.decorator`: the cache that a function asks before it compiles;
- ``numba.core.caching._Cache``: the abstract base class of such caches, which declares the methods;
- ``CompileResult._reduce`` and ``CompileResult._rebuild``: compiled code to and from objects that can be pickled, the first of
  which contains machine code and LLVM instructions;
- ``numba.core.serialize.dumps``: Numba's pickling of these objects;
- ``library.has_dynamic_globals``: whether code contains addresses that are valid in this process only;
- ``codegen.magic_tuple()``: the target, the processor and its features for which code was compiled;
- ``rtsys.initialize()``: prepares the memory management that the loaded code needs.
"""

from __future__ import annotations

import hashlib
import logging
import pickle
import sys
from collections.abc import Callable
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm  # type: ignore[import-untyped]
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.runtime.nrt import rtsys
from numba.core.serialize import dumps

from engine.foundations.cache_files import SUFFIX, cache_folder, delete_cached, read_cached, write_cached
from engine.integrator.jit.compiling_process import DEFINE, call_compiler, compiles_here
from engine.integrator.jit.source_digests import compiler_versions

log = logging.getLogger(__name__)


class KernelCache(_Cache):
    """The cache of one function, called by Numba before and after compilation.

    If the folder or a file cannot be used, a warning is logged and the function is compiled.
    """

    def __init__(self, function: Callable[..., Any], source_hash: str) -> None:
        self._module_name, self._function_name = function.__module__, function.__qualname__
        self._name = f"{self._module_name}.{self._function_name}"
        self._source_hash = source_hash

    @property
    def cache_path(self) -> str:
        """The folder with the files of the cache."""
        return str(cache_folder())

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the compiled code for a signature; None if there is no valid file, so that Numba compiles."""
        # Compiled code needs only Numba's memory management; loading the rest of Numba's targets takes a second.
        rtsys.initialize(target_context)
        path = self._path(sig, target_context.codegen())
        try:
            payload = read_cached(path) or self._compile_elsewhere(sig, path)
            if payload is None:
                return None
            return CompileResult._rebuild(target_context, *pickle.loads(payload))  # type: ignore[no-untyped-call]
        except Exception as error:
            log.warning("invalid compiled kernel %s: %s; compiling it again", path, error)
            return None

    def _compile_elsewhere(self, sig: Any, path: Path) -> bytes | None:
        """Compile in the other process and return the content of the file; None if this process has to compile."""
        if compiles_here():
            return None
        define = getattr(sys.modules[self._module_name], DEFINE, None)
        try:
            call_compiler(partial(_compile, define, self._module_name, self._function_name, sig))
        except ValueError as error:
            log.warning("%s is compiled in this process: %s", self._name, error)
        return read_cached(path)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Store the code, unless it contains addresses of this process."""
        if data.library.has_dynamic_globals:
            return
        code, *rest = data._reduce()
        if self._is_generated:
            code = _without_instructions(code)
        payload: bytes = dumps((code, *rest))  # type: ignore[no-untyped-call]
        write_cached(self._path(sig, data.codegen), payload)

    @property
    def _is_generated(self) -> bool:
        """Whether other kernels call the function by its address only."""
        return hasattr(sys.modules[self._module_name], DEFINE)

    def enable(self) -> None:
        """Do nothing: the cache is always enabled."""

    def disable(self) -> None:
        """Do nothing: the cache is always enabled."""

    def flush(self) -> None:
        """Delete the function's files."""
        delete_cached(self._name)

    def _path(self, signature: Any, codegen: Any) -> Path:
        """Return the path for a signature. The path also depends on processor, source and versions, so the file never changes."""
        key = repr((signature, codegen.magic_tuple(), self._source_hash, compiler_versions()))
        return cache_folder() / f"{self._name}.{hashlib.sha256(key.encode()).hexdigest()[:24]}{SUFFIX}"


def _without_instructions(code: Any) -> Any:
    """Return code without the LLVM instructions from which Numba could compile it into other kernels.

    In a process that loads the code, the instructions would take eight times as much memory as everything else. The names that
    they define are kept, because Numba looks for the addresses of these names only.
    """
    name, kind, (machine_code, instructions) = code
    module = llvm.parse_bitcode(instructions)
    names = [each.name for each in (*module.functions, *module.global_variables) if not each.is_declaration]
    definitions = "\n".join(f'@"{defined}" = global ptr null' for defined in names)
    return name, kind, (machine_code, llvm.parse_assembly(definitions).as_bitcode())


def _compile(define: Callable[[], object] | None, module: str, function: str, signature: Any) -> None:
    """Compile a function and store its code; called in the other process."""
    if define is not None:
        define()
    getattr(import_module(module), function).dispatcher.compile(signature)
