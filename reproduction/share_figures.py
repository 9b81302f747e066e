"""Shares of bounded starts and of each channel against energy."""

from __future__ import annotations

from matplotlib.figure import Figure

from engine import CASES, Plane
from plots.curve_figures import draw_shares
from plots.figure_axes import add_panel_legend, label_axes, name_panels, new_figure
from reproduction.map_shelf import MapShelf
from reproduction.notation import PLANES


def draw_percentages(case: str, shelf: MapShelf) -> Figure:
    """Percentages of the interior starts on (x, y) and (x, px)."""
    figure = new_figure(11.4, 4.6, f"Case {case}: percentages of bounded and escaping starts")
    panels = list(figure.subplots(1, 2, sharey=True))
    planes = (Plane.X_Y, Plane.X_PX)
    for axes, plane in zip(panels, planes, strict=True):
        table = shelf.curves(case, plane)
        shares = table["share"].sel(fate=range(CASES[case].channels + 1)).transpose("h", "fate")
        draw_shares(axes, table["h"].values, shares.values, CASES[case])
        label_axes(axes, "$h$", "percentage of starts" if axes is panels[0] else "")
    name_panels(panels, [f"the {PLANES[plane]} plane" for plane in planes])
    add_panel_legend(panels[1], "center right")
    return figure
