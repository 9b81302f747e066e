"""What only some installations have: packages of the extras, and what draws results."""

from __future__ import annotations

import functools
import importlib.util
from importlib.metadata import entry_points
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from matplotlib.axes import Axes


GROUP = "escape_explorer.pictures"
"""Group of the entry point with a module that has the functions of `Pictures`."""


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


class Pictures(Protocol):
    """Functions that show a `Result`."""

    def plot_result(self, result: Any, ax: Axes | None = None, **options: Any) -> Axes:
        """Draw a result, as `Result.plot` describes."""

    def to_html(self, result: Any) -> str:
        """The result as HTML for a notebook."""

    def to_holoviews(self, result: Any) -> Any:
        """The result as a HoloViews element."""


@functools.cache
def load_pictures(group: str = GROUP) -> Pictures:
    """The functions of the entry point in a group, imported at the first call: drawing libraries are slow to import.

    Raises
    ------
    RuntimeError
        If there is no entry point, as in sources that are not installed.
    """
    for entry in entry_points(group=group):
        pictures: Pictures = entry.load()
        return pictures
    raise RuntimeError(f"no installed package draws results: entry point {group!r} is missing; install escape-explorer")
