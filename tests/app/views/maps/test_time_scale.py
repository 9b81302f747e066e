"""The scale of escape times follows the maps, or keeps its limits."""

from __future__ import annotations

from app.views.maps.map_plots import MapsView
from engine import CASES, MapSpec, Plane, compute_map
from plots.image_columns import longest_typical_time, map_columns


def maps_view() -> MapsView:
    return MapsView(lambda x, y: None, lambda window: None, lambda: None, lambda box: None)


def test_a_locked_scale_keeps_its_end_until_it_is_unlocked() -> None:
    maps = maps_view()
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (20, 20), t_max=50.0))
    maps.lock_times(5000.0)
    maps.show(frame, map_columns(frame))
    assert maps.longest_time == 5000.0
    assert "≥ 5 000" in maps.legend.pane.object
    maps.lock_times(None)
    assert maps.longest_time == longest_typical_time(frame)
    assert "locked" not in maps.legend.pane.object
