"""Orbits reduced for the browser: long paths as images, histories, and the trail behind a moving point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from engine import Orbit, Potential, Window
from engine.foundations.extras import require_package
from engine.slices.default_window import default_window
from engine.slices.planes import SPACE
from plots.pictures.histories import History
from plots.pictures.orbit_quantities import ORBIT_QUANTITIES

MOST_LINE_POINTS = 20_000
"""Longer paths are drawn as density images."""

TRAIL_DURATION = 25.0
"""Duration of the trail behind the moving point, dimensionless: about four periods of the well."""

# Side of a density image, in pixels: twice the side of the plot, for high-density screens.
_SHADED_PIXELS = 600
# Smallest opacity of visited pixels in a density image, 0 to 255.
_LEAST_OPACITY = 50
# Half the side of the window of a path, in units of the largest |x| or |y| of the path.
_PATH_MARGIN_FACTOR = 1.1
# Largest half of this side, in units of the distance of the farthest saddle from the origin.
_MOST_SADDLE_DISTANCES = 10.0


@dataclass(frozen=True, eq=False)
class OrbitCurves:
    """An orbit and its curves.

    Attributes
    ----------
    orbit
        The orbit.
    window
        Window of the (x, y) plane, which contains the interior at the energy of the orbit; without known exits, the nearby path.
    histories
        Histories by name, one for each of `ORBIT_QUANTITIES`.
    section
        The crossings of the section of the orbit, of shape (n, 2), see `Section.axes`; by default x and px on y = 0.
    visits
        Opacity of each pixel of the density image of a long path, uint8 of shape (n, n), row 0 lowest; None for shorter paths.
    part
        Index range of the samples of the orbit in `path` and `histories`; all by default.
    """

    orbit: Orbit
    window: Window
    histories: Mapping[str, History]
    section: np.ndarray
    visits: np.ndarray | None
    part: slice = slice(None)

    @property
    def path(self) -> tuple[np.ndarray, np.ndarray]:
        """x and y of the path."""
        return self.orbit.x[self.part], self.orbit.y[self.part]

    def shaded(self, colour: str) -> np.ndarray:
        """Return the RGBA image of the visits, uint32 of shape (n, n)."""
        assert self.visits is not None
        red, green, blue = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
        ink = np.array([red, green, blue, 0], np.uint8).view(np.uint32)
        return ink | (self.visits.astype(np.uint32) << 24)


def compute_orbit_curves(potential: Potential, orbit: Orbit, *, with_visits: bool = True) -> OrbitCurves:
    """Compute the curves of an orbit. This is slow: call it once per orbit, and outside the lock of a session of the page.

    With `with_visits`, a long path gets a density image, which needs the extra ``page``.
    """
    window = _path_window(potential, orbit) if orbit.exits_unknown else find_well_window(potential, orbit.energy)
    all_samples = slice(None)
    section = orbit.find_section_crossings()
    visits = _visits(orbit, window, all_samples) if with_visits else None
    return OrbitCurves(orbit, window, _histories(orbit, all_samples), section, visits)


def find_well_window(potential: Potential, energy: float) -> Window:
    """Return the window of the interior; for an energy without an interior, that of the whole well, see `well_energy`."""
    try:
        return default_window(potential, SPACE, energy)
    except ValueError:
        if not potential.escapes_over_saddles:
            raise
        return default_window(potential, SPACE, well_energy(potential))


def well_energy(potential: Potential) -> float:
    """Return an energy at which the whole well is seen: the escape energy; in a well without exits, one unit above its bottom."""
    return potential.escape_energy if potential.channels else potential.well.energy_at(1.0)


def _path_window(potential: Potential, orbit: Orbit) -> Window:
    """Return a square around the origin and the nearby path. An orbit without known exits may go far away."""
    largest_coordinate = float(max(np.abs(orbit.x).max(), np.abs(orbit.y).max()))
    # A well whose exits are not known may have no saddles.
    saddle_distance = float(np.hypot(*potential.saddles.T).max(initial=0.0)) or potential.units.length
    half = min(_PATH_MARGIN_FACTOR * largest_coordinate, _MOST_SADDLE_DISTANCES * saddle_distance)
    return Window(-half, half, -half, half)


def restrict_curves(curves: OrbitCurves, begin: float, end: float) -> OrbitCurves:
    """Restrict path and histories to an interval of time, at full resolution. This is as slow as `compute_orbit_curves`.

    Parameters
    ----------
    curves
        Curves of an orbit, restricted or not.
    begin, end
        The interval, ``begin < end``. If it contains no samples, path and histories are empty.
    """
    t = curves.orbit.t
    part = slice(int(np.searchsorted(t, begin)), int(np.searchsorted(t, end, side="right")))
    visits = _visits(curves.orbit, curves.window, part)
    return replace(curves, histories=_histories(curves.orbit, part), visits=visits, part=part)


def _histories(orbit: Orbit, part: slice) -> dict[str, History]:
    return {quantity.name: quantity.history(orbit, part) for quantity in ORBIT_QUANTITIES}


def initial_state(orbit: Orbit) -> tuple[float, float, float, float]:
    """Return the start of an orbit, (x, y, px, py)."""
    return float(orbit.x[0]), float(orbit.y[0]), float(orbit.px[0]), float(orbit.py[0])


def _visits(orbit: Orbit, window: Window, part: slice) -> np.ndarray | None:
    """Return the density image of a long path; None for a shorter path. ModuleNotFoundError without the extra ``page``."""
    x, y = orbit.x[part], orbit.y[part]
    if x.size <= MOST_LINE_POINTS:
        return None
    require_package("datashader", "page")
    # These packages are slow to import, and only long paths need them.
    import datashader
    import pandas as pd
    from datashader import transfer_functions

    canvas = datashader.Canvas(_SHADED_PIXELS, _SHADED_PIXELS, *window.ranges)
    counts = canvas.line(pd.DataFrame({"x": x, "y": y}), "x", "y")
    shaded = transfer_functions.shade(counts, cmap="#000000", how="eq_hist", min_alpha=_LEAST_OPACITY)
    image = transfer_functions.dynspread(shaded, max_px=1).to_numpy()
    # The highest byte of a pixel is its opacity.
    return np.ascontiguousarray((image >> 24).astype(np.uint8))


@dataclass(frozen=True)
class Trail:
    """x and y of the trail of an orbit, each of shape (n,). The last point is the position of the orbit."""

    x: np.ndarray
    y: np.ndarray


def find_trail(orbit: Orbit, t: float) -> Trail:
    """Return the trail of an orbit at a time. A time outside the orbit is replaced by the nearest time of the orbit."""
    last = max(int(np.searchsorted(orbit.t, t, side="right")) - 1, 0)
    first = int(np.searchsorted(orbit.t, orbit.t[last] - TRAIL_DURATION))
    trail = slice(first, last + 1)
    return Trail(orbit.x[trail], orbit.y[trail])
