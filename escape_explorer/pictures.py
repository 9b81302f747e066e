"""The entry point `escape_explorer.pictures`, which `engine.results.pictures` loads."""

from plots.results import plot_result, to_holoviews, to_html

__all__ = ["plot_result", "to_holoviews", "to_html"]
