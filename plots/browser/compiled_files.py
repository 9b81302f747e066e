"""Files for browsers that are compiled in advance and belong to the program, so that its server need not compile them first.

The files are the kernels and, for each system of the catalogue, its module and its data. `plots.browser.compile_catalogue` makes
them. They are read only while the sources of the kernels are those from which the files were made.
"""

from __future__ import annotations

import functools
import gzip
import hashlib
from collections.abc import Mapping
from pathlib import Path

from engine.integrator.portable_kernels import kernel_module

FOLDER = Path(__file__).with_name("compiled")
"""Folder of the files."""

KERNELS = "kernels.wasm"
"""Name of the file of the kernels."""

_ROOT = Path(__file__).parents[2]
# Packages whose sources determine the kernels and the functions of a system, and the file with the hash of these sources.
_SOURCES, _DIGEST = ("engine/expressions", "engine/integrator"), "sources.sha256"
# The installed sources import each other below a namespace, which the hash leaves out: "escape_explorer.", in the repository "".
_NAMESPACE = __name__.removesuffix("plots.browser.compiled_files")


@functools.cache
def source_digest() -> str:
    """Return a hash of the sources of the kernels. Unlike the names of cached files, it depends on no version of a compiler."""
    digest = hashlib.sha256()
    for folder in _SOURCES:
        for path in sorted((_ROOT / folder).rglob("*.py")):
            digest.update(path.read_text(encoding="utf-8").replace(_NAMESPACE, "").encode())
    return digest.hexdigest()


def has_compiled(name: str) -> bool:
    """Whether there is a file of a name that was made from the present sources."""
    return _is_current() and _path(name).is_file()


def read_compiled(name: str) -> bytes | None:
    """Return the content of a file; None if it is missing or was made from other sources."""
    return gzip.decompress(_path(name).read_bytes()) if has_compiled(name) else None


def write_compiled(contents: Mapping[str, bytes]) -> None:
    """Replace all files by files with the given contents, by name."""
    FOLDER.mkdir(exist_ok=True)
    for path in FOLDER.iterdir():
        path.unlink()
    for name, content in contents.items():
        # Without a time in the file, equal contents make equal files.
        _path(name).write_bytes(gzip.compress(content, mtime=0))
    (FOLDER / _DIGEST).write_text(f"{source_digest()}\n", encoding="utf-8")


def browser_kernels() -> bytes:
    """Return the kernels for browsers, from the file or else compiled, which takes seconds."""
    return read_compiled(KERNELS) or kernel_module()


def _path(name: str) -> Path:
    return FOLDER / f"{name}.gz"


@functools.cache
def _is_current() -> bool:
    """Whether the files were made from the present sources."""
    path = FOLDER / _DIGEST
    return path.is_file() and path.read_text(encoding="utf-8").strip() == source_digest()
