"""One orbit in three panes: its path over the zero-velocity curve, SALI(t), and R²(t)."""

from __future__ import annotations

from typing import Any

import holoviews as hv
import numpy as np
import panel as pn
from holoviews.operation.datashader import datashade, dynspread

from app import palette
from engine import (
    CASES,
    CHAOS_THRESHOLD,
    Orbit,
    Plane,
    Potential,
    default_window,
    find_lyapunov_orbits,
    integrate_orbit,
    start_states,
    trace_zero_velocity_curve,
)

hv.extension("bokeh")

FRAME = 280
# Longer paths than this are drawn by datashader.
MOST_LINE_POINTS = 20_000
# Each of this many bins of a history shows its least and greatest value.
_BINS = 1000
_LEAST_SALI = 1e-17


class OrbitPanes:
    """The three panes; empty frames until an orbit is shown."""

    def __init__(self) -> None:
        self.path = pn.pane.HoloViews(linked_axes=False, margin=(0, 6))
        self.sali = pn.pane.HoloViews(linked_axes=False, margin=(0, 6))
        self.r2 = pn.pane.HoloViews(linked_axes=False, margin=(0, 6))

    def show(self, potential: Potential, orbit: Orbit) -> None:
        """Draw an orbit, its SALI with the threshold, and its R²."""
        self.path.object = _draw_path(potential, orbit)
        self.sali.object = _draw_sali(orbit)
        self.r2.object = _draw_r2(orbit)


def prepare() -> None:
    """Draw a long path once: datashader compiles its own code at first use."""
    potential = CASES["III"]
    state = start_states(potential, Plane.X_PX, 0.2, np.zeros(1), np.full(1, 0.1))[0]
    orbit = integrate_orbit(potential, state, MOST_LINE_POINTS / 4)
    hv.render(_draw_path(potential, orbit))


def _plain_toolbar(plot: Any, _element: Any) -> None:
    """The toolbar of the maps: no logo, out of the way until wanted."""
    plot.state.toolbar.logo = None
    plot.state.toolbar.autohide = True


def _options(title: str, xlabel: str, ylabel: str, **more: Any) -> dict[str, Any]:
    frame = {"frame_width": FRAME, "frame_height": FRAME, "axiswise": True, "framewise": True}
    style = {"toolbar": "above", "fontsize": {"title": "14px", "labels": "12px", "ticks": "11px"}, "hooks": [_plain_toolbar]}
    return {"title": title, "xlabel": xlabel, "ylabel": ylabel, **frame, **style, **more}


def _draw_path(potential: Potential, orbit: Orbit) -> hv.Overlay | hv.DynamicMap:
    window = default_window(potential, Plane.X_Y, orbit.energy)
    path = hv.Path([np.column_stack([orbit.x, orbit.y])], ["x", "y"])
    if orbit.t.size > MOST_LINE_POINTS:
        drawn: Any = dynspread(datashade(path, cmap=palette.ORBIT_DENSITY), max_px=1)
    else:
        drawn = path.opts(color=palette.ORBIT, line_width=1)
    drawn = drawn * hv.Path(trace_zero_velocity_curve(potential, Plane.X_Y, orbit.energy, window), ["x", "y"]).opts(
        color=palette.LIMITING_CURVE, line_width=2
    )
    for exit_orbit in find_lyapunov_orbits(potential, orbit.energy):
        curve = hv.Path([exit_orbit.half_path], ["x", "y"])
        drawn = drawn * curve.opts(color=palette.CHANNELS[exit_orbit.channel - 1], line_width=4)
    start = hv.Scatter([(orbit.x[0], orbit.y[0])], "x", "y").opts(color=palette.START, marker="cross", size=14, line_width=2)
    sides = {"xlim": (window.x_low, window.x_high), "ylim": (window.ordinate_low, window.ordinate_high)}
    return (drawn * start).opts(show_legend=False, **_options("The orbit", "x", "y", **sides))


def _draw_sali(orbit: Orbit) -> hv.Overlay:
    t, sali = envelope(orbit.t[1:], np.maximum(orbit.sali[1:], _LEAST_SALI), logarithmic=True)
    threshold = hv.HLine(CHAOS_THRESHOLD).opts(color=palette.THRESHOLD, line_dash="dashed", line_width=1.5)
    curve = hv.Curve((t, sali), "t", "SALI").opts(color=palette.ORBIT, line_width=1)
    limits = {"ylim": (_LEAST_SALI, 10.0), "xlim": (float(t[0]), float(t[-1])) if t.size > 1 else (0.01, 1.0)}
    options = _options(f"SALI (chaotic at or below {CHAOS_THRESHOLD:g})", "t", "SALI", logx=True, logy=True, **limits)
    return hv.Overlay([curve, threshold]).opts(show_legend=False, **options)


def _draw_r2(orbit: Orbit) -> hv.Curve:
    t, r2 = envelope(orbit.t, orbit.r2, logarithmic=False)
    return hv.Curve((t, r2), "t", "R2").opts(color=palette.ORBIT, line_width=1, **_options("R² = x² + y²", "t", "R²"))


def envelope(t: np.ndarray, values: np.ndarray, *, logarithmic: bool) -> tuple[np.ndarray, np.ndarray]:
    """A history thinned to what can be seen: of each bin of time its least and greatest value, in order of time."""
    if t.size <= 2 * _BINS:
        return t, values
    scale = np.log(t) if logarithmic else t
    edges = np.searchsorted(scale, np.linspace(scale[0], scale[-1], _BINS + 1)[:-1])
    keep = {0, t.size - 1}
    for begin, end in zip(edges, [*edges[1:], t.size], strict=True):
        if end > begin:
            keep |= {begin + int(np.argmin(values[begin:end])), begin + int(np.argmax(values[begin:end]))}
    order = np.array(sorted(keep))
    return t[order], values[order]
