"""A study has axes only when there is a result."""

from __future__ import annotations

import numpy as np
from bokeh.models import HoverTool

from app.state.view_state import ViewState
from app.views.analysis.study_view import StudyView
from app.views.components.plots import FigurePane
from engine import CASES, Plane, SweepSpec, compute_sweep
from engine.measures.table import curve_names
from engine.results import Sweep
from plots.studies.against import AGAINST


def curves(*energies: float) -> Sweep:
    """Return a sweep with all measures. The only exponent in it is invented, because measuring exponents takes seconds."""
    quick = tuple(name for name in curve_names() if name != "uncertainty_exponent")
    found = compute_sweep(SweepSpec(CASES["I"], Plane.X_PX, energies, (20, 20), t_max=100.0, measures=quick)).dataset
    missing = np.full(len(energies) - 1, np.nan)
    exponent = {"exponent": 0.5, "exponent_low": 0.45, "exponent_high": 0.56}
    return Sweep(found.assign({name: ("h", [*missing, value]) for name, value in exponent.items()}))


def test_there_are_no_axes_before_the_first_curves() -> None:
    view = StudyView(AGAINST, ViewState(), lambda: None, lambda click: None)
    *_, plots = view.build()
    assert not plots.visible
    assert plots.objects == []
    # Below the escape energy there are no escape times yet.
    for energies in ((0.2, 0.3), (0.1,)):
        view.show(curves(*energies), "h")
        assert plots.visible
        figures = [pane.object for column in plots.objects for pane in column.objects if isinstance(pane, FigurePane)]
        assert len(figures) == len(AGAINST.frames)
        assert all(figure.y_range.start < figure.y_range.end for figure in figures)
        assert all(list(figure.select(HoverTool)) for figure in figures)
        view.show(None)
        assert not plots.visible
