"""Draw case III near its escape energy: regular and chaotic bounded orbits, and a super-sticky orbit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import Plane, sample_orbits
from plots.layers.regularity import REGULARITY, entries
from plots.pictures.palette import MEASURED, PAPER, THRESHOLD
from plots.printed.figure_axes import (
    add_figure_legend,
    add_panel_legend,
    label_axes,
    legend_handles,
    new_figure,
    set_titles,
    style_axes,
)
from plots.printed.figure_style import SCREEN
from reproduction.figures.map_figures import draw_map_panel
from reproduction.map_cache import MapCache
from reproduction.notation import plane_label
from reproduction.paper_ranges import STICKY_CASE, STICKY_ENERGY
from reproduction.sample_orbits import find_lyapunov_r2
from reproduction.super_sticky import SuperStickySearch

LONGEST_DRAWN = 4e6
"""Latest escape time of a drawn orbit, dimensionless, unless all escape later. Integration takes a second per 1e5 time units."""

# Number of time intervals in each panel. The minimum and maximum of R² in each interval are drawn.
_INTERVALS = 1000
# Number of samples in each interval. R² oscillates with a period of about π, so the samples cover all phases.
_SAMPLES = 1000
# Part of the orbit that the second panel shows, as a share of the escape time. It ends at the escape.
_DEPARTURE_SHARE = 0.01
# Unit of the time axis of the first panel, in units of time of the potential.
_TIME_UNIT = 1e5
# Upper end of the R² axis, in units of the largest R² on the Lyapunov orbits. The legend needs the room.
_R2_AXIS_END = 1.4


def draw_characters(cache: MapCache) -> Figure:
    """Draw bounded orbits on (x, px): regular cyan, chaotic magenta, escaping white."""
    frame = cache.map(STICKY_CASE, Plane.X_PX, STICKY_ENERGY)
    regularity = cache.regularity(frame)
    title = f"Case {STICKY_CASE}, {plane_label(Plane.X_PX)} plane, $h = {STICKY_ENERGY}$: bounded orbits"
    figure = new_figure(replace(SCREEN, width=17.3), 18.3, title, equal=True)
    axes = figure.subplots()
    draw_map_panel(axes, frame, "characters", frame.spec.find_window(), analyses={REGULARITY.name: regularity})
    # The first code is of escaping orbits, and the last of orbits not judged yet.
    _, *character_entries, _ = entries(PAPER)
    add_figure_legend(figure, [*legend_handles(character_entries), *axes.collections])
    return figure


def draw_super_sticky(cache: MapCache) -> Figure:
    """Draw R²(t) of an orbit that escapes long after the paper's 1e5 time units: over the whole orbit, and at its end."""
    search = cache.super_sticky()
    index = find_displayed_orbit(search)
    figure = new_figure(SCREEN, 12.2, f"Case {STICKY_CASE}, $h = {STICKY_ENERGY}$: {_describe(search, index)}")
    panels = list(figure.subplots(1, 2, sharey=True, width_ratios=(2, 1)))
    if index is not None:
        end = float(search.escape_time[index])
        _draw_history(panels[0], _sample_r2(search, index, 0.0, cache), end, search.spec.t_max)
        _draw_departure(panels[1], _sample_r2(search, index, (1.0 - _DEPARTURE_SHARE) * end, cache), end)
    for axes in panels:
        _draw_lyapunov_range(axes, search)
        style_axes(axes)
    label_axes(panels[0], "$t / 10^5$", "$R^2 = x^2 + y^2$")
    label_axes(panels[1], r"$t - t_{\mathrm{esc}}$", "")
    set_titles(panels, ["from the start to the escape", "the last hundredth of the time"])
    add_panel_legend(panels[0], "upper right")
    return figure


def find_displayed_orbit(search: SuperStickySearch) -> int | None:
    """Return the index of the drawn orbit: the last to escape by `LONGEST_DRAWN`, else the first to escape; None without one."""
    escapers = search.escapers
    if not escapers.size:
        return None
    early_escapers = escapers[search.escape_time[escapers] <= LONGEST_DRAWN]
    return int(early_escapers[-1] if early_escapers.size else escapers[0])


def _sample_r2(search: SuperStickySearch, index: int, begin: float, cache: MapCache) -> np.ndarray:
    """Return R² of an orbit from time `begin` to the escape, of shape (intervals, samples)."""
    times = np.linspace(begin, search.escape_time[index], _INTERVALS * _SAMPLES)
    orbits = sample_orbits(search.spec.potential, search.states[index : index + 1], times, execution=cache.execution)
    return (orbits.x**2 + orbits.y**2).reshape(_INTERVALS, _SAMPLES)


def _describe(search: SuperStickySearch, index: int | None) -> str:
    if index is None:
        return f"no chaotic orbit of this map escapes by {search.t_max / 1e6:g} million time units"
    return f"an orbit that escapes through exit {search.fate[index]} at $t = {search.escape_time[index]:.0f}$"


def _draw_history(axes: Axes, r2: np.ndarray, end: float, t_max: float) -> None:
    _draw_band(axes, r2, 0.0, end / _TIME_UNIT)
    style: dict[str, Any] = {"color": PAPER.channels[2], "linestyle": "--", "linewidth": 1.4}
    axes.axvline(t_max / _TIME_UNIT, label=f"the maps end: $t = 10^{{{np.log10(t_max):.0f}}}$", **style)
    axes.set_xlim(0.0, 1.02 * end / _TIME_UNIT)


def _draw_departure(axes: Axes, r2: np.ndarray, end: float) -> None:
    _draw_band(axes, r2, -_DEPARTURE_SHARE * end, 0.0)
    axes.set_xlim(-_DEPARTURE_SHARE * end, 0.02 * _DEPARTURE_SHARE * end)


def _draw_band(axes: Axes, r2: np.ndarray, begin: float, end: float) -> None:
    """Draw the minimum and maximum of R² in each interval."""
    edges = np.linspace(begin, end, len(r2) + 1)
    # With step="post", the value at the last edge is not drawn.
    lowest, highest = (np.append(values, values[-1]) for values in (r2.min(axis=1), r2.max(axis=1)))
    axes.fill_between(edges, lowest, highest, step="post", color=MEASURED, linewidth=0.2)


def _draw_lyapunov_range(axes: Axes, search: SuperStickySearch) -> None:
    """Draw the range of R² on the Lyapunov orbits, and set the limits of the R² axis."""
    assert search.spec.common_energy is not None
    low, high = find_lyapunov_r2(search.spec.potential, search.spec.common_energy)
    label = f"Lyapunov orbits, $R^2 = {low:.3f}$ to ${high:.3f}$"
    axes.axhspan(low, high, color=THRESHOLD, alpha=0.35, linewidth=0.0)
    axes.axhline(0.5 * (low + high), color=THRESHOLD, linestyle="--", linewidth=1.2, label=label)
    axes.set_ylim(0.0, _R2_AXIS_END * high)
