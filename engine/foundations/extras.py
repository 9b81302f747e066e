"""Packages that only some users install, each with one of the extras of the distribution."""

from __future__ import annotations

import importlib.util


def require_package(package: str, extra: str) -> None:
    """Check that a package is installed.

    Parameters
    ----------
    package
        Name under which the package is imported.
    extra
        The extra of the distribution that has it: files, page, cluster or movies.

    Raises
    ------
    ModuleNotFoundError
        If it is not installed; the message is the command that installs it.
    """
    if importlib.util.find_spec(package) is None:
        raise ModuleNotFoundError(f"{package} is not installed: pip install 'escape-explorer[{extra}]'", name=package)
