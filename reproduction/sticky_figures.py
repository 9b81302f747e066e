"""Case III near its escape energy: regular and chaotic bounded orbits, and one that leaves after all."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from app.rendering.map_analyses import MapAnalyses
from app.rendering.palette import MEASURED, PAPER, THRESHOLD
from engine import Plane, RadiusEnvelope, SuperStickySearch, compute_radius_envelope, find_lyapunov_orbits
from reproduction.map_panels import draw_limits, draw_map, show_window
from reproduction.map_shelf import MapShelf
from reproduction.paper_ranges import STICKY_CASE, STICKY_ENERGY
from reproduction.printing import (
    PLANES,
    add_key,
    add_panel_key,
    label_axes,
    limiting_lines,
    name_panels,
    new_figure,
    patches,
    tidy_axes,
)

LONGEST_DRAWN = 4e6
"""The latest escape of an orbit that is drawn: to follow it takes a second for each 1e5 time units."""

# Times at which R² is known by its least and greatest value between them, for the page to thin out.
_INTERVALS = 100_000
_ACROSS = 2000
# The last part of the way, in which one sees it come loose: a share of all.
_LAST = 0.01
_TIME_UNIT = 1e5
# How far the axis of R² goes beyond the exits: there is room for the key.
_ABOVE = 1.4


def draw_characters(shelf: MapShelf) -> Figure:
    """The plane (x, px): regular cyan, chaotic magenta, escaping white."""
    frame = shelf.map(STICKY_CASE, Plane.X_PX, STICKY_ENERGY)
    regularity = shelf.judged(frame)
    title = f"Case {STICKY_CASE}, {PLANES[Plane.X_PX]} plane, $h = {STICKY_ENERGY}$: bounded orbits"
    figure = new_figure(6.8, 7.2, title, equal=True)
    axes = figure.subplots()
    draw_map(axes, frame, "characters", findings=MapAnalyses(regularity=regularity))
    draw_limits(axes, frame, frame.spec.window)
    show_window(axes, Plane.X_PX, frame.spec.window)
    add_key(figure, [*patches(PAPER.character_entries[1:3]), *limiting_lines(Plane.X_PX)])
    return figure


def draw_super_sticky(shelf: MapShelf) -> Figure:
    """R²(t) of an orbit that is bounded for the paper's 1e5 time units and leaves long after: all of it, and its end."""
    hunt = shelf.hunt()
    orbit = _follow_late_orbit(hunt, shelf)
    figure = new_figure(11.4, 4.8, f"Case {STICKY_CASE}, $h = {STICKY_ENERGY}$: {_describe(hunt, orbit)}")
    panels = list(figure.subplots(1, 2, sharey=True, width_ratios=(2, 1)))
    if orbit is not None:
        _draw_history(panels[0], orbit, hunt.spec.t_max)
        _draw_departure(panels[1], orbit)
    for axes in panels:
        _draw_exits(axes, hunt)
        tidy_axes(axes)
    label_axes(panels[0], "$t / 10^5$", "$R^2 = x^2 + y^2$")
    label_axes(panels[1], r"$t - t_{\mathrm{esc}}$", "")
    name_panels(panels, ["from the start to the escape", "the last hundredth of the way"])
    add_panel_key(panels[0], "upper right")
    return figure


def find_shown(hunt: SuperStickySearch) -> int | None:
    """The place in a hunt of the orbit to draw: the last to leave by `LONGEST_DRAWN`, else the first; None when none leaves."""
    leavers = hunt.leavers
    if not leavers.size:
        return None
    early = leavers[hunt.escape_time[leavers] <= LONGEST_DRAWN]
    return int(early[-1] if early.size else leavers[0])


def _follow_late_orbit(hunt: SuperStickySearch, shelf: MapShelf) -> RadiusEnvelope | None:
    place = find_shown(hunt)
    if place is None:
        return None
    return compute_radius_envelope(hunt.spec.potential, hunt.states[place], hunt.t_max, _INTERVALS, cancel=shelf.cancel)


def _describe(hunt: SuperStickySearch, orbit: RadiusEnvelope | None) -> str:
    if orbit is None:
        return f"no chaotic orbit of this map leaves by {hunt.t_max / 1e6:g} million time units"
    return f"an orbit that leaves through channel {orbit.fate} at $t = {orbit.escape_time:.0f}$"


def _draw_history(axes: Axes, orbit: RadiusEnvelope, t_max: float) -> None:
    places = np.arange(0, _INTERVALS, _INTERVALS // _ACROSS)
    low, high = np.minimum.reduceat(orbit.low, places), np.maximum.reduceat(orbit.high, places)
    _draw_band(axes, np.append(orbit.t[places], orbit.t[-1]) / _TIME_UNIT, low, high)
    style: dict[str, Any] = {"color": PAPER.channels[2], "linestyle": "--", "linewidth": 1.4}
    axes.axvline(t_max / _TIME_UNIT, label=f"the maps end: $t = 10^{{{np.log10(t_max):.0f}}}$", **style)
    axes.set_xlim(0.0, 1.02 * orbit.t[-1] / _TIME_UNIT)


def _draw_departure(axes: Axes, orbit: RadiusEnvelope) -> None:
    last = round(_LAST * _INTERVALS)
    _draw_band(axes, orbit.t[-last - 1 :] - orbit.t[-1], orbit.low[-last:], orbit.high[-last:])
    axes.set_xlim(-_LAST * orbit.t[-1], 0.02 * _LAST * orbit.t[-1])


def _draw_band(axes: Axes, ends: np.ndarray, low: np.ndarray, high: np.ndarray) -> None:
    """The least and greatest R² between each two ends."""
    least, greatest = (np.append(side, side[-1]) for side in (low, high))
    axes.fill_between(ends, least, greatest, step="post", color=MEASURED, linewidth=0.2)


def _draw_exits(axes: Axes, hunt: SuperStickySearch) -> None:
    """The band that the Lyapunov orbits span."""
    assert not isinstance(hunt.spec.energy, tuple)
    orbits = find_lyapunov_orbits(hunt.spec.potential, hunt.spec.energy)
    distances = np.concatenate([orbit.x**2 + orbit.y**2 for orbit in orbits])
    low, high = float(distances.min()), float(distances.max())
    label = f"Lyapunov orbits, $R^2 = {low:.3f}$ to ${high:.3f}$"
    axes.axhspan(low, high, color=THRESHOLD, alpha=0.35, linewidth=0.0)
    axes.axhline(0.5 * (low + high), color=THRESHOLD, linestyle="--", linewidth=1.2, label=label)
    axes.set_ylim(0.0, _ABOVE * high)
