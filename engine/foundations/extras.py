"""Optional parts of an installation: the packages of extras, and the package that draws results."""

from __future__ import annotations

import functools
import importlib.util
from importlib.metadata import entry_points
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GROUP = "escape_explorer.pictures"
"""Group of the entry point of the module with the functions of `Pictures`."""


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


class Pictures(Protocol):
    """Functions that draw a `Result`."""

    def plot_result(self, result: Any, ax: Axes | None = None, **options: Any) -> Axes:
        """Draw a result, as `Result.plot` describes."""

    def to_html(self, result: Any) -> str:
        """Return the result as HTML for a notebook."""

    def to_holoviews(self, result: Any) -> Any:
        """Return the result as a HoloViews element."""


@functools.cache
def load_pictures(group: str = GROUP) -> Pictures:
    """Return the entry point of a group, loaded at the first call, because drawing libraries are slow to import.

    Raises
    ------
    RuntimeError
        If there is no entry point, for example in sources that are not installed.
    """
    for entry in entry_points(group=group):
        return entry.load()
    raise RuntimeError(f"no installed package draws results: entry point {group!r} is missing; install escape-explorer")
