"""The versions on which results and reports depend."""

from __future__ import annotations

import platform
import re
import sys
from collections.abc import Iterable
from importlib import metadata

from engine.foundations.cache_files import cache_folder
from engine.foundations.execution import count_cores

_PROGRAM = "escape-explorer"
# The compiler of Numba, on which rounding may depend. It is no direct dependency.
_COMPILER = "llvmlite"


def show_versions() -> None:
    """Print the versions of the program, of Python and of all dependencies, and facts of the computer, for reports of errors.

    The facts are the operating system, the processor for which kernels are compiled, the number of threads of a computation, and
    the folder of the compiled kernels. Optional packages that are missing are called "not installed".

    Examples
    --------
    >>> show_versions()  # doctest: +ELLIPSIS
    escape-explorer     ...
    Python              ...
    """
    sys.stdout.write("".join(f"{name:<19} {value}\n" for name, value in list_versions().items()))


def list_versions() -> dict[str, str]:
    """Return what `show_versions` prints, by name."""
    return {
        _PROGRAM: metadata.version(_PROGRAM),
        "Python": platform.python_version(),
        **{name: _find_version(name) for name in _list_dependencies(metadata.requires(_PROGRAM) or ())},
        "system": platform.platform(),
        "processor": f"{platform.machine()}, {_name_processor()}",
        "threads": str(count_cores()),
        "cache": str(cache_folder()),
    }


def _list_dependencies(requirements: Iterable[str]) -> list[str]:
    """Return the names of packages in requirements such as "numpy>=2.2; extra == 'page'", each once, without the program."""
    names = [re.split(r"[^\w.-]", requirement, maxsplit=1)[0] for requirement in requirements]
    return [name for name in dict.fromkeys([*names, _COMPILER]) if name != _PROGRAM]


def _find_version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "not installed"


def _name_processor() -> str:
    """Return LLVM's name of the processor."""
    import llvmlite.binding as llvm  # type: ignore[import-untyped]

    return llvm.get_host_cpu_name()
