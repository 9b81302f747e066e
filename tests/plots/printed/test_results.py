from __future__ import annotations

import base64
import functools
import re
from collections.abc import Callable
from io import BytesIO

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from engine import (
    CASES,
    MapSpec,
    Plane,
    Result,
    SampledOrbits,
    SweepSpec,
    compute_basin_entropy,
    compute_birkhoff_digits,
    compute_lagrangian_descriptor,
    compute_map,
    compute_origin_fates,
    compute_regularity,
    compute_separation,
    compute_statistics,
    compute_sweep,
    compute_trust,
    compute_uncertainty_exponent,
    compute_wada_test,
    find_lyapunov_orbits,
    find_stable_manifolds,
    fit_decay_laws,
    integrate_orbit,
    judge_orbit,
    review_potential,
    sample_orbits,
    sample_starts,
)
from engine.measures.labels import exit_labels
from plots.pictures.palette import PALETTES

POTENTIAL, STATE = CASES["III"], (0.1, 0.0, 0.05, 0.6)
SPEC = MapSpec(POTENTIAL, Plane.X_PX, 0.36, (40, 40), t_max=200.0)
LARGEST = 100_000

RESULTS: dict[str, Callable[[], Result]] = {
    "potential": lambda: POTENTIAL,
    "review": lambda: review_potential(POTENTIAL),
    "map": lambda: compute_map(SPEC),
    "regularity": lambda: compute_regularity(compute_map(SPEC)),
    "trust": lambda: compute_trust(compute_map(SPEC)),
    "origins": lambda: compute_origin_fates(SPEC),
    "descriptors": lambda: compute_lagrangian_descriptor(compute_map(SPEC), duration=2.0),
    "orbit": lambda: integrate_orbit(POTENTIAL, STATE, t_max=50.0),
    "orbits": lambda: sample_orbits(POTENTIAL, sample_starts(POTENTIAL, 0.36, 12, seed=1), np.linspace(0.0, 30.0, 301)),
    "lyapunov": lambda: find_lyapunov_orbits(POTENTIAL, 0.36)[0],
    "manifolds": lambda: find_stable_manifolds(POTENTIAL, 0.36, images=1),
    "statistics": lambda: compute_statistics(compute_map(SPEC)),
    "decay": lambda: fit_decay_laws(compute_statistics(compute_map(SPEC)), SPEC.t_max),
    "wada": lambda: compute_wada_test(*exit_labels(compute_map(SPEC).fate, bounded=False)),
    "exponent": lambda: compute_uncertainty_exponent(SPEC, pairs=20, separations=8, work=1e6),
    "curves": lambda: compute_sweep(SweepSpec(POTENTIAL, Plane.X_PX, (0.3, 0.36), (20, 20), t_max=100.0, measures="shares")),
    "separation": lambda: compute_separation(POTENTIAL, STATE, (0.1, 0.0, 0.05, 0.60001), 20.0),
    "digits": lambda: compute_birkhoff_digits(POTENTIAL, STATE, 1e3),
}
PICTURELESS: dict[str, Callable[[], Result]] = {
    "entropy": lambda: compute_basin_entropy(*exit_labels(compute_map(SPEC).fate, bounded=True)),
    "verdict": lambda: judge_orbit(integrate_orbit(POTENTIAL, STATE, t_max=50.0)),
}


@functools.cache
def example(name: str) -> Result:
    """One of the results, computed once."""
    return RESULTS[name]()


def shown_picture(result: Result) -> Image.Image:
    (png,) = re.findall(r"data:image/png;base64,([^']*)", result._repr_html_())
    return Image.open(BytesIO(base64.b64decode(png)))


@pytest.mark.parametrize("name", RESULTS)
class TestEveryResult:
    def test_notebook_shows_a_light_picture(self, name: str) -> None:
        result = example(name)
        with shown_picture(result) as picture:
            colours = picture.convert("RGB").getcolors(maxcolors=picture.width * picture.height)
        assert colours is not None
        assert len(colours) > 20
        assert len(result._repr_html_()) < LARGEST

    def test_tables_have_the_same_columns(self, name: str) -> None:
        result = example(name)
        table, dataset = result.to_pandas(), result.to_xarray()
        variable = dataset[table.columns[-1]]
        assert len(table) == variable.size
        assert table.attrs.keys() == result.numbers().keys()

    def test_holoviews_element_has_data(self, name: str) -> None:
        assert len(example(name).to_holoviews()) > 0


@pytest.mark.parametrize("name", PICTURELESS)
def test_result_without_a_picture_shows_its_sentence_and_its_numbers(name: str) -> None:
    result = PICTURELESS[name]()
    html = result._repr_html_()
    assert "<img" not in html
    assert all(f"<th>{number}</th>" in html for number in result.numbers())
    with pytest.raises(TypeError, match="has no picture"):
        result.plot(Figure().subplots())


def test_plot_returns_axes_in_the_coordinates_of_the_map() -> None:
    axes = compute_map(SPEC).plot(Figure().subplots(), picture="times", palette="safe")
    assert axes.get_xlim() == (SPEC.find_window().x_low, SPEC.find_window().x_high)
    assert axes.get_ylim() == (SPEC.find_window().ordinate_low, SPEC.find_window().ordinate_high)


def test_paths_have_the_colours_of_their_exits() -> None:
    orbits = example("orbits")
    assert isinstance(orbits, SampledOrbits)
    axes = orbits.plot(Figure().subplots(), palette="safe")
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


def test_invalid_options_are_named() -> None:
    axes = Figure().subplots()
    with pytest.raises(ValueError, match="picture='basin'"):
        compute_map(SPEC).plot(axes, picture="basin")
    with pytest.raises(ValueError, match="show='p'"):
        integrate_orbit(POTENTIAL, STATE, t_max=20.0).plot(axes, show="p")
    with pytest.raises(ValueError, match="palette='blue'"):
        POTENTIAL.plot(axes, palette="blue")
