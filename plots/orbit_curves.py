"""Orbits reduced for the browser: long paths as images, histories as envelopes, and a moving point with its trail."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine import Orbit, Plane, Potential, Window, default_window, find_section_crossings

History = tuple[np.ndarray, np.ndarray]
"""Times and values."""

LEAST_SALI = 1e-17
"""Lower end of the logarithmic axis of SALI."""

LEAST_EXPONENT = 1e-7
"""Lower end of the logarithmic axis of the Lyapunov exponent."""

MOST_LINE_POINTS = 20_000
"""Paths with more points are drawn as density images."""

TRAIL = 25.0
"""Length of the trail behind the moving point in time, about four periods of the well."""

# Bins of a history; each keeps its smallest and its largest value.
_BINS = 1000
# Twice the pixels of the plot, for high-density screens.
_SHADED_PIXELS = 600
_FAINTEST = 50


@dataclass(frozen=True, eq=False)
class OrbitCurves:
    """An orbit and its curves.

    Attributes
    ----------
    orbit
        The orbit.
    window
        Window of the (x, y) plane that contains the interior at its energy.
    sali, exponent, r2
        (t, value) envelopes of its histories.
    section
        (n, 2) x and px of its upward crossings of y = 0.
    visits
        (n, n) uint8 opacity of the density of a long path over the window, row 0 lowest; None for shorter paths.
    """

    orbit: Orbit
    window: Window
    sali: History
    exponent: History
    r2: History
    section: np.ndarray
    visits: np.ndarray | None

    def shaded(self, colour: str) -> np.ndarray:
        """RGBA image of the visits, (n, n) uint32."""
        assert self.visits is not None
        red, green, blue = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
        ink = np.array([red, green, blue, 0], np.uint8).view(np.uint32)
        return ink | (self.visits.astype(np.uint32) << 24)


def compute_orbit_curves(potential: Potential, orbit: Orbit) -> OrbitCurves:
    """Compute the curves of an orbit; slow, so call it once per orbit and outside the session's lock."""
    window = default_window(potential, Plane.X_Y, orbit.energy)
    sali = envelope(orbit.t[1:], np.maximum(orbit.sali[1:], LEAST_SALI), logarithmic=True)
    visits = _visits(orbit, window) if orbit.t.size > MOST_LINE_POINTS else None
    r2 = envelope(orbit.t, orbit.r2, logarithmic=False)
    exponent = envelope(orbit.t[1:], np.maximum(orbit.lyapunov_exponent[1:], LEAST_EXPONENT), logarithmic=True)
    return OrbitCurves(orbit, window, sali, exponent, r2, find_section_crossings(potential, orbit), visits)


def initial_state(orbit: Orbit) -> tuple[float, float, float, float]:
    """(x, y, px, py) of the start of an orbit."""
    return float(orbit.x[0]), float(orbit.y[0]), float(orbit.px[0]), float(orbit.py[0])


def _visits(orbit: Orbit, window: Window) -> np.ndarray:
    # Slow to import, and needed for long paths only.
    import datashader
    import pandas as pd
    from datashader import transfer_functions

    canvas = datashader.Canvas(
        _SHADED_PIXELS, _SHADED_PIXELS, (window.x_low, window.x_high), (window.ordinate_low, window.ordinate_high)
    )
    counts = canvas.line(pd.DataFrame({"x": orbit.x, "y": orbit.y}), "x", "y")
    shaded = transfer_functions.shade(counts, cmap="#000000", how="eq_hist", min_alpha=_FAINTEST)
    image = transfer_functions.dynspread(shaded, max_px=1).to_numpy()
    return np.ascontiguousarray((image >> 24).astype(np.uint8))


@dataclass(frozen=True)
class Moment:
    """(n,) x and y of the trail of an orbit, which ends at its current position."""

    x: np.ndarray
    y: np.ndarray


def moment(orbit: Orbit, t: float) -> Moment:
    """Trail of an orbit at a time; at its end for later times."""
    last = int(np.searchsorted(orbit.t, t, side="right")) - 1
    first = int(np.searchsorted(orbit.t, orbit.t[last] - TRAIL))
    trail = slice(first, last + 1)
    return Moment(orbit.x[trail], orbit.y[trail])


def envelope(t: np.ndarray, values: np.ndarray, *, logarithmic: bool) -> History:
    """Thin a history to the smallest and the largest value of each bin of time, in order of time."""
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
