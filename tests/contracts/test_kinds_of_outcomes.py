"""Every kind of outcome, including that of docs/extending.md, is typed, stored, described and coloured."""

from __future__ import annotations

import numpy as np
import pytest

from engine import Centre, MapSpec, Plane, Potential, compute_map, compute_origin_fates, parse_formula, write_formula
from engine.systems import outcomes
from engine.systems.formulas.formula_parser import read_potential
from engine.systems.outcomes import KINDS, EscapeCircle
from plots.layers.origins import ORIGINS
from plots.pictures.palette import PALETTES, end_places
from tests.extending import example_colours, run_example
from tests.plots.colour_vision import VISIONS
from tests.plots.pictures import test_palette

WELL = "½(x² + y²) − xy²"
DOCK = (0.2, 0.3, 0.05, "the dock")


@pytest.fixture
def station(monkeypatch: pytest.MonkeyPatch) -> type[outcomes.End]:
    """Return the kind of outcome of the example, with colours in each palette."""
    kind: type[outcomes.End] = run_example("Example: add a kind of outcome", vars(outcomes))["Station"]
    monkeypatch.setitem(KINDS, kind.key, kind)
    for palette, colours in zip(PALETTES.values(), example_colours(kind.key), strict=True):
        monkeypatch.setitem(palette.of_kinds, kind.key, colours)
    return kind


def test_each_kind_has_individual_colours_in_each_palette() -> None:
    counts = {tuple((key, len(palette.of_kinds[key])) for key in KINDS) for palette in PALETTES.values()}
    assert len(counts) == 1
    for palette in PALETTES.values():
        assert len(set(palette.ends)) == len(palette.ends)


@pytest.mark.parametrize("name", PALETTES)
def test_colours_of_the_example_pass_the_tests_of_palettes(name: str, station: type[outcomes.End]) -> None:
    palette = PALETTES[name]
    test_palette.test_channels_crossing_classes_characters_and_orbits_have_no_colour_in_common(palette)
    for vision in VISIONS:
        test_palette.test_collisions_and_escape_differ_from_each_other_and_from_exits_and_bounded_orbits(palette, vision)
    for page in test_palette.PAGES:
        test_palette.test_orbits_collisions_and_escape_are_visible_on_the_page(palette, page)


def test_formulas_and_files_keep_ends_of_all_kinds(station: type[outcomes.End]) -> None:
    ends = (Centre(0.1, -0.2, 0.01, "a body"), Centre(0.5, 0.0, 0.02), EscapeCircle(3.0), station(*DOCK))
    potential = parse_formula(
        WELL + "; station the dock (0.2, 0.3) 0.05; centre a body (0.1, −0.2) 0.01; escape 3; centre (½, 0) 0.02"
    )
    assert potential.ends == ends
    assert parse_formula(write_formula(potential)) == potential
    assert read_potential(potential.provenance()) == potential


def test_orbits_end_at_a_station_as_at_a_body_and_in_its_words_and_colour(station: type[outcomes.End]) -> None:
    def map_of(end: outcomes.End) -> tuple[np.ndarray, np.ndarray]:
        potential = Potential("a well", parse_formula(WELL).form, ends=[end])
        found = compute_map(MapSpec(potential, Plane.X_PX, 0.19, (20, 20), t_max=50.0))
        return found.fate, found.escape_time

    of_station, of_body = map_of(station(*DOCK)), map_of(Centre(*DOCK))
    assert (of_station[0] == 3).any()
    np.testing.assert_array_equal(of_station, of_body)
    arrival = parse_formula(WELL + "; station the dock (0.2, 0.3) 0.05").outcomes
    assert arrival[2].sentence == "Arrived at the dock."
    palette = PALETTES["paper"]
    assert palette.entry(3, arrival).label == "arrival at the dock"
    assert palette.entry(3, arrival).colour == palette.ends[end_places(arrival)[2]] == palette.of_kinds["arrival"][0]


def test_passages_from_a_station_have_individual_codes(station: type[outcomes.End]) -> None:
    potential = parse_formula(WELL + "; station the dock (0.2, 0.3) 0.05")
    found = compute_origin_fates(MapSpec(potential, Plane.X_PX, 0.19, (20, 20), t_max=50.0))
    assert ORIGINS.pixels is not None
    columns = ORIGINS.pixels.columns(found, None)
    codes = columns["passage"][0][(found.origin == 3) & (found.fate > 0)]
    assert set(np.array(columns["passage_words"][0])[codes]) == {"backward in time it arrives at the dock"}
