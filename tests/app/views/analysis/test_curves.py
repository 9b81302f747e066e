"""Curves against energy have axes only when there are curves."""

from __future__ import annotations

import pytest

from app.views.analysis.curves import CurvesView
from engine import CASES, Plane, SweepSpec, compute_sweep
from engine.sweeps.measures import CURVES
from plots.pictures.sweep_panels import CURVE_PANELS


def test_there_are_no_axes_before_the_first_curves(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("engine.sweeps.measures.WORK", 1e6)
    view = CurvesView(lambda: None, lambda energy: None)
    *_, plots = view.build()
    assert not plots.visible
    assert plots.objects == []
    view.show(compute_sweep(SweepSpec(CASES["I"], Plane.X_PX, (0.2, 0.3), (20, 20), t_max=100.0, measures=CURVES)))
    assert plots.visible
    assert len(plots.objects) == 1 + len(CURVE_PANELS)
    view.show(None)
    assert not plots.visible
    # Below the escape energy there are no escape times yet.
    view.show(compute_sweep(SweepSpec(CASES["I"], Plane.X_PX, (0.1,), (20, 20), t_max=100.0, measures=CURVES)))
    figures = [pane.object for column in plots.objects for pane in column.objects if hasattr(pane.object, "y_range")]
    assert len(figures) == 1 + len(CURVE_PANELS)
    assert all(figure.y_range.start < figure.y_range.end for figure in figures)
