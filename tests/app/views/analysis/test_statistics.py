"""Statistics of the whole view or of a box are counted while they are on the page."""

from __future__ import annotations

import panel as pn
import pytest
from bokeh.plotting import figure

from app.job_clients.shown_results import ShownResults
from app.state.view import Analysis
from app.state.view_state import ViewState
from app.views.analysis.statistics import StatisticsView
from engine import CASES, EscapeMap, MapSpec, Plane, Window, compute_map, compute_statistics
from engine.foundations.wording import format_share
from tests.disc import disc_map

COPIED: list[str] = []
BOX = Window(-0.1, 0.1, 0.2, 0.4)


@pytest.fixture(scope="module")
def frame() -> EscapeMap:
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (40, 40), t_max=200.0))


@pytest.fixture
def state() -> ViewState:
    return ViewState()


@pytest.fixture
def results() -> ShownResults:
    return ShownResults()


@pytest.fixture
def view(state: ViewState, results: ShownResults, frame: EscapeMap) -> StatisticsView:
    view = StatisticsView(state, results, COPIED.append)
    results.frame = frame
    return view


@pytest.fixture(autouse=True)
def charts(view: StatisticsView) -> list[figure]:
    """Build the section, and return its figures."""
    return [part.object for make in view.parts()[1:] for part in make()]


def test_the_charts_count_every_escape(state: ViewState, view: StatisticsView, charts: list[figure], frame: EscapeMap) -> None:
    # Nothing is counted before the section is shown.
    assert view.table.object == ""
    state.analysis = Analysis.STATISTICS
    statistics = compute_statistics(frame)
    times, probabilities = (chart.renderers[-1].data_source.data for chart in charts)
    assert times["top"].sum() == statistics.escaped
    assert probabilities["top"][0] == pytest.approx(statistics.direct_share)


def test_numbers_on_the_axes_keep_their_size_with_each_count(state: ViewState, charts: list[figure]) -> None:
    state.analysis = Analysis.STATISTICS
    assert {axis.major_label_text_font_size for chart in charts for axis in (*chart.below, *chart.left)} == {"12px"}


def test_a_chart_that_returns_to_the_page_is_not_drawn_again(view: StatisticsView) -> None:
    for make in view.parts()[1:]:
        content = list(make())
        column = pn.Column(*content)
        root = column.get_root()
        drawn = root.children
        column.objects = []
        column.objects = content
        assert root.children == drawn


@pytest.mark.parametrize("box", [None, BOX])
def test_the_table_is_copied_with_shares_at_full_precision(
    state: ViewState, view: StatisticsView, frame: EscapeMap, box: Window | None
) -> None:
    state.param.update(analysis=Analysis.STATISTICS, box=box)
    view.copy.clicks += 1
    rows = [line.split("\t") for line in COPIED[-1].splitlines()]
    statistics = compute_statistics(frame, box)
    assert rows[0] == ["fate", "share", "95 % low", "95 % high"]
    assert [float(value) for value in rows[1][1:]] == [statistics.shares[1], *statistics.share_intervals[1]]


def test_a_collision_has_its_row(state: ViewState, results: ShownResults, view: StatisticsView) -> None:
    state.analysis = Analysis.STATISTICS
    results.frame = frame = disc_map()
    assert f"collision with a disc</span></td><td>{format_share(frame.fractions()[3], 2)}" in view.table.object
