"""Results are drawn on axes, in notebooks and as HoloViews elements."""

from __future__ import annotations

import base64
import re
from io import BytesIO

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from engine import CASES, Plane, Result, SweepSpec, compute_sweep
from engine.results import DecayLaws, SampledOrbits
from plots.pictures.palette import PALETTES
from tests.results import POTENTIAL, RESULTS, SPEC, result_of

LARGEST = 100_000
PICTURELESS = ("entropy", "verdict")
DRAWN = [name for name in RESULTS if name not in PICTURELESS and not name.startswith(("review of", "divergent", "outcomes"))]


def shown_picture(result: Result) -> Image.Image:
    (png,) = re.findall(r"data:image/png;base64,([^']*)", result._repr_html_())
    return Image.open(BytesIO(base64.b64decode(png)))


@pytest.mark.parametrize("name", DRAWN)
class TestEveryResult:
    def test_notebook_shows_a_light_picture(self, name: str) -> None:
        result = result_of(name)
        with shown_picture(result) as picture:
            colours = picture.convert("RGB").getcolors(maxcolors=picture.width * picture.height)
        assert colours is not None
        assert len(colours) > 20
        assert len(result._repr_html_()) < LARGEST

    def test_tables_have_the_same_columns(self, name: str) -> None:
        result = result_of(name)
        table, dataset = result.to_pandas(), result.to_xarray()
        variable = dataset[table.columns[-1]]
        assert len(table) == variable.size
        assert table.attrs.keys() == result.numbers().keys()

    def test_holoviews_element_has_data(self, name: str) -> None:
        assert len(result_of(name).to_holoviews()) > 0


@pytest.mark.parametrize("name", PICTURELESS)
def test_result_without_a_picture_shows_its_sentence_and_its_numbers(name: str) -> None:
    result = result_of(name)
    html = result._repr_html_()
    assert "<img" not in html
    assert all(f"<th>{number}</th>" in html for number in result.numbers())
    with pytest.raises(TypeError, match="has no picture"):
        result.plot(Figure().subplots())


def test_plot_returns_axes_in_the_coordinates_of_the_map() -> None:
    axes = result_of("map").plot(Figure().subplots(), picture="times", palette="safe").ax
    assert axes.get_xlim() == (SPEC.find_window().x_low, SPEC.find_window().x_high)
    assert axes.get_ylim() == (SPEC.find_window().ordinate_low, SPEC.find_window().ordinate_high)


def test_paths_have_the_colours_of_their_exits() -> None:
    orbits = result_of("orbits")
    assert isinstance(orbits, SampledOrbits)
    axes = orbits.plot(Figure().subplots(), palette="safe", legend=True).ax
    drawn = {str(line.get_color()): np.asarray(line.get_xydata()) for line in axes.lines}
    colours = {0: PALETTES["safe"].bounded} | dict(enumerate(PALETTES["safe"].channels, 1))
    assert set(drawn) == {colours[fate] for fate in orbits.fate.tolist()}
    for fate in set(orbits.fate.tolist()):
        path = drawn[colours[fate]]
        here = orbits.fate == fate
        ends = np.isnan(path[:, 0])
        assert (~ends).sum() == np.isfinite(orbits.x[here]).sum()
        np.testing.assert_array_equal(path[~ends, 1], orbits.y[here][np.isfinite(orbits.y[here])])
        # No line joins two orbits.
        assert ends[orbits.t.shape[1] :: orbits.t.shape[1] + 1].sum() == here.sum()
    legend = axes.get_legend()
    assert legend is not None
    assert len(legend.get_texts()) == len(drawn)


@pytest.mark.parametrize(
    ("name", "scales"),
    [("statistics", ("log", "linear")), ("decay laws", ("log", "log")), ("separation", ("linear", "log"))],
)
def test_axes_are_logarithmic_where_values_differ_by_factors(name: str, scales: tuple[str, str]) -> None:
    axes = result_of(name).plot(Figure().subplots()).ax
    assert (axes.get_xscale(), axes.get_yscale()) == scales


def test_the_survival_is_drawn_until_the_last_escape() -> None:
    laws = result_of("decay laws")
    assert isinstance(laws, DecayLaws)
    axes = laws.plot(Figure().subplots()).ax
    assert np.asarray(axes.lines[0].get_xdata())[-1] == laws.times[-1]


def test_invalid_options_are_named() -> None:
    axes = Figure().subplots()
    with pytest.raises(ValueError, match="picture='basin'"):
        result_of("map").plot(axes, picture="basin")
    with pytest.raises(ValueError, match="show='p'"):
        result_of("orbit").plot(axes, show="p")
    with pytest.raises(ValueError, match="palette='blue'"):
        POTENTIAL.plot(axes, palette="blue")


def test_a_sweep_draws_the_measure_that_is_asked_for_or_its_first_one() -> None:
    request = SweepSpec(CASES["I"], Plane.X_PX, (0.2, 0.25, 0.3), resolution=(20, 20), t_max=100.0, measures=("basin_entropy",))
    sweep = compute_sweep(request)
    axes = sweep.plot(Figure().subplots()).ax
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), sweep["s_b"])
    assert axes.get_xlabel() == "h"
    assert axes.lines[0].get_label() == "S$_{b}$"
    with pytest.raises(ValueError, match=r"^measure='shares': must be one of basin_entropy$"):
        sweep.plot(Figure().subplots(), measure="shares")
