"""Each entry of the table of measures has numbers and words for files, tables, the page and figures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from engine import (
    CASES,
    MEASURES,
    EscapeMap,
    MapSpec,
    Measure,
    Plane,
    SweepSpec,
    Window,
    compute_flux,
    compute_map,
    compute_regularity,
    compute_sweep,
)
from engine.measures.compute import compute_point, measure_map
from engine.measures.measured_map import MeasuredMap, SweepPoint
from engine.measures.table import curve_names
from tests.extending import run_example

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def sea() -> EscapeMap:
    """Return a map with regular and chaotic bounded orbits. Its pixels are pairs of mirror images."""
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.13, (30, 30), t_max=2e3))


@pytest.fixture(scope="module")
def example() -> Measure:
    """Return the entry of the example in docs/extending.md."""
    return run_example("Example: add a measure", {"__name__": __name__})["BOUNDARY"]


def test_the_example_of_the_guide_is_measured_like_any_other(
    sea: EscapeMap, example: Measure, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("engine.measures.compute.MEASURES", {example.name: example})
    found = measure_map(sea, example.name)
    assert 0.0 < found.low < found.share < found.high < 1.0
    assert example.sentence is not None
    assert example.sentence(found).endswith("of the starts are on a boundary.")
    point = SweepPoint(sea.spec, (("h", 0.13),), (example.name,), (0, 1, 2), sea.outcomes)
    dataset = compute_point(point, escape_map=sea)
    assert dataset["boundary_share"].dims == ("h",)
    assert (dataset["boundary_share_low"], dataset["boundary_share_high"]) == (found.low, found.high)


def test_documents_list_all_measures() -> None:
    text = (ROOT / "docs" / "sweeps.md").read_text(encoding="utf-8")
    assert [name for name in MEASURES if f"| `{name}` |" not in text] == []


@pytest.mark.parametrize("measure", MEASURES.values(), ids=MEASURES)
def test_an_entry_has_a_title_and_a_short_meaning(measure: Measure) -> None:
    assert measure.title
    assert 3 <= len(measure.meaning.split()) <= 6
    assert bool(measure.curve.axis) is bool(measure.help)


def test_names_of_numbers_are_unique() -> None:
    names = [quantity.name for measure in MEASURES.values() for quantity in measure.quantities]
    assert len(names) == len(set(names))


def test_a_measure_that_is_not_defined_gives_no_number() -> None:
    for measure in MEASURES.values():
        for quantity in measure.quantities:
            for _, value, attributes in quantity.variables(None).values():
                assert np.isnan(value)
                assert attributes.keys() == {"long_name", "units"}


def test_the_exponent_of_a_map_over_energies_is_measured_where_an_exit_opens_among_them() -> None:
    spec = MapSpec(CASES["II"], Plane.X_H, (0.2, 0.3), (20, 20), t_max=100.0)
    exponent = measure_map(compute_map(spec), "uncertainty_exponent")
    assert 0.0 < exponent.exponent < 1.0
    closed = replace(spec, energy=(0.1, 0.16))
    assert measure_map(compute_map(closed), "uncertainty_exponent") is None


def test_curves_have_the_numbers_of_the_table(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("engine.measures.table.WORK", 1e7)
    sweep = compute_sweep(SweepSpec(CASES["II"], Plane.X_PX, (0.2,), (30, 30), t_max=100.0, measures=curve_names()))
    wanted = {quantity.name for name in curve_names() for quantity in MEASURES[name].quantities}
    assert wanted <= set(sweep.to_pandas().columns)
    assert sweep["mixed_decay_rate"][0] == compute_flux(CASES["II"], 0.2).decay_rate


def test_the_chaotic_share_of_all_bounded_starts_is_that_of_the_regularity(sea: EscapeMap) -> None:
    found = measure_map(sea, "chaotic_share")
    assert found.share == compute_regularity(sea).chaotic_share
    assert found.judged == np.count_nonzero(sea.fate == 0)


def test_sampled_starts_have_the_same_character_as_among_all_starts(sea: EscapeMap) -> None:
    whole = compute_regularity(sea).character
    characters = MeasuredMap(sea, effort=0.1).find_characters()
    bounded = np.flatnonzero(sea.fate == 0)
    chosen = np.random.default_rng(0).choice(bounded, 200, replace=False)
    assert bounded.size > 200
    np.testing.assert_array_equal(characters, whole.ravel()[chosen])


def test_only_the_bounded_starts_in_a_box_are_judged(sea: EscapeMap) -> None:
    box = Window(-0.2, 0.2, -0.2, 0.2)
    inside = np.ix_(np.abs(sea.ordinate) <= 0.2, np.abs(sea.x) <= 0.2)
    found = measure_map(sea, "chaotic_share", box)
    assert found.judged == np.count_nonzero(sea.fate[inside] == 0)
    assert found.chaotic == np.count_nonzero(compute_regularity(sea).character[inside] == 2)
