"""Crossings of any section agree in maps, returns and single orbits, and with another integrator's events."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from engine import (
    CASES,
    POTENTIALS,
    Execution,
    MapSpec,
    Orbit,
    Plane,
    Section,
    Slice,
    SweepSpec,
    Trust,
    classify_orbits,
    compute_map,
    compute_returns,
    compute_sweep,
    compute_trust,
    find_stable_manifolds,
    integrate_orbit,
    judge_orbit,
    open_result,
    parse_formula,
    read_section,
    sample_orbits,
)
from engine.results import Returns
from engine.slices.sections.section import opposite_slice

TEXTS = (
    "y = 0.1 down", "x = 0, px > 0", "x = -0.07 both", "2x - 3y = 0.1", "px = 0.1", "x + 0.3 py = 0.1 both",
    "angle = 30°", "angle = 200° both", "angle = -90° about (0.1, 0.1) down",
    "apsis", "pericentre", "apocentre about (0.2, -0.1)",
)  # fmt: skip
SPEC = MapSpec(CASES["II"], Plane.X_PX, 0.24, (12, 11), t_max=30.0, use_evidence=False)
# Scaled to other units of length, time and mass; in a rotating frame with bodies; above the escape energy.
SPECS = {
    "case": SPEC,
    "positions": MapSpec(CASES["III"], Plane.X_Y, 0.3, (10, 12), t_max=30.0, use_evidence=False),
    "units": MapSpec(
        parse_formula("8x² + 8y² − 3x³ + 9xy²; masses (3, 3)"), Plane.X_PX, 2.0, (9, 8), t_max=20.0, use_evidence=False
    ),
    "bodies": MapSpec(POTENTIALS["Hill"], Plane.X_PX, -2.0, (9, 8), t_max=8.0, use_evidence=False),
    "several energies": MapSpec(CASES["I"], Plane.X_H, (0.1, 0.3), (9, 8), t_max=30.0, use_evidence=False),
    "backward": replace(SPEC, backward=True),
}


def expected_crossings(spec: MapSpec, start: np.ndarray, end: float) -> np.ndarray:
    """Return x, y, px, py and the time of the crossings of the section by SciPy, each refined in small parts of the steps."""
    potential, form = spec.potential, spec.section.form
    mass, rotation = potential.units.mass, potential.rotation
    falls = spec.section.direction.value

    def vanishing(state: np.ndarray) -> Any:
        x, y, px, py = state
        linear = sum(form.get(name, 0.0) * value for name, value in zip(("x", "y", "px", "py"), state, strict=True))
        return linear + form.get("radial", 0.0) * (x * px + y * py) - form.get("value", 0.0)

    def derivative(t: float, state: np.ndarray) -> list[float]:
        slope_x, slope_y = potential.gradient(state[0], state[1])
        x_force, y_force = 2.0 * rotation * state[3] - slope_x, -2.0 * rotation * state[2] - slope_y
        return [state[2] / mass, state[3] / mass, x_force, y_force]

    step = 0.05 * potential.units.time
    path = solve_ivp(derivative, (0.0, end), start, "DOP853", rtol=1e-13, atol=1e-15, dense_output=True, max_step=step).sol
    times = np.linspace(0.0, end, 8 * int(end / step) + 8)
    values = vanishing(path(times))
    # A start on the section is no crossing.
    values[0] = values[0] if abs(values[0]) > 1e-13 else 0.0
    found = []
    for before, after, low, high in zip(times[:-1], times[1:], values[:-1], values[1:], strict=True):
        rises, sinks = low < 0.0 <= high, low > 0.0 >= high
        if {"up": rises, "down": sinks, "both": rises or sinks}[falls]:
            t = brentq(lambda t: vanishing(path(t)), before, after, xtol=1e-15)
            state = path(t)
            if form.get("side_x", 0.0) * state[0] + form.get("side_y", 0.0) * state[1] >= form.get("side_value", 0.0):
                found.append([*state, t])
    return np.reshape(found, (-1, 5))


@pytest.mark.parametrize("name", SPECS)
@pytest.mark.parametrize("text", TEXTS)
def test_orbits_return_as_often_as_they_cross_in_the_map(name: str, text: str) -> None:
    spec = replace(SPECS[name], section=read_section(text))
    escape_map, found = compute_map(spec), compute_returns(spec, returns=300)
    assert found.count.max() > 0
    np.testing.assert_array_equal(found.count, np.where(escape_map.fate >= 0, escape_map.crossings, 0))


@pytest.mark.parametrize("name", ["case", "units", "bodies"])
@pytest.mark.parametrize("text", TEXTS)
def test_crossings_agree_with_another_integrator(name: str, text: str) -> None:
    spec = replace(SPECS[name], section=read_section(text))
    found, escape_map = compute_returns(spec, returns=100), compute_map(spec)
    x, ordinate = spec.pixel_centres()
    followed = np.argwhere(escape_map.fate >= 0)
    for row, column in followed[:: max(1, len(followed) // 4)][:4]:
        (start,) = spec.start_states(x[[column]], ordinate[[row]])
        time = escape_map.escape_time[row, column] if escape_map.fate[row, column] > 0 else spec.t_max
        expected = expected_crossings(spec, start, float(time))
        count = found.count[row, column]
        states = np.column_stack([found.states[:count, row, column], found.time[:count, row, column]])
        assert states.shape == expected.shape
        # SciPy's own errors are this large near a body.
        np.testing.assert_allclose(states, expected, atol=3e-9 if name == "bodies" else 1e-9)


@pytest.mark.parametrize("text", TEXTS)
def test_points_of_a_single_orbit_are_its_returns(text: str) -> None:
    spec = replace(SPEC, section=read_section(text))
    found = compute_returns(spec, returns=300)
    row, column = np.argwhere(found.count == found.count.max())[0]
    x, ordinate = spec.pixel_centres()
    (start,) = spec.start_states(x[[column]], ordinate[[row]])
    orbit = integrate_orbit(spec.potential, start, spec.t_max, section=text)
    assert orbit.crossings == found.count.max()
    states, times = orbit.find_section_states()
    assert states.tobytes() == found.states[: orbit.crossings, row, column].tobytes()
    assert times.tobytes() == found.time[: orbit.crossings, row, column].tobytes()
    np.testing.assert_array_equal(orbit.find_section_crossings(), spec.section.axes.points(states))
    assert spec.section.count(orbit.crossings) in judge_orbit(orbit).describe()


def test_apsides_of_an_ellipse_are_its_ends() -> None:
    # Semi-major axis 1 and eccentricity 1/2, so the period is 2π. The orbit starts at the apocentre, which does not count.
    potential, start = parse_formula("−1/r; centre the body (0, 0) 0.01; escape 10"), (1.5, 0.0, 0.0, np.sqrt(1.0 / 3.0))
    for text, distances in (("pericentre", [0.5] * 5), ("apocentre", [1.5] * 4), ("apsis", [0.5, 1.5] * 4 + [0.5])):
        states, times = integrate_orbit(potential, start, 30.0, section=text).find_section_states()
        np.testing.assert_allclose(np.hypot(states[:, 0], states[:, 1]), distances, atol=1e-13)
        half_periods = np.arange(1, 10)[:: 1 if text == "apsis" else 2] + (text == "apocentre")
        np.testing.assert_allclose(times, np.pi * half_periods[: len(distances)], atol=1e-12)


def test_crossings_do_not_depend_on_threads() -> None:
    for text in ("x = -0.07 both", "apsis"):
        spec = replace(SPEC, section=read_section(text), resolution=(60, 60))
        with ThreadPoolExecutor(3) as pool:
            again = compute_map(spec, execution=Execution(pool))
        assert again.crossings.tobytes() == compute_map(spec).crossings.tobytes()


def test_a_continued_map_has_the_crossings_of_a_new_map() -> None:
    spec = replace(SPEC, section=read_section("x = 0.05 both"))
    continued = compute_map(spec, resume=compute_map(replace(spec, t_max=7.0)))
    np.testing.assert_array_equal(continued.crossings, compute_map(spec).crossings)


def test_a_start_on_an_oblique_section_does_not_cross_it_at_once() -> None:
    section = read_section("0.3x + 0.7y = 0.05")
    spec = MapSpec(CASES["II"], section.plane, 0.15, (40, 40), t_max=20.0, section=section)
    found = compute_returns(spec, returns=1)
    assert np.nanmin(found.time) > 1e-3


def test_points_of_a_section_of_a_coordinate_have_its_value() -> None:
    found = compute_returns(replace(SPEC, section=read_section("x = 0.1 both")), returns=20)
    values = found.states[..., 0]
    assert set(values[np.isfinite(values)].tolist()) == {0.1}


def test_files_hold_the_section(tmp_path: Path) -> None:
    section = read_section("angle = 30° about (0.1, 0) both")
    spec = replace(SPEC, section=section)
    orbit = integrate_orbit(spec.potential, (0.1, 0.0, 0.0, 0.3), 20.0, section=section)
    results: dict[Any, str] = {
        "map": compute_map(spec),
        "returns": compute_returns(spec),
        "orbit": orbit,
        "verdict": judge_orbit(orbit),
        "manifolds": find_stable_manifolds(spec.potential, 0.24, images=1, section="angle = 30°"),
    }  # type: ignore[dict-item]
    for name, result in results.items():
        result.save(tmp_path / f"{name}.nc")
    assert open_result(tmp_path / "map.nc").spec == spec
    assert open_result(tmp_path / "returns.nc", Returns).spec == spec
    assert open_result(tmp_path / "orbit.nc", Orbit).section == section
    assert open_result(tmp_path / "verdict.nc").section == section
    manifolds = open_result(tmp_path / "manifolds.nc")
    assert manifolds.section == read_section("angle = 30°")
    assert list(manifolds.columns())[3:] == ["s", "px"]


@pytest.mark.parametrize("text", ["x = 0, px > 0", "angle = 200° both", "pericentre"])
def test_crossings_are_the_same_in_maps_sweeps_and_lists_of_starts(text: str) -> None:
    spec = replace(SPEC, section=read_section(text))
    wanted = compute_map(spec)
    sweep = compute_sweep(SweepSpec(spec.potential, spec.plane, [spec.energy], spec.resolution, t_max=spec.t_max, section=text))
    np.testing.assert_array_equal(sweep.dataset["crossings"][0], wanted.crossings)
    rows, columns = np.nonzero(wanted.fate >= 0)
    starts = spec.start_states(wanted.x[columns], wanted.ordinate[rows])
    listed = classify_orbits(spec.potential, spec.energy, starts, spec.t_max, section=text)
    np.testing.assert_array_equal(listed.crossings, wanted.crossings[rows, columns])
    sampled = sample_orbits(spec.potential, starts[:5], [spec.t_max], section=text)
    np.testing.assert_array_equal(sampled.crossings, listed.crossings[:5])
    assert {found.to_xarray().attrs["section"] for found in (listed, sampled)} == {spec.section.text}


@pytest.mark.parametrize("text", ["y = 0.1 up", "y = 0.1 down", "y = 0.1 both"])
@pytest.mark.parametrize("plane", [Plane.X_Y, opposite_slice(Plane.X_Y)])
def test_starts_on_a_section_are_no_more_doubtful_than_their_neighbours(text: str, plane: Slice) -> None:
    spec = MapSpec(CASES["I"], plane, 0.2, (41, 41), (-0.5, 0.5, -0.4, 0.6), t_max=200.0, section=text)
    found = compute_map(spec)
    # One row of pixels is on the section.
    row = int(np.argmin(np.abs(found.ordinate - 0.1)))
    assert abs(found.ordinate[row] - 0.1) < 1e-15
    doubtful = (compute_trust(found).trust == Trust.DOUBTFUL).sum(axis=1)
    assert doubtful[row] <= max(doubtful[row - 1], doubtful[row + 1]) + 4


def test_a_layer_of_a_map_uses_its_section() -> None:
    spec = replace(SPEC, section=read_section("x = 0.05"), resolution=(30, 30), t_max=1e3)
    # Reruns that counted crossings of y = 0 would make almost every escape doubtful.
    trust = compute_trust(compute_map(spec))
    usual = compute_trust(compute_map(replace(spec, section=Section.Y_UP)))
    assert abs(trust.doubtful_share - usual.doubtful_share) < 0.2
