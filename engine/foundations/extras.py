"""Optional parts of an installation: the packages of extras, and the package that draws results."""

from __future__ import annotations

import functools
import importlib.util
import os
from collections.abc import Mapping
from importlib.metadata import entry_points
from types import ModuleType
from typing import Any

from engine.foundations.output_lock import output_named_in_errors
from engine.foundations.validation import checked_path

GROUP = "escape_explorer.pictures"
"""Entry point group of the module that draws results, which has the functions plot_result, to_html, to_holoviews and
to_live_html."""


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


def write_live_figure(shown: object, path: str | os.PathLike[str], options: Mapping[str, Any]) -> None:
    """Write the live figure of a map, or of the request for one. Its options are those of `MapSpec.to_html`."""
    file = checked_path("path", path)
    content = load_pictures().to_live_html(shown, **options)
    with output_named_in_errors(file):
        file.write_text(content, encoding="utf-8")
