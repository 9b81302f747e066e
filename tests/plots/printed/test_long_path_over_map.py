"""The path of a long orbit is visible over a map, whichever is drawn first."""

from __future__ import annotations

import pytest
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

from engine import CASES, MapSpec, Plane, compute_map, integrate_orbit, start_states


@pytest.mark.parametrize("path_first", [True, False])
def test_a_long_path_is_above_the_map_in_both_orders(path_first: bool) -> None:
    escapes = compute_map(MapSpec(CASES["III"], Plane.X_Y, 0.3, (20, 20), t_max=50.0))
    orbit = integrate_orbit(CASES["III"], start_states(CASES["III"], Plane.X_PX, 0.3, 0.45, 0.0)[0], t_max=1e3)
    axes = Figure().subplots()
    first, second = (orbit, escapes) if path_first else (escapes, orbit)
    drawings = {id(result): result.plot(axes) for result in (first, second)}
    (path,) = (artist for artist in drawings[id(orbit)].artists if isinstance(artist, AxesImage))
    (pixels,) = (artist for artist in drawings[id(escapes)].artists if isinstance(artist, AxesImage))
    images = sorted(axes.get_children(), key=lambda artist: artist.get_zorder())
    assert images.index(path) > images.index(pixels)
