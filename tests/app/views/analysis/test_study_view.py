"""A study has axes only when there is a result, and a tab has each choice once."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from bokeh.models import HoverTool, Span

from app.state.view_state import ViewState
from app.views.analysis.study_view import StudyView
from app.views.components.plots import FigurePane
from app.views.components.widgets import SegmentedControl
from engine import CASES, Plane, SweepSpec, compute_sweep
from engine.measures.table import curve_names
from engine.results import Sweep
from plots.studies.against import AGAINST
from plots.studies.nine_energies import NINE_ENERGIES
from plots.studies.periodic import PERIODIC_STUDY
from plots.studies.plate import PLATE_STUDY
from plots.studies.study import Study


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
        assert view.text.object.endswith("values of h on (x, px). Click a curve to open the map there.")
        figures = [pane.object for column in plots.objects for pane in column.objects if isinstance(pane, FigurePane)]
        assert len(figures) == len(AGAINST.frames)
        assert all(figure.y_range.start < figure.y_range.end for figure in figures)
        assert all(list(figure.select(HoverTool)) for figure in figures)
        view.show(None)
        assert not plots.visible


def view_of(study: Study[Any]) -> StudyView:
    return StudyView(study, ViewState(), lambda: None, lambda click: None)


def test_studies_in_one_tab_have_each_choice_once() -> None:
    rows = [view_of(study).build()[0] for study in (NINE_ENERGIES, PLATE_STUDY)]
    titles = [part.label for row in rows for part in row.objects if isinstance(part, SegmentedControl)]
    assert titles == [setting.title for setting in NINE_ENERGIES.settings]
    assert all(setting in NINE_ENERGIES.settings for setting in PLATE_STUDY.settings)


def test_axes_of_a_plate_name_its_values_and_no_line_marks_a_place_between_maps() -> None:
    view = view_of(PLATE_STUDY)
    (spec,) = PLATE_STUDY.job(ViewState().subject, "omega_1").arguments
    values = (0.1, 0.2, 0.3, 0.4, 0.5), (0.5, 0.75, 1.0, 1.25, 1.5)
    view.show(compute_sweep(replace(spec, values=values, resolution=(8, 8), t_max=10.0)), "omega_1")
    (figure,) = [pane.object for column in view.build()[2].objects for pane in column.objects if isinstance(pane, FigurePane)]
    for axis, label, numbers in zip((*figure.below, *figure.left), ("h", "ω₁"), values, strict=True):
        assert axis.visible
        assert axis.axis_label == label
        assert [float(text) for text in axis.major_label_overrides.values()] == [*numbers]
    assert not [*figure.select(Span)]


def test_a_study_says_that_its_first_result_is_being_computed() -> None:
    view = view_of(PERIODIC_STUDY)
    hint = view.text.object
    view.show_running(True)
    assert view.text.object == f"{hint} Computing …"
    view.show_running(False)
    assert view.text.object == hint
