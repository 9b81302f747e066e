"""Points of a potential, stored on disk beside the compiled kernels, because a search takes time and SciPy loads slowly."""

from __future__ import annotations

import functools
import hashlib
import io
from collections.abc import Callable
from importlib import metadata
from pathlib import Path

import numpy as np

from engine.foundations.cache_files import SUFFIX, cache_folder, read_or_make


def stored_points(kind: str, form: object, find: Callable[[], np.ndarray]) -> np.ndarray:
    """Return the result of `find`, from a file if the same version has computed the result before on this machine.

    Parameters
    ----------
    kind
        The kind of points, used in the name of the file.
    form
        The object on which the result depends. Equal results of `repr` stand for equal objects.
    find
        Computes the array of numbers or flags. Errors are raised and not stored.
    """
    key = repr((form, _versions()))
    path = cache_folder() / f"{kind}.{hashlib.sha256(key.encode()).hexdigest()[:24]}{SUFFIX}"
    return np.load(io.BytesIO(read_or_make(path, "points", lambda: _to_bytes(find()))), allow_pickle=False)


def _to_bytes(points: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, points, allow_pickle=False)
    return buffer.getvalue()


@functools.cache
def _versions() -> tuple[str, ...]:
    """Return hashes of the modules that find points, and versions of the libraries."""
    engine = Path(__file__).parents[2]
    packages = (engine / "expressions", engine / "systems" / "forms", engine / "systems" / "landscape")
    files = [file for package in packages for file in sorted(package.glob("*.py"))]
    sources = (hashlib.sha256(file.read_bytes()).hexdigest() for file in files)
    return (*sources, *(metadata.version(package) for package in ("numpy", "scipy", "python-flint")))
