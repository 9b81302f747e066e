"""Charts have limits and scales, which HoloViews draws too."""

from __future__ import annotations

import holoviews as hv
import numpy as np
import pytest

from engine import CASES, MapSpec, Plane, compute_map, compute_statistics, fit_decay_laws
from engine.results import EscapeStatistics
from plots.pictures.charts import Shape
from plots.pictures.holoviews_elements import axis_options
from plots.studies.escape_charts import BINS, probabilities_chart, times_chart
from plots.studies.measure_charts import survival_chart


@pytest.fixture(scope="module")
def statistics() -> EscapeStatistics:
    return compute_statistics(compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.24, (40, 40), t_max=200.0)))


def test_bars_of_escape_times_touch_and_fill_the_axis(statistics: EscapeStatistics) -> None:
    chart = times_chart(statistics)
    (series,) = chart.series
    assert series.shape is Shape.BARS
    assert series.bars is not None
    low, high = series.bars
    assert low.size == BINS
    assert np.array_equal(low[1:], high[:-1])
    assert (low[0], high[-1]) == chart.limits[0]
    assert series.y.sum() == statistics.escaped


def test_bars_of_probabilities_are_at_whole_numbers_of_crossings(statistics: EscapeStatistics) -> None:
    (series,) = probabilities_chart(statistics).series
    assert series.bars is not None
    assert np.array_equal(0.5 * (series.bars[0] + series.bars[1]), np.arange(series.y.size))


def test_survival_without_escapes_has_a_decade_on_its_axis() -> None:
    below = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.1, (20, 20), t_max=50.0))
    _, shares = survival_chart(fit_decay_laws(below)).limits
    assert shares is not None
    assert shares[1] / shares[0] >= 10.0


def test_holoviews_elements_have_the_scale_of_the_chart(statistics: EscapeStatistics) -> None:
    hv.renderer("bokeh")
    times, probabilities = statistics.to_holoviews()
    options = [hv.Store.lookup_options("bokeh", overlay.get(0), "plot").kwargs for overlay in (times, probabilities)]
    assert options[0]["logx"]
    assert "logx" not in options[1]
    assert options[0]["xlim"] == times_chart(statistics).limits[0]
    assert axis_options(times_chart(statistics)).items() <= options[0].items()
