"""Shares of bounded starts and of each channel against energy."""

from __future__ import annotations

from typing import Any

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import CASES, Fate, Plane, Potential
from plots.figure_axes import add_panel_legend, label_axes, name_panels, new_figure, style_axes
from plots.palette import PAPER
from reproduction.map_shelf import MapShelf
from reproduction.notation import PLANES

# Curves of channels that are equal by symmetry coincide: the second is dashed.
_DASHED = (0, (4.0, 3.0))


def draw_percentages(case: str, shelf: MapShelf) -> Figure:
    """Percentages of the interior starts on (x, y) and (x, px)."""
    figure = new_figure(11.4, 4.6, f"Case {case}: percentages of bounded and escaping starts")
    panels = list(figure.subplots(1, 2, sharey=True))
    planes = (Plane.X_Y, Plane.X_PX)
    for axes, plane in zip(panels, planes, strict=True):
        _draw_shares(axes, shelf.curves(case, plane), CASES[case])
        label_axes(axes, "$h$", "percentage of starts" if axes is panels[0] else "")
    name_panels(panels, [f"the {PLANES[plane]} plane" for plane in planes])
    add_panel_legend(panels[1], "center right")
    return figure


def _draw_shares(axes: Axes, table: xr.Dataset, potential: Potential) -> None:
    for code in table["fate"].values.tolist():
        shares = 100.0 * table["share"].sel(fate=code).values
        if code == Fate.BOUNDED:
            style: dict[str, Any] = {"color": PAPER.bounded, "linewidth": 2.2, "label": PAPER.outcomes[Fate.BOUNDED].label}
        else:
            dashed = potential.mirror_in_x and potential.mirror_channels[code] < code
            style = {"color": PAPER.channels[code - 1], "linewidth": 1.7, "label": f"channel {code}"}
            style |= {"linestyle": _DASHED, "zorder": 3} if dashed else {}
        axes.plot(table["h"].values, shares, marker="o", markersize=2.2, **style)
    axes.set_ylim(0.0, 100.0)
    axes.set_xlim(*table["h"].values[[0, -1]])
    style_axes(axes, grid=True)
