"""The entry point `escape_explorer.pictures`, which `engine.foundations.extras` loads."""

from plots.live.live_figure import to_live_html
from plots.printed.results import plot_result, to_holoviews, to_html

__all__ = ["plot_result", "to_holoviews", "to_html", "to_live_html"]
