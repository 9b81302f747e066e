"""Hashes of everything on which compiled code depends: the sources of the kernels, and the versions of the compilers."""

from __future__ import annotations

import functools
import hashlib
import sys
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

PACKAGE = Path(__file__).parents[1]
"""The package that contains all source compiled into kernels."""


def hash_function(function: Callable[..., Any]) -> str:
    """Return the hashes of the package, of the source file of a function, and of its code."""
    return hash_package(PACKAGE) + _hash_source(function.__code__.co_filename) + function.__code__.co_code.hex()


@functools.cache
def hash_package(folder: Path) -> str:
    """Return the hashes of all source files in a package, because a kernel contains code and constants of other modules."""
    return "".join(_hash_source(str(path)) for path in sorted(folder.rglob("*.py")))


@functools.cache
def program_digest() -> str:
    """Return a hash of the sources of the kernels and of the versions of the compilers."""
    return hashlib.sha256(repr((hash_package(PACKAGE), compiler_versions())).encode()).hexdigest()[:24]


@functools.cache
def compiler_versions() -> tuple[str, ...]:
    """Return the versions of Python, Numba, llvmlite and NumPy."""
    return (sys.version, *(metadata.version(package) for package in ("numba", "llvmlite", "numpy")))


@functools.cache
def _hash_source(file: str) -> str:
    """Return the hash of a source file; empty for generated source, because the name of its module contains the hash."""
    path = Path(file)
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""
