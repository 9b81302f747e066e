"""Compiled kernels on disk, from one run to the next: each in a file that is whole, or not taken.

Numba's own cache takes what it finds: a file that was cut short ends the program, one that was altered may compute anything, and
two processes that compile at once can take each other's code. Here a file is named after all that its code depends on,
appears at once, and carries its own hash.
"""

from __future__ import annotations

import functools
import hashlib
import logging
import os
import pickle
import sys
import tempfile
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

import platformdirs
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

CACHE_VARIABLE = "ESCAPE_EXPLORER_CACHE"
"""Environment variable that names the folder for compiled kernels, instead of the user's cache folder."""

ENDING = ".kernel"
"""Of the files' names."""

_HASH_BYTES = hashlib.sha256().digest_size

log = logging.getLogger(__name__)


def cache_folder() -> Path:
    """The folder for compiled kernels; it need not be there."""
    return Path(os.environ.get(CACHE_VARIABLE) or platformdirs.user_cache_path("escape-explorer")) / "kernels"


class KernelCache(_Cache):
    """What Numba asks for a function's machine code, and hands it to.

    Whatever is wrong with the folder or with a file, the function is compiled, and a sentence goes to the log.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._name = f"{function.__module__}.{function.__qualname__}"
        self._source = _hash_package() + _hash_source(function.__code__.co_filename) + function.__code__.co_code.hex()

    @property
    def cache_path(self) -> str:
        """The folder."""
        return str(cache_folder())

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The code for arguments of some types; None where there is none of use."""
        target_context.refresh()
        path = self._path(sig, target_context.codegen())
        try:
            content = path.read_bytes()
            payload = content[_HASH_BYTES:]
            if hashlib.sha256(payload).digest() != content[:_HASH_BYTES]:
                raise ValueError("it is not what was written")
            return CompileResult._rebuild(target_context, *pickle.loads(payload))  # type: ignore[no-untyped-call]
        except FileNotFoundError:
            return None
        except Exception as error:
            log.warning("the compiled kernel %s is of no use (%s); it is compiled again", path, error)
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the code, if that can be done."""
        if data.library.has_dynamic_globals:
            return
        payload: bytes = dumps(data._reduce())  # type: ignore[no-untyped-call]
        path = self._path(sig, data.codegen)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            _write_atomically(path, hashlib.sha256(payload).digest() + payload)
        except OSError as error:
            _warn_once(f"compiled kernels cannot be kept in {path.parent}, so each start compiles them again: {error.strerror}")

    def enable(self) -> None:
        """Part of Numba's interface; this cache is never off."""

    def disable(self) -> None:
        """Part of Numba's interface; this cache is never off."""

    def flush(self) -> None:
        """Forget what is kept."""
        for path in cache_folder().glob(f"{self._name}.*{ENDING}"):
            path.unlink(missing_ok=True)

    def _path(self, signature: Any, codegen: Any) -> Path:
        """Named after types, machine, source and versions, so that a file never has to hold anything else than it did."""
        key = repr((signature, codegen.magic_tuple(), self._source, _versions()))
        return cache_folder() / f"{self._name}.{hashlib.sha256(key.encode()).hexdigest()[:24]}{ENDING}"


@functools.cache
def _hash_source(file: str) -> str:
    """Of a source file; nothing for generated source, whose module is named after it."""
    path = Path(file)
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""


@functools.cache
def _hash_package() -> str:
    """Hash of all source of `engine.taylor`: a kernel holds copies of the kernels and constants that it names."""
    package = Path(__file__).parents[1]
    return "".join(_hash_source(str(path)) for path in sorted(package.rglob("*.py")))


@functools.cache
def _versions() -> tuple[str, ...]:
    return (sys.version, *(metadata.version(package) for package in ("numba", "llvmlite", "numpy")))


@functools.cache
def _warn_once(sentence: str) -> None:
    log.warning(sentence)


def _write_atomically(path: Path, content: bytes) -> None:
    handle, part = tempfile.mkstemp(dir=path.parent, suffix=".part")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.replace(part, path)
    except BaseException:
        Path(part).unlink(missing_ok=True)
        raise
