"""Figures show the values of their maps in the colours of the paper."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from PIL import Image, ImageColor

from engine import CASES, Fate, Plane, classify_orbits
from plots.layers.regularity import CODES
from plots.pictures.palette import PAPER
from reproduction.figures.all_figures import FIGURES
from reproduction.figures.sticky_figures import LONGEST_DRAWN, find_displayed_orbit
from reproduction.map_cache import MapCache
from reproduction.paper_ranges import curve_energies, nine_energies, plane_energies
from reproduction.quality import FULL, QUICK, Quality
from reproduction.sample_orbits import SHOWN_CROSSINGS, find_sample_starts
from reproduction.super_sticky import SuperStickySearch

TINY = Quality(
    "tiny", resolution=15, t_max=300.0, curve_points=7, search_resolution=9,
    search_t_max=2000.0, classified_resolution=10, exponent_work=1e4,
)  # fmt: skip
# For each family of figures: a case to draw, the number of maps, the numbers of lines of the panels, and the labels of both axes.
DRAWN = {
    "potential": ("II", 0, [46, 6, 9], {"$x$"}, {"$y$"}),
    "basins-xy": ("III", 9, [0] * 9, {"$x$"}, {"$y$"}),
    "times-xy": ("I", 9, [0] * 10, {"$x$"}, {"$y$", r"escape time $t_{\mathrm{esc}}$"}),
    "basins-xpx": ("I", 9, [0] * 9, {"$x$"}, {r"$\dot{x}$"}),
    "times-xpx": ("II", 9, [0] * 10, {"$x$"}, {r"$\dot{x}$", r"escape time $t_{\mathrm{esc}}$"}),
    "crossings-xpx": ("III", 9, [0] * 9, {"$x$"}, {r"$\dot{x}$"}),
    "percentages": ("III", 0, [5, 5], {"$h$"}, {"percentage of starts"}),
    "xh": ("II", 1, [0], {"$x$"}, {"$h$"}),
    "statistics": ("I", 0, [3, 3, 9, 9], {"$h$", "$n$"}, {"$N_e/N_0$", "$N_{de}/N_0$", "$dN_n/N_0$", "$p_n$"}),
    "survival": ("II", 0, [1, 1, 1], {"$t$"}, {"$S(t)$"}),
}
FAMILIES = tuple(DRAWN)


@pytest.fixture(scope="module")
def cache() -> MapCache:
    return MapCache(TINY)


def panels(figure: Figure) -> list[Axes]:
    return [axes for axes in figure.axes if axes.get_title(loc="left")]


def rgba(colours: list[str]) -> np.ndarray:
    return np.array([ImageColor.getcolor(colour, "RGBA") for colour in colours], np.uint8)


def pixels_of(axes: Axes) -> np.ndarray:
    """Return the pixels of a panel, row 0 lowest, as in the map."""
    return np.asarray(axes.images[0].get_array())[::-1]


def test_every_case_has_every_figure() -> None:
    wanted = {f"{case}-{family}" for case in CASES for family in FAMILIES} | {"III-regular-chaotic", "III-super-sticky"}
    assert set(FIGURES) == wanted
    assert all(entry.name == name for name, entry in FIGURES.items())


@pytest.mark.parametrize("family", FAMILIES)
def test_figures_have_a_title_and_their_maps_lines_and_labels(family: str, cache: MapCache) -> None:
    case, maps, lines, across, up = DRAWN[family]
    figure = FIGURES[f"{case}-{family}"].draw(cache)
    assert case in figure.get_suptitle()
    assert sum(len(axes.images) for axes in figure.axes) == maps
    assert [sum(len(line.get_xdata()) > 0 for line in axes.lines) for axes in figure.axes] == lines
    assert {axes.get_xlabel() for axes in figure.axes} - {""} == across
    assert {axes.get_ylabel() for axes in figure.axes} - {""} == up


@pytest.mark.parametrize("place", [0, 4, 8])
def test_the_pixels_of_a_basin_panel_have_the_colours_of_their_channels(place: int, cache: MapCache) -> None:
    axes = panels(FIGURES["I-basins-xpx"].draw(cache))[place]
    frame = cache.map("I", Plane.X_PX, nine_energies("I")[place])
    known = frame.fate >= Fate.BOUNDED
    wanted = rgba([PAPER.bounded, *PAPER.channels])[frame.fate[known]]
    np.testing.assert_array_equal(pixels_of(axes)[known], wanted)
    assert not pixels_of(axes)[~known][:, 3].any()


def test_a_map_is_drawn_at_its_window(cache: MapCache) -> None:
    axes = panels(FIGURES["II-basins-xpx"].draw(cache))[0]
    window = cache.map("II", Plane.X_PX, nine_energies("II")[0]).spec.find_window()
    assert tuple(axes.images[0].get_extent()) == window.edges
    edges = np.array([cache.map("II", Plane.X_PX, energy).spec.find_window().edges for energy in nine_energies("II")])
    # All panels show the smallest window that contains the windows of all maps.
    assert axes.get_xlim() == (edges[:, 0].min(), edges[:, 1].max())
    assert axes.get_ylim() == (edges[:, 2].min(), edges[:, 3].max())


def test_escape_times_of_all_panels_share_one_scale(cache: MapCache) -> None:
    figure = FIGURES["I-times-xpx"].draw(cache)
    shown: dict[float, tuple[int, ...]] = {}
    for axes, energy in zip(panels(figure), nine_energies("I"), strict=True):
        frame = cache.map("I", Plane.X_PX, energy)
        left = frame.fate > Fate.BOUNDED
        shown |= dict(zip(frame.escape_time[left].tolist(), map(tuple, pixels_of(axes)[left].tolist()), strict=True))
    scale = {tuple(colour): place for place, colour in enumerate(rgba(list(PAPER.escape_time)).tolist())}
    places = [scale[shown[time]] for time in sorted(shown)]
    assert places == sorted(places)
    assert places[0] < 30 < places[-1]


def test_regular_orbits_are_cyan_chaotic_magenta_and_escaping_white(cache: MapCache) -> None:
    axes = FIGURES["III-regular-chaotic"].draw(cache).axes[0]
    frame = cache.map("III", Plane.X_PX, 0.26)
    character, pixels = cache.regularity(frame).character, pixels_of(axes)
    for code, colour in ((code.code, code.entry(PAPER).colour) for code in CODES[1:3]):
        assert np.all(pixels[character == code] == rgba([colour])[0])
    assert (frame.fate > Fate.BOUNDED).any()
    assert not pixels[frame.fate > Fate.BOUNDED][:, 3].any()


def test_curves_of_symmetric_channels_are_both_visible(cache: MapCache) -> None:
    lines = {line.get_label(): line for line in FIGURES["III-percentages"].draw(cache).axes[1].lines}
    first, second = lines["exit 1"], lines["exit 2"]
    np.testing.assert_array_equal(np.asarray(first.get_ydata()), np.asarray(second.get_ydata()))
    assert (first.get_linestyle(), second.get_linestyle()) == ("-", "--")
    assert list(lines.values()).index(first) < list(lines.values()).index(second)


def test_orbits_of_the_potential_figure_have_the_colour_of_their_channel(cache: MapCache) -> None:
    escapes = FIGURES["III-potential"].draw(cache).axes[2]
    by_colour = {to_rgba(line.get_color()): line for line in escapes.lines if len(np.asarray(line.get_xdata())) > 1}
    saddles = CASES["III"].saddles
    for channel in range(1, 5):
        line = by_colour[to_rgba(PAPER.channels[channel - 1])]
        end = np.array([np.asarray(line.get_xdata())[-1], np.asarray(line.get_ydata())[-1]])
        assert 1 + int(np.argmin(np.hypot(*(saddles - end).T))) == channel


def test_sample_orbits_cross_a_few_times_before_they_escape(cache: MapCache) -> None:
    frame = cache.map("II", Plane.X_PX, 0.2)
    starts = find_sample_starts(frame)
    outcomes = classify_orbits(CASES["II"], 0.2, np.array(list(starts.values())), 300.0)
    assert outcomes.fate.tolist() == list(starts) == [1, 2, 3]
    assert all(SHOWN_CROSSINGS <= n <= SHOWN_CROSSINGS + 2 for n in outcomes.crossings.tolist())


def test_the_published_and_the_new_fit_are_drawn_over_the_shares(cache: MapCache) -> None:
    escaped = FIGURES["I-statistics"].draw(cache).axes[0]
    data, paper, own = escaped.lines
    table = cache.curves("I", Plane.X_PX)
    shares = table["share"][:, 1:].sum(axis=1)
    np.testing.assert_array_equal(np.asarray(data.get_ydata()), shares)
    h = np.asarray(paper.get_xdata(), float)
    np.testing.assert_allclose(np.asarray(paper.get_ydata()), 1.0 / (1.0 + np.exp(8.0 - 60.0 * h)), rtol=1e-9)
    assert np.abs(np.interp(table.values, h, np.asarray(own.get_ydata())) - shares).max() < 0.15


class CacheWithSearch(MapCache):
    """A cache with a given search."""

    def __init__(self, search: SuperStickySearch) -> None:
        super().__init__(TINY)
        self.search = search

    def super_sticky(self) -> SuperStickySearch:
        return self.search


def search_with(times: list[float], cache: MapCache) -> SuperStickySearch:
    count = len(times)
    fate = np.where(np.isfinite(times), 2, 0).astype(np.int8)
    search = cache.super_sticky()
    arrays: dict[str, Any] = {"x": np.zeros(count), "ordinate": np.zeros(count), "states": np.zeros((count, 4))}
    return replace(search, **arrays, fate=fate, escape_time=np.array(times), crossings=np.zeros(count, np.int32))


def test_the_last_escape_within_the_axis_is_shown(cache: MapCache) -> None:
    assert find_displayed_orbit(search_with([2e5, np.nan, 0.9 * LONGEST_DRAWN, 2.0 * LONGEST_DRAWN, 4e5], cache)) == 2
    assert find_displayed_orbit(search_with([3.0 * LONGEST_DRAWN, np.nan, 2.0 * LONGEST_DRAWN], cache)) == 2
    assert find_displayed_orbit(search_with([np.nan, np.nan], cache)) is None


def test_the_band_of_a_late_escape_ends_at_its_exit(cache: MapCache) -> None:
    frame = cache.map("III", Plane.X_PX, 0.26)
    row, column = np.argwhere(frame.fate >= 1)[0]
    state = frame.spec.start_states(frame.x[[column]], frame.ordinate[[row]])
    leaving = replace(search_with([float(frame.escape_time[row, column])], cache), states=state)
    figure = FIGURES["III-super-sticky"].draw(CacheWithSearch(leaving))
    band = figure.axes[1].collections[0].get_paths()[0].vertices
    assert f"exit {frame.fate[row, column]}" in figure.get_suptitle()
    assert 1.003 < float(np.asarray(band)[:, 1].max()) < 1.017


def test_files_are_reproducible_and_state_their_origin(cache: MapCache) -> None:
    entry = FIGURES["II-xh"]
    files = entry.files(cache)
    assert files == entry.files(cache)
    with Image.open(BytesIO(files["II-xh.png"])) as picture:
        picture.load()
        assert picture.info["Software"].startswith("escape-explorer ")
        assert "tiny quality, 15 x 15 starts" in picture.info["Comment"]
    assert files["II-xh.pdf"].startswith(b"%PDF")
    assert files["II-xh.pdf"].rstrip().endswith(b"%%EOF")


@pytest.mark.parametrize("quality", [FULL, QUICK])
@pytest.mark.parametrize("case", CASES)
def test_curves_span_the_range_of_the_paper(case: str, quality: Quality) -> None:
    energies = curve_energies(case, quality.curve_points)
    assert (energies[0], energies[-1]) == {"I": (0.13, 0.5), "II": (0.17, 0.5), "III": (0.26, 0.6)}[case]
    assert len(set(energies)) == quality.curve_points
    assert plane_energies(case) == {"I": (0.125, 0.5), "II": (pytest.approx(1 / 6), 0.5), "III": (0.25, 1.0)}[case]
