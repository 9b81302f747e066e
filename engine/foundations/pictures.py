"""The pictures of results, drawn by the package that is installed for them."""

from __future__ import annotations

import functools
from importlib.metadata import entry_points
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GROUP = "escape_explorer.pictures"
"""Group of the entry point with a module that has the functions of `Pictures`."""


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
