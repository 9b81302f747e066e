"""Curves against energy have axes only when there are curves."""

from __future__ import annotations

from bokeh.models import Range1d

from app.views.analysis.curves import CurvesView
from engine import CASES, Plane, SweepSpec, compute_sweep
from engine.sweeps.measures import CURVES
from plots.sweep_panels import CURVE_PANELS


def test_there_are_no_axes_before_the_first_curves() -> None:
    view = CurvesView(lambda: None, lambda energy: None)
    *_, plots = view.build()
    assert not plots.visible
    assert plots.objects == []
    view.show(compute_sweep(SweepSpec(CASES["I"], Plane.X_PX, (0.2, 0.3), (20, 20), t_max=100.0, measures=CURVES)))
    assert plots.visible
    assert len(plots.objects) == 1 + len(CURVE_PANELS)
    view.show(None)
    assert not plots.visible


def test_axes_have_ranges_when_there_are_no_numbers_yet() -> None:
    view = CurvesView(lambda: None, lambda energy: None)
    view.build()
    view.show(compute_sweep(SweepSpec(CASES["I"], Plane.X_PX, (0.1,), (20, 20), t_max=100.0, measures=CURVES)))
    assert all(isinstance(edges, Range1d) and edges.start < edges.end for edges in view._values.values())
