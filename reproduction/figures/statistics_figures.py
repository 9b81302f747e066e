"""Draw the statistics of the paper: shares against energy, escapes by number of crossings, and remaining starts against time.

As in the paper, Ne of N0 starts escape, Nde without a crossing, and dN_n after n crossings, a share p_n of those still inside.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import Plane, compute_statistics, fit_decay_laws
from plots.pictures.palette import LIGHT, MEASURED, PAPER, THRESHOLD
from plots.printed.curve_figures import draw_chart
from plots.printed.figure_axes import add_panel_legend, label_axes, new_figure, set_titles, style_axes
from plots.printed.figure_style import SCREEN
from plots.studies.escape_charts import crossing_charts
from plots.studies.measure_charts import survival_chart
from plots.studies.sweep_charts import sweep_charts
from reproduction.map_cache import MapCache
from reproduction.notation import plane_label
from reproduction.numbers.share_fits import CaseFit, fit_case
from reproduction.paper_ranges import nine_energies, three_energies

# Number of points of a fitted curve.
_SAMPLES = 400


def draw_statistics(case: str, cache: MapCache) -> Figure:
    """Draw Ne/N0 and Nde/N0 against h, with the paper's fits and new fits, and dN_n/N0 and p_n against n."""
    figure = new_figure(SCREEN, 21.8, f"Case {case}, {plane_label(Plane.X_PX)} plane: statistics of the escapes")
    panels = figure.subplots(2, 2).ravel().tolist()
    for axes, fit in zip(panels, fit_case(case, cache.curves(case, Plane.X_PX)), strict=False):
        _draw_fits(axes, fit)
    label_axes(panels[0], "$h$", "$N_e/N_0$")
    label_axes(panels[1], "$h$", "$N_{de}/N_0$")
    statistics = {energy: compute_statistics(cache.map(case, Plane.X_PX, energy)) for energy in nine_energies(case)}
    for axes, chart, label in zip(panels[2:], crossing_charts(statistics), ("$dN_n/N_0$", "$p_n$"), strict=True):
        draw_chart(axes, chart, corner="upper right" if axes is panels[2] else None)
        label_axes(axes, "$n$", label)
    after = "after $n$ crossings"
    set_titles(panels, ["escaping starts", "direct escapes", f"escapes {after}", f"probability of escape {after}"])
    return figure


def _draw_fits(axes: Axes, fit: CaseFit) -> None:
    h = fit.h
    energies = np.linspace(h[0], h[-1], _SAMPLES)
    axes.plot(h, fit.shares, "o", color=MEASURED, markersize=3.6, label="computed")
    axes.plot(energies, fit.published(energies), color=THRESHOLD, linewidth=1.5, linestyle="--", label="the paper's fit")
    if fit.fitted.determined:
        axes.plot(energies, fit.fitted.curve(energies), color=LIGHT.text, linewidth=1.2, label="this fit")
    axes.set_xlim(h[0], h[-1])
    style_axes(axes, grid=True)
    add_panel_legend(axes, "lower right")


def draw_percentages(case: str, cache: MapCache) -> Figure:
    """Draw the percentages of bounded starts and of each exit against h, on (x, y) and (x, px)."""
    figure = new_figure(SCREEN, 11.7, f"Case {case}: percentages of bounded and escaping starts")
    panels = list(figure.subplots(1, 2, sharey=True))
    planes = (Plane.X_Y, Plane.X_PX)
    for axes, plane in zip(panels, planes, strict=True):
        shares, *_ = sweep_charts(cache.curves(case, plane), PAPER)
        draw_chart(axes, shares, corner=None)
        label_axes(axes, "$h$", "percentage of starts" if axes is panels[0] else "")
    set_titles(panels, [f"the {plane_label(plane)} plane" for plane in planes])
    add_panel_legend(panels[1], "center right")
    return figure


def draw_survival(case: str, cache: MapCache) -> Figure:
    """Draw the share of remaining starts on (x, px) against time, with a panel for each energy."""
    energies = three_energies(case)
    figure = new_figure(
        replace(SCREEN, width=32.0), 11.7, f"Case {case}, {plane_label(Plane.X_PX)} plane: share of the starts not yet escaped"
    )
    panels = list(figure.subplots(1, len(energies), sharex=True))
    for axes, energy in zip(panels, energies, strict=True):
        statistics = compute_statistics(cache.map(case, Plane.X_PX, energy))
        draw_chart(axes, survival_chart(fit_decay_laws(statistics), cache.quality.t_max))
        label_axes(axes, "$t$", "$S(t)$" if axes is panels[0] else "")
    set_titles(panels, [f"$h = {energy:.2f}$" for energy in energies])
    return figure
