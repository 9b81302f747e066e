"""Optional parts of an installation: the packages of extras, and the package that draws results."""

from __future__ import annotations

import functools
import importlib.util
from importlib.metadata import entry_points
from types import ModuleType

GROUP = "escape_explorer.pictures"
"""Entry point group of the module that draws results, which has the functions plot_result, to_html and to_holoviews."""


def require_package(package: str, extra: str) -> None:
    """Check that a package is installed.

    Parameters
    ----------
    package
        Name under which the package is imported.
    extra
        The extra of the distribution that includes the package: files, page, cluster or movies.

    Raises
    ------
    ModuleNotFoundError
        If the package is not installed; the message contains the command that installs it.
    """
    if importlib.util.find_spec(package) is None:
        raise ModuleNotFoundError(f"{package} is not installed: pip install 'escape-explorer[{extra}]'", name=package)


@functools.cache
def load_pictures(group: str = GROUP) -> ModuleType:
    """Return the module of the first entry point of a group. It is loaded at the first call, because it is slow to import.

    Raises
    ------
    RuntimeError
        If there is no entry point, for example in sources that are not installed.
    """
    for entry in entry_points(group=group):
        return entry.load()
    raise RuntimeError(f"no installed package draws results: entry point {group!r} is missing; install escape-explorer")
