"""The scale of escape times follows the maps, or keeps its limits."""

from __future__ import annotations

from app.views.maps.map_plots import PICTURES_ALONE
from engine import CASES, MapSpec, Plane, compute_map
from plots.pictures.image_columns import map_columns
from plots.pictures.time_scale import TimeScale, fitted_scale
from tests.app.map_actions import make_maps


def test_a_locked_scale_keeps_its_end_until_it_is_unlocked() -> None:
    maps = make_maps()
    maps.show_pictures(PICTURES_ALONE)
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (20, 20), t_max=50.0))
    maps.lock_times(TimeScale(2.5, 5000.0))
    maps.show(frame, map_columns(frame))
    assert maps.times == TimeScale(2.5, 5000.0)
    assert "≤ 2.5 " in maps.figures["times"].elements[0].html
    assert "≥ 5 000" in maps.figures["times"].elements[0].html
    maps.lock_times(None)
    assert maps.times == fitted_scale(frame)
    assert "locked" not in maps.figures["times"].elements[0].html
