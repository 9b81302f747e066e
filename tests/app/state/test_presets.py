"""Presets are valid views that agree with their captions."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl

import numpy as np
import pytest
from PIL import Image

import app
from app.runtime.process_state import ProcessState
from app.state.permalink import preset_view, read_link, write_link
from app.state.system_review import review_catalogue_entry
from app.state.view import Analysis, View
from app.state.view_state import ViewState
from engine import (
    CASES,
    POTENTIALS,
    Fate,
    MapSpec,
    Orbit,
    PeriodicOrbit,
    Plane,
    SpecialKind,
    Stability,
    classify_orbits,
    compute_flux,
    compute_map,
    continue_family,
    find_periodic_orbit,
    integrate_orbit,
    sample_starts,
    start_states,
)
from plots.layers.table import TITLES
from plots.links.presets import GROUPS, PRESETS, Preset
from plots.pictures.palette import MOST_ORBITS

THUMBNAILS = Path(app.__file__).parent / "static" / "gallery"
LARGEST_THUMBNAIL = 15_000

each_preset = pytest.mark.parametrize("preset", PRESETS, ids=lambda preset: preset.key)

# The kernels of the barred galaxy take more than ten seconds to compile.
COMPILED_LONG = ("bar",)


def marked(key: str, value: Any) -> Any:
    """Return a parameter of a test that integrates orbits, marked as slow if its kernels take long to compile."""
    return pytest.param(value, id=key, marks=pytest.mark.slow if key in COMPILED_LONG else ())


def view_of(key: str) -> View:
    return next(preset_view(preset) for preset in PRESETS if preset.key == key)


def spec_of(view: View) -> MapSpec:
    return view.map_spec(review_catalogue_entry(view.system.case))


def start_of(view: View, x: float, ordinate: float) -> np.ndarray:
    return start_states(POTENTIALS[view.system.case], view.plane, view.energy, np.array([x]), np.array([ordinate]))[0]


def fate_of(view: View, x: float, ordinate: float, t_max: float) -> int:
    potential = view.plane.potential_at(POTENTIALS[view.system.case], x, ordinate)
    energy = view.plane.energies(view.energy, x, ordinate)
    return int(classify_orbits(potential, energy, start_of(view, x, ordinate)[None], t_max).fate[0])


def fates(view: View) -> list[int]:
    return [fate_of(view, *start, view.t_max) for start in view.starts]


def integrate(view: View) -> Orbit:
    return integrate_orbit(POTENTIALS[view.system.case], start_of(view, *view.starts[0]), view.t_max)


def test_keys_and_titles_are_unique() -> None:
    assert len({preset.key for preset in PRESETS}) == len({preset.title for preset in PRESETS}) == len(PRESETS)


def test_presets_cover_all_groups_cases_planes_and_pictures() -> None:
    places = [preset for preset in PRESETS if preset.group == "Places"]
    assert len(places) >= 12
    assert {preset.group for preset in PRESETS} == set(GROUPS)
    assert {preset_view(preset).system.case for preset in places} == set(CASES)
    assert {preset_view(preset).plane for preset in PRESETS} >= set(Plane)
    assert {preset.picture for preset in PRESETS} == set(TITLES)


@each_preset
def test_a_preset_is_a_valid_view_with_a_link_and_a_small_picture(preset: Preset) -> None:
    assert read_link(dict(parse_qsl(preset.link, strict_parsing=True)))[1] == []
    state = ViewState(**preset_view(preset).values())
    assert state.map_spec() == spec_of(preset_view(preset))
    values, problems = read_link(dict(parse_qsl(write_link(state)[1:], strict_parsing=True)))
    assert (ViewState(**values).view, problems) == (preset_view(preset), [])
    file = THUMBNAILS / f"{preset.key}.png"
    assert file.stat().st_size <= LARGEST_THUMBNAIL
    with Image.open(file) as picture:
        assert picture.size == (160, 160)


def test_examples_show_the_analyses_that_they_explain() -> None:
    shown = {"threads": "manifolds", "passages": "origins", "doubt": "trust", "owl": "judge"}
    shown |= dict.fromkeys(("divided", "doubled", "direct"), "periodic")
    assert {key: key for key, layer in shown.items() if layer in view_of(key).layers} == {key: key for key in shown}


def test_a_server_with_limits_shows_every_preset(start_state: Callable[..., ProcessState]) -> None:
    start_state(longest_t_max=1e3, largest_resolution=112)
    for preset in PRESETS:
        state = ViewState(**preset_view(preset).within_limits().values())
        assert (state.t_max, state.resolution) == (min(preset_view(preset).t_max, 1e3), 112)


def test_every_thumbnail_has_a_preset() -> None:
    assert {file.stem for file in THUMBNAILS.iterdir()} == {preset.key for preset in PRESETS}


@pytest.mark.parametrize("preset", [marked(preset.key, preset) for preset in PRESETS])
def test_starts_are_in_the_window_and_allowed(preset: Preset) -> None:
    view, spec = preset_view(preset), spec_of(preset_view(preset))
    # Presets that show many orbits have no chosen orbits.
    fewest = 0 if view.analysis == Analysis.WATCH else 1
    assert fewest <= len(set(view.starts)) == len(view.starts) <= MOST_ORBITS
    for x, ordinate in view.starts:
        assert spec.pixel_at(x, ordinate) is not None
        assert preset.key in FATES or fate_of(view, x, ordinate, 10.0) >= Fate.BOUNDED


FATES = {
    "two-exits": [1, 2],
    "four-exits": [1, 2, 3, 4],
    "three-meet": [1, 2, 3],
    "crossroads": [0, 1, 2, 3, 4],
    "closer": [1, 2, 3, 4],
    "shares": [1, 2, 0],
    "owl": [0, 0, 0, 0],
    "ajar": [1, 2, 3, 0],
    "section": [0, 0, 1, 2, 3],
    "tangential": [1, 2, 3],
    "launch": [1, 2, 3, 4, 0],
    "strength": [0, 1, 2, 2],
    "two-stars": [1, 2, 3, 0],
    "moon": [2, 3, 0],
    "planet": [1, 2, 3, 0],
    "cluster": [1, 2, 0],
    "bar": [1, 2, 0],
    "spindle": [1, 1, 0],
    "divided": [0, 0, 1],
    "doubled": [0, 0, 1],
    "direct": [1, 0, 0],
}


@pytest.mark.parametrize("key", [marked(key, key) for key in FATES])
def test_fates_agree_with_the_caption(key: str) -> None:
    assert fates(view_of(key)) == FATES[key]


def test_shares_agree_with_the_caption() -> None:
    view = view_of("shares")
    found = compute_map(spec_of(view))
    shares = found.fractions()
    direct = np.mean((found.fate > Fate.BOUNDED)[found.interior] & (found.crossings == 0)[found.interior])
    assert shares[Fate.BOUNDED] < 0.001
    assert round(shares[1], 2) == 0.55
    assert round(shares[2], 2) == 0.45
    # The caption says "three quarters". The tolerance is not statistical, because the pixels are a grid.
    assert direct == pytest.approx(0.75, abs=0.02)


def test_the_limit_of_stability_agrees_with_the_caption() -> None:
    view = view_of("ceiling")
    spec = replace(spec_of(view), resolution=(2, 400))
    found = compute_map(replace(spec, window=replace(spec.window, x_low=-1e-3, x_high=1e-3)))
    highest = found.ordinate[(found.fate == Fate.BOUNDED).all(axis=1)].max()
    assert highest == pytest.approx(0.5817, abs=5e-4)


@pytest.mark.slow
def test_the_sticky_orbit_looks_regular_and_escapes_late() -> None:
    orbit = integrate(view_of("super-sticky"))
    assert orbit.fate >= 1
    # The escape time varies, because rounding differs between processors, and chaos amplifies the differences.
    assert 22_000 < orbit.escape_time < 60_000
    early = orbit.t < 20_000
    assert orbit.sali[early].min() > 1e-4
    assert orbit.r2[early].max() < 0.91


def periodic_near(view: View, x: float, px: float, returns: int) -> PeriodicOrbit:
    return find_periodic_orbit(POTENTIALS[view.system.case], start_of(view, x, px), returns)


def changes_of(orbit: PeriodicOrbit, energy: float) -> dict[SpecialKind, float]:
    """Return the energies of the special points of a family up to an energy that are no resonances."""
    special = continue_family(orbit, energy).special
    return {point.kind: round(point.energy, 4) for point in special if point.kind is not SpecialKind.RESONANCE}


def test_the_island_that_divides_has_the_orbits_of_the_caption() -> None:
    view = view_of("divided")
    middle, *sides = (periodic_near(view, x, 0.2935, 1) for x in (0.0, -0.07, 0.07))
    assert middle.stability is Stability.UNSTABLE
    assert [each.stability for each in sides] == [Stability.STABLE] * 2
    assert changes_of(middle, 0.31) == {SpecialKind.BRANCHING: 0.3114}


def test_the_period_doubles_at_the_energy_of_the_caption() -> None:
    view = view_of("doubled")
    cross, rings = periodic_near(view, 0.1312, 0.2867, 1), periodic_near(view, 0.1227, 0.2871, 2)
    assert (cross.stability, rings.stability) == (Stability.REFLECTING, Stability.STABLE)
    assert (cross.returns, rings.returns) == (1, 2)
    assert changes_of(cross, 0.3175) == {SpecialKind.DOUBLING: 0.3187}
    (later,) = continue_family(rings, 0.3201).at(0.32)
    assert later.stability is Stability.REFLECTING


def test_family_g_changes_its_stability_at_the_energy_of_the_caption() -> None:
    """M. Hénon, Astronomy & Astrophysics 1, 223 (1969): the constant there, −2h, is 4.5."""
    view = view_of("direct")
    middle, *rings = (periodic_near(view, x, 0.0, 1) for x in (0.2987, 0.5368, 0.1069))
    assert middle.stability is Stability.UNSTABLE
    assert [each.stability for each in rings] == [Stability.STABLE] * 2
    special = continue_family(middle, -2.3).special
    assert [(point.kind, round(point.energy, 2)) for point in special] == [(SpecialKind.BRANCHING, -2.25)]
    # "Follow the family" begins from the chosen orbit.
    chosen = find_periodic_orbit(POTENTIALS["Hill"], start_of(view, *view.starts[view.chosen]), t_max=view.t_max)
    assert chosen.period == pytest.approx(middle.period, rel=1e-9)


def near(share: float, count: int) -> Any:
    """Match a share of `count` random orbits that a caption rounds to 1 %. The probability of a false alarm is 4e-8."""
    return pytest.approx(share, abs=0.005 + 5.5 * math.sqrt(share * (1.0 - share) / count))


def test_the_caption_of_the_draining_well_has_the_share_of_remaining_orbits() -> None:
    count = 40_000
    times = classify_orbits(CASES["III"], 0.45, sample_starts(CASES["III"], 0.45, count, rng=1), t_max=50.0).escape_time
    left = [float(np.mean(~(times <= t))) for t in (5.0, 50.0)]
    assert left == [near(0.42, count), near(1 / 7, count)]
    assert math.exp(-50.0 * compute_flux(CASES["III"], 0.45).decay_rate) == pytest.approx(1 / 4000, rel=0.1)


def test_the_orbits_of_the_torn_disc_leave_when_the_caption_says() -> None:
    view = view_of("torn")
    window, ((x, px),) = spec_of(view).find_window(), view.starts
    random, count = np.random.default_rng(4), 20_000
    angle, radius = 2.0 * np.pi * random.random(count), 10.0**view.watched.radius * np.sqrt(random.random(count))
    xs = x + 0.5 * (window.x_high - window.x_low) * radius * np.cos(angle)
    ps = px + 0.5 * (window.ordinate_high - window.ordinate_low) * radius * np.sin(angle)
    outcomes = classify_orbits(CASES["III"], 0.45, start_states(CASES["III"], Plane.X_PX, 0.45, xs, ps), t_max=100.0)
    assert np.nanmin(outcomes.escape_time) > 15.0
    shares = [float(np.mean(outcomes.fate == channel)) for channel in (1, 2, 3, 4)]
    assert (min(shares), max(shares)) == (near(1 / 6, count), near(0.3, count))
