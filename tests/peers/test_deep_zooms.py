"""The share of pixels that deep zooms lose to rounding is estimated well, compared with heyoka in 80-bit arithmetic."""

from __future__ import annotations

import heyoka as hy
import numpy as np
import pytest

from engine import CASES, EscapeMap, MapSpec, Plane, compute_map
from engine.maps.analyses.trust import find_unlike_neighbours
from engine.slices.default_window import default_window

POTENTIAL, ENERGY, SIDE, T_MAX = CASES["II"], 0.25, 16, 300.0
# All orbits that leave the well of Case II reach this radius, each on its own side of the plane.
FAR = 2.0
Long = np.longdouble


def zoomed(seed: int, width: float) -> EscapeMap:
    """Return a map of a window at a basin boundary. The window is found by zooming into pixels with unlike neighbours."""
    rng, now = np.random.default_rng(seed), 0.5
    window = default_window(POTENTIAL, Plane.X_PX, ENERGY)
    while True:
        whole = compute_map(MapSpec(POTENTIAL, Plane.X_PX, ENERGY, (SIDE, SIDE), window, t_max=T_MAX))
        if now <= width:
            return whole
        # The next window is some pixels of the last map wide, so the boundary stays in the window.
        now = max(now / 5.0, width)
        places = np.argwhere(find_unlike_neighbours(whole.fate, 0 * whole.crossings) & (whole.fate > 0))
        row, column = places[rng.integers(len(places))]
        x, px = float(whole.x[column]), float(whole.ordinate[row])
        window = (x - now / 2, x + now / 2, px - now / 2, px + now / 2)  # type: ignore[assignment]


def long_fates(whole: EscapeMap) -> np.ndarray:
    """Return the channels through which the orbits of the pixels leave in 80-bit arithmetic; 0 if they stay."""
    x, y, px, py = hy.make_vars("x", "y", "px", "py")
    equations = [(x, px), (y, py), (px, -x + x * x - y * y), (py, -y - 2.0 * x * y)]
    far = hy.t_event(x * x + y * y - FAR**2, direction=hy.event_direction.positive, fp_type=Long)
    integrator = hy.taylor_adaptive(equations, [Long(0)] * 4, tol=Long(1e-19), t_events=[far], fp_type=Long)
    exits = np.arctan2(*POTENTIAL.saddles.T[::-1])
    fates = np.zeros(whole.fate.shape, int)
    for row, column in np.argwhere(whole.fate > 0):
        x0, px0 = Long(whole.x[column]), Long(whole.ordinate[row])
        squared = 2 * (Long(ENERGY) - (x0 * x0 / 2 - x0**3 / 3)) - px0 * px0
        integrator.time = Long(0)
        integrator.state[:] = [x0, Long(0), px0, np.sqrt(squared)]
        integrator.propagate_until(Long(T_MAX))
        x1, y1 = float(integrator.state[0]), float(integrator.state[1])
        if np.hypot(x1, y1) > 0.99 * FAR:
            turned = np.angle(np.exp(1j * (exits - np.arctan2(y1, x1))))
            fates[row, column] = 1 + int(np.argmin(np.abs(turned)))
    return fates


@pytest.mark.slow
@pytest.mark.skipif(np.finfo(Long).nmant < 63, reason="needs a long double of 80 bits")
@pytest.mark.parametrize("seed", [1, 2, 4, 5])
@pytest.mark.parametrize("width", [1e-6, 1e-9, 1e-12, 2e-14])
def test_the_estimated_share_of_lost_pixels_is_at_least_the_true_share_and_not_much_larger(seed: int, width: float) -> None:
    whole = zoomed(seed, width)
    escaped = whole.fate > 0
    wrong = float(np.mean((long_fates(whole) != whole.fate)[escaped]))
    assert whole.rounded_share is not None
    # The estimate also counts crossings that change, and pixels that are right only on the map.
    # The tolerance is not statistical: seeds choose the windows, and maps are equal to the bit on all processors.
    assert wrong - 0.02 <= whole.rounded_share <= 4.0 * wrong + 0.04


def test_an_ordinary_map_has_no_estimate() -> None:
    assert compute_map(MapSpec(POTENTIAL, Plane.X_PX, ENERGY, (SIDE, SIDE), t_max=T_MAX)).rounded_share is None


def test_the_estimate_rises_with_the_depth_of_the_zoom() -> None:
    shares = [zoomed(2, width).rounded_share or 0.0 for width in (1e-6, 1e-9, 2e-14)]
    assert shares == sorted(shares)
    assert shares[1] < 0.06
    assert shares[2] > 0.3
