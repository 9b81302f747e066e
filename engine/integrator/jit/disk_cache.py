"""Compiled kernels on disk, each in a file (`engine.foundations.cache_files`).

Numba's own cache loads whatever it finds: a truncated file ends the program, an altered one may compute anything, and two
processes that compile at once can load each other's code. Here the name of a file contains a hash of everything its code depends
on.

Numba has no public interface for caches, so this module uses internal names of numba 0.68, which may change with any version:

- ``Dispatcher._cache``, set in `engine.integrator.jit.decorator`: the cache that a function asks before it compiles;
- ``numba.core.caching._Cache``: the abstract base class of such caches, which declares the methods;
- ``CompileResult._reduce`` and ``CompileResult._rebuild``: compiled code to and from objects that can be pickled;
- ``numba.core.serialize.dumps``: Numba's pickling of these objects;
- ``library.has_dynamic_globals``: whether code contains addresses that are valid in this process only;
- ``codegen.magic_tuple()``: the target, processor and its features that code was compiled for;
- ``rtsys.initialize()``: prepares the memory management that the loaded code needs.
"""

from __future__ import annotations

import functools
import hashlib
import logging
import pickle
import sys
from collections.abc import Callable
from functools import partial
from importlib import import_module, metadata
from pathlib import Path
from typing import Any

from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.runtime.nrt import rtsys
from numba.core.serialize import dumps

from engine.foundations.cache_files import SUFFIX, cache_folder, delete_cached, read_cached, write_cached

PACKAGE = Path(__file__).parents[1]
"""Where all source is that compiled kernels contain copies of."""

DEFINE = "define"
"""Name in a generated module of a function that defines it, for another process."""

log = logging.getLogger(__name__)

_other_process: Callable[[Callable[[], None]], None] | None = None


def compile_in(process: Callable[[Callable[[], None]], None] | None) -> None:
    """Let another process compile, which shares the cache: what Numba needs for it, and keeps of it, is never in this one.

    Parameters
    ----------
    process
        Makes a call in the other process, to which cloudpickle can send it, and raises ValueError if it cannot; None for this
        process.
    """
    global _other_process
    _other_process = process


class KernelCache(_Cache):
    """The cache of one function, called by Numba before and after compilation.

    If the folder or a file cannot be used, a warning is logged and the function is compiled.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._module, self._function = function.__module__, function.__qualname__
        self._name = f"{self._module}.{self._function}"
        self._source = _hash_package(PACKAGE) + _hash_source(function.__code__.co_filename) + function.__code__.co_code.hex()

    @property
    def cache_path(self) -> str:
        """The folder."""
        return str(cache_folder())

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The code for arguments of some types; None if there is no valid file."""
        # Running machine code needs Numba's memory management only; loading all that it can compile takes a second.
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
        """Let another process compile, if there is one; None if it cannot, so that this one does."""
        if _other_process is None:
            return None
        module = sys.modules[self._module]
        try:
            _other_process(partial(_compile, getattr(module, DEFINE, None), self._module, self._function, sig))
        except ValueError as error:
            log.warning("%s is compiled in this process: %s", self._name, error)
        return read_cached(path)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Store the code if possible."""
        if data.library.has_dynamic_globals:
            return
        payload: bytes = dumps(data._reduce())  # type: ignore[no-untyped-call]
        write_cached(self._path(sig, data.codegen), payload)

    def enable(self) -> None:
        """Does nothing: the cache is always enabled."""

    def disable(self) -> None:
        """Does nothing: the cache is always enabled."""

    def flush(self) -> None:
        """Delete the function's files."""
        delete_cached(self._name)

    def _path(self, signature: Any, codegen: Any) -> Path:
        """Named after argument types, processor, source and versions, so that the content of a file never changes."""
        key = repr((signature, codegen.magic_tuple(), self._source, _versions()))
        return cache_folder() / f"{self._name}.{hashlib.sha256(key.encode()).hexdigest()[:24]}{SUFFIX}"


def _compile(define: Callable[[], object] | None, module: str, function: str, signature: Any) -> None:
    """Compile a function and store the code; in the other process."""
    if define is not None:
        define()
    getattr(import_module(module), function).compile(signature)


@functools.cache
def _hash_source(file: str) -> str:
    """Hash of a source file; empty for generated source, whose module name contains its hash."""
    path = Path(file)
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""


@functools.cache
def _hash_package(folder: Path) -> str:
    """Hashes of all source files in a package and its subpackages: a kernel contains copies of kernels and constants it names."""
    return "".join(_hash_source(str(path)) for path in sorted(folder.rglob("*.py")))


@functools.cache
def program_digest() -> str:
    """A hash of the sources of the kernels and of the versions of what compiles them."""
    return hashlib.sha256(repr((_hash_package(PACKAGE), _versions())).encode()).hexdigest()[:24]


@functools.cache
def _versions() -> tuple[str, ...]:
    return (sys.version, *(metadata.version(package) for package in ("numba", "llvmlite", "numpy")))
