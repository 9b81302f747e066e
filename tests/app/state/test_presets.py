"""Presets are valid views that agree with their captions."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from urllib.parse import parse_qsl

import numpy as np
import pytest
from PIL import Image

import app
from app.state.permalink import read_link, write_link
from app.state.presets import GROUPS, PRESETS, Preset
from app.state.view_state import Analysis, ViewState
from engine import (
    CASES,
    POTENTIALS,
    Fate,
    Orbit,
    Plane,
    classify_orbits,
    compute_flux,
    compute_map,
    integrate_orbit,
    sample_starts,
    start_states,
)
from plots.pictures.map_images import TITLES
from plots.pictures.palette import MOST_ORBITS

THUMBNAILS = Path(app.__file__).parent / "static" / "gallery"
LARGEST_THUMBNAIL = 15_000

each_preset = pytest.mark.parametrize("preset", PRESETS, ids=lambda preset: preset.key)


def named(key: str) -> Preset:
    return next(preset for preset in PRESETS if preset.key == key)


def start_of(preset: Preset, x: float, ordinate: float) -> np.ndarray:
    return start_states(POTENTIALS[preset.case], preset.plane, preset.energy, np.array([x]), np.array([ordinate]))[0]


def fate_of(preset: Preset, x: float, ordinate: float, t_max: float) -> int:
    potential = preset.plane.potential_at(POTENTIALS[preset.case], x, ordinate)
    energy = preset.plane.energies(preset.energy, x, ordinate)
    return int(classify_orbits(potential, energy, start_of(preset, x, ordinate)[None], t_max).fate[0])


def fates(preset: Preset) -> list[int]:
    return [fate_of(preset, *start, preset.t_max) for start in preset.starts]


def integrate(preset: Preset) -> Orbit:
    return integrate_orbit(POTENTIALS[preset.case], start_of(preset, *preset.starts[0]), preset.t_max)


def test_keys_and_titles_are_unique() -> None:
    assert len({preset.key for preset in PRESETS}) == len({preset.title for preset in PRESETS}) == len(PRESETS)


def test_all_groups_cases_planes_and_pictures_occur() -> None:
    places = [preset for preset in PRESETS if preset.group == "Places"]
    assert len(places) >= 12
    assert {preset.group for preset in PRESETS} == set(GROUPS)
    assert {preset.case for preset in places} == set(CASES)
    assert {preset.plane for preset in PRESETS} >= set(Plane)
    assert {preset.picture for preset in PRESETS} == set(TITLES)


@each_preset
def test_a_preset_is_a_valid_view_with_a_link_and_a_small_picture(preset: Preset) -> None:
    spec = ViewState(**preset.values()).map_spec()
    assert (spec.t_max, spec.window) == (preset.t_max, preset.window or spec.window)
    values, problems = read_link(dict(parse_qsl(write_link(ViewState(**preset.values()))[1:], strict_parsing=True)))
    again = ViewState(**values)
    assert not problems
    assert {name: getattr(again, name) for name in preset.values()} == preset.values()
    file = THUMBNAILS / f"{preset.key}.png"
    assert file.stat().st_size <= LARGEST_THUMBNAIL
    with Image.open(file) as picture:
        assert picture.size == (160, 160)


def test_every_thumbnail_has_a_preset() -> None:
    assert {file.stem for file in THUMBNAILS.iterdir()} == {preset.key for preset in PRESETS}


@each_preset
def test_starts_are_in_the_window_and_allowed(preset: Preset) -> None:
    spec = ViewState(**preset.values()).map_spec()
    # Many orbits are watched without any of them being chosen.
    fewest = 0 if preset.analysis is Analysis.WATCH else 1
    assert fewest <= len(set(preset.starts)) == len(preset.starts) <= MOST_ORBITS
    for x, ordinate in preset.starts:
        assert spec.pixel_at(x, ordinate) is not None
        assert fate_of(preset, x, ordinate, 10.0) >= Fate.BOUNDED


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
}


@pytest.mark.parametrize("key", FATES)
def test_fates_agree_with_the_caption(key: str) -> None:
    assert fates(named(key)) == FATES[key]


def test_shares_agree_with_the_caption() -> None:
    preset = named("shares")
    found = compute_map(ViewState(**preset.values()).map_spec())
    shares = found.fractions()
    direct = np.mean((found.fate > Fate.BOUNDED)[found.interior] & (found.crossings == 0)[found.interior])
    assert shares[Fate.BOUNDED] < 0.001
    assert round(shares[1], 2) == 0.55
    assert round(shares[2], 2) == 0.45
    assert direct == pytest.approx(0.75, abs=0.03)


def test_the_limit_of_stability_agrees_with_the_caption() -> None:
    preset = named("ceiling")
    spec = replace(ViewState(**preset.values()).map_spec(), resolution=(2, 400))
    found = compute_map(replace(spec, window=replace(spec.window, x_low=-1e-3, x_high=1e-3)))
    highest = found.ordinate[(found.fate == Fate.BOUNDED).all(axis=1)].max()
    assert highest == pytest.approx(0.5817, abs=5e-4)


@pytest.mark.slow
def test_the_sticky_orbit_looks_regular_and_escapes_late() -> None:
    orbit = integrate(named("super-sticky"))
    assert orbit.fate >= 1
    # Rounding differs between processors, and chaos amplifies it: the escape time varies.
    assert 22_000 < orbit.escape_time < 60_000
    early = orbit.t < 20_000
    assert orbit.sali[early].min() > 1e-4
    assert orbit.r2[early].max() < 0.91


def test_as_many_orbits_are_left_as_the_caption_of_the_draining_well_says() -> None:
    times = classify_orbits(CASES["III"], 0.45, sample_starts(CASES["III"], 0.45, 5000, seed=1), t_max=50.0).escape_time
    left = [float(np.mean(~(times <= t))) for t in (5.0, 50.0)]
    assert left == [pytest.approx(0.42, abs=0.02), pytest.approx(1 / 7, abs=0.02)]
    assert math.exp(-50.0 * compute_flux(CASES["III"], 0.45).decay_rate) == pytest.approx(1 / 4000, rel=0.1)


def test_orbits_that_are_torn_leave_when_the_caption_says() -> None:
    preset = named("torn")
    window, ((x, px),) = ViewState(**preset.values()).map_spec().find_window(), preset.starts
    random = np.random.default_rng(4)
    angle, radius = 2.0 * np.pi * random.random(2000), 10.0**preset.watched.radius * np.sqrt(random.random(2000))
    xs = x + 0.5 * (window.x_high - window.x_low) * radius * np.cos(angle)
    ps = px + 0.5 * (window.ordinate_high - window.ordinate_low) * radius * np.sin(angle)
    outcomes = classify_orbits(CASES["III"], 0.45, start_states(CASES["III"], Plane.X_PX, 0.45, xs, ps), t_max=100.0)
    assert np.nanmin(outcomes.escape_time) > 15.0
    shares = [float(np.mean(outcomes.fate == channel)) for channel in (1, 2, 3, 4)]
    assert min(shares) == pytest.approx(1 / 6, abs=0.04)
    assert max(shares) == pytest.approx(0.3, abs=0.04)
