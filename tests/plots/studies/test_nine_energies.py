"""The study of nine energies shows the maps of its energies, opens the one that is clicked, and counts its escapes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, MEASURES, MapSpec, Plane, SweepSpec, System, compute_map, compute_statistics, compute_sweep
from engine.foundations.wording import format_number
from engine.results import Sweep
from engine.systems.catalogue.published_fits import PAPER_FITS
from engine.systems.catalogue.table import PAPER_ENERGIES
from engine.systems.review.potential_review import review_system
from plots.pictures.charts import Shape
from plots.pictures.image_columns import fate_codes
from plots.pictures.palette import PAPER
from plots.pictures.setting import NO_SETTINGS
from plots.studies.escape_charts import FEWEST_REMAINING
from plots.studies.map_tiles import BESIDE
from plots.studies.nine_energies import ENERGIES, NINE_ENERGIES, TILES
from plots.studies.study import Click, Subject

MARKED = PAPER_ENERGIES["I"].marked


def subject(name: str, plane: Plane = Plane.X_PX) -> Subject:
    system = System(name)
    return Subject(system, system.potential, plane, 0.2, review_system(system).energies, 200.0)


def small(spec: SweepSpec) -> Sweep:
    return compute_sweep(replace(spec, resolution=(24, 24)))


@pytest.fixture(scope="module")
def found() -> Sweep:
    (spec,) = NINE_ENERGIES.job(subject("I"), "").arguments
    return small(spec)


def test_the_maps_of_a_case_have_the_energies_of_the_paper(found: Sweep) -> None:
    assert tuple(found.values) == MARKED


def test_other_systems_have_energies_over_their_whole_range() -> None:
    about = subject("HH")
    (spec,) = NINE_ENERGIES.job(about, "").arguments
    assert len(spec.values) == ENERGIES
    assert spec.values[0] == pytest.approx(about.energies.low, abs=1e-3)
    assert spec.values[-1] == pytest.approx(about.energies.high, abs=1e-3)


def test_each_tile_is_the_map_of_its_energy(found: Sweep) -> None:
    tiles = NINE_ENERGIES.charts(found, PAPER, NO_SETTINGS)[0].tiles
    window = found.dataset.attrs["window"]
    for tile, h in zip(tiles, MARKED, strict=True):
        alone = compute_map(MapSpec(CASES["I"], Plane.X_PX, h, (24, 24), window, t_max=200.0))
        np.testing.assert_array_equal(tile.codes, fate_codes(alone.fate, CASES["I"].outcomes))
        assert tile.text.startswith(f"h = {h:g}\n")


def test_a_tile_keeps_its_place_while_others_are_missing(found: Sweep) -> None:
    tiles = NINE_ENERGIES.charts(found, PAPER, NO_SETTINGS)[0].tiles
    part = replace(found, dataset=found.dataset.isel(h=[0, 4, 8]))
    places = [(tile.left, tile.bottom) for tile in NINE_ENERGIES.charts(part, PAPER, NO_SETTINGS)[0].tiles]
    assert places == [(tiles[k].left, tiles[k].bottom) for k in (0, 4, 8)]
    assert not NINE_ENERGIES.is_complete(part)


@pytest.mark.parametrize("number", range(ENERGIES))
def test_a_click_opens_the_map_under_it(found: Sweep, number: int) -> None:
    tile = NINE_ENERGIES.charts(found, PAPER, NO_SETTINGS)[0].tiles[number]
    about = subject("I")
    click = Click(TILES.name, tile.left + 0.9, tile.bottom + 0.1)
    assert NINE_ENERGIES.changes(about, "", found, click) == {"energy": MARKED[number], "plane": Plane.X_PX, "window": None}
    assert NINE_ENERGIES.changes(about, "", found, click._replace(y=tile.bottom - 0.1)) == {}


@pytest.mark.parametrize("measure", BESIDE.choices)
def test_any_measure_is_written_above_the_maps(found: Sweep, measure: str) -> None:
    tiles = NINE_ENERGIES.charts(found, PAPER, {BESIDE.name: measure})[0].tiles
    written = [tile.text.split("\n")[1] for tile in tiles]
    if measure == "shares":
        assert written == [f"{format_number(100.0 * share, 3)} % stay" for share in found["share"][:, 0]]
    else:
        numbers = found[next(iter(MEASURES[measure].labels))]
        assert written == [format_number(number, 3) if np.isfinite(number) else "" for number in numbers]


def test_lines_against_crossings_are_those_of_the_statistics_of_each_map(found: Sweep) -> None:
    _, _, shares, probabilities = NINE_ENERGIES.charts(found, PAPER, NO_SETTINGS)
    for k, (share, probability) in enumerate(zip(shares.series, probabilities.series, strict=True)):
        statistics = compute_statistics(found.dataset.isel(h=k))
        counts = np.nan_to_num(share.y) * statistics.starts
        np.testing.assert_allclose(counts, statistics.crossing_counts[: counts.size])
        inside = statistics.decided - np.concatenate([[0], np.cumsum(counts)[:-1]])
        np.testing.assert_array_equal(np.isfinite(probability.y), inside > FEWEST_REMAINING - 0.5)
        np.testing.assert_allclose(
            probability.y[inside > FEWEST_REMAINING - 0.5], (counts / inside)[inside > FEWEST_REMAINING - 0.5]
        )


def test_published_fits_are_drawn_on_the_plane_of_the_paper_only(found: Sweep) -> None:
    chart = NINE_ENERGIES.charts(found, PAPER, NO_SETTINGS)[1]
    fits = [one for one in chart.series if one.shape is Shape.DASHED]
    np.testing.assert_allclose(fits[0].y, PAPER_FITS["I"].escaped(fits[0].x))
    np.testing.assert_allclose(fits[1].y, PAPER_FITS["I"].direct(fits[1].x))
    (spec,) = NINE_ENERGIES.job(subject("I", Plane.X_Y), "").arguments
    elsewhere = NINE_ENERGIES.charts(small(replace(spec, values=MARKED[-1:])), PAPER, NO_SETTINGS)[1]
    assert all(one.shape is not Shape.DASHED for one in elsewhere.series)


def test_there_are_no_charts_before_the_first_map(found: Sweep) -> None:
    assert NINE_ENERGIES.charts(replace(found, dataset=found.dataset.isel(h=[])), PAPER, NO_SETTINGS) == []
