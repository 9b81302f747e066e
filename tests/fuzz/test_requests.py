"""Any arguments of the engine give a result or an error that names the parameter."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from engine import (
    CASES,
    EscapeMap,
    MapSpec,
    Plane,
    Potential,
    SweepSpec,
    Window,
    classify_orbits,
    compute_basin_entropy,
    compute_map,
    compute_separation,
    compute_statistics,
    compute_uncertainty_exponent,
    compute_wada_test,
    find_divergent_start,
    find_lyapunov_orbits,
    find_stable_manifolds,
    fit_decay_laws,
    integrate_orbit,
    judge_orbit,
    plan_sweep,
    start_states,
)
from engine.foundations.validation import LONGEST_TIME
from engine.measures.basins.power_law_fit import fit_uncertainty
from engine.trajectories.birkhoff_digits import compute_birkhoff_digits
from tests.fuzz.hostile import anything, floats, mostly, result_or_error

CASE = CASES["I"]
energies = mostly(st.floats(0.05, 0.3))
times = mostly(st.floats(1e-3, 50.0))
planes = mostly(st.sampled_from(list(Plane)))
coordinates = mostly(st.floats(-0.5, 0.5))
edges = mostly(st.tuples(*[st.floats(-1.0, 1.0)] * 4), st.tuples(floats, floats, floats, floats) | anything)
sides = mostly(st.integers(1, 12))
resolutions = mostly(st.tuples(sides, sides))
states = mostly(st.tuples(*[st.floats(-0.3, 0.3)] * 4), st.tuples(*[floats] * 4) | anything)
counts = mostly(st.integers(0, 6))
powers = mostly(st.integers(0, 4))
number_lists = mostly(st.lists(st.floats(0.0, 1.0), max_size=8), st.lists(floats, max_size=8) | anything)
count_lists = mostly(st.lists(st.integers(0, 300), max_size=8), st.lists(st.integers() | floats, max_size=8) | anything)
labels = st.lists(st.lists(mostly(st.integers(0, 3)), max_size=7), max_size=7) | anything


@functools.cache
def small_map() -> EscapeMap:
    return compute_map(MapSpec(CASE, Plane.X_PX, 0.2, (12, 12), t_max=50.0))


def shortened(time: Any) -> Any:
    """Return a shorter time in place of a valid one that would take long."""
    return 100.0 if isinstance(time, int | float) and 100.0 < time <= LONGEST_TIME else time


@given(floats | anything, floats | anything, floats | anything, floats | anything)
def test_any_window_gives_a_result_or_a_named_error(x_low: Any, x_high: Any, low: Any, high: Any) -> None:
    window = result_or_error(lambda: Window(x_low, x_high, low, high), ["window"])
    if window is not None:
        centres = result_or_error(lambda: window.pixel_centres(3, 4), ["window"])
        assert all(np.isfinite(row).all() and np.all(np.diff(row) >= 0) for row in centres)


@given(planes, energies | st.tuples(energies, energies), resolutions, st.none() | edges, times)
def test_any_map_request_gives_a_result_or_a_named_error(
    plane: Any, energy: Any, resolution: Any, window: Any, t_max: Any
) -> None:
    names = ["plane", "energy", "resolution", "window", "t_max", "Plane"]
    spec = result_or_error(lambda: MapSpec(CASE, plane, energy, resolution, window, t_max), names)
    if spec is None:
        return
    assert hash(spec) == hash(spec)
    assert spec.provenance()
    result_or_error(lambda: spec.pixel_at(spec.find_window().x_low, spec.find_window().ordinate_high), names)
    if spec.t_max <= 100.0 and np.prod(spec.resolution) <= 144:
        frame = result_or_error(lambda: compute_map(spec), names)
        if frame is not None:
            assert frame.complete
            assert np.isin(frame.fate, range(-4, CASE.channels + 1)).all()
            result_or_error(lambda: compute_statistics(frame).shares, names)


@given(
    st.lists(st.tuples(mostly(st.integers(0, 4)), mostly(st.integers(0, 4)), mostly(st.floats(-2.0, 2.0))), max_size=5) | anything
)
def test_any_terms_of_a_potential_give_a_result_or_a_named_error(terms: Any) -> None:
    terms = tuple(terms) if isinstance(terms, list) else terms
    potential = result_or_error(lambda: Potential("odd", terms), ["terms"])
    if potential is not None:
        hash(potential)
        result_or_error(lambda: potential.value(0.1, 0.2), ["terms"])
        result_or_error(lambda: potential.saddles, ["terms", "isolated"])


@given(energies, st.lists(states, max_size=3) | anything, times)
def test_any_orbits_to_classify_give_a_result_or_a_named_error(energy: Any, rows: Any, t_max: Any) -> None:
    on_shell = [(0.1, 0.0, 0.0, 0.5)]
    for states in (rows, on_shell):
        result_or_error(functools.partial(classify_orbits, CASE, energy, states, t_max), ["energy", "states", "t_max"])


@given(states, times)
def test_any_orbit_to_integrate_gives_a_result_or_a_named_error(state: Any, t_max: Any) -> None:
    orbit = result_or_error(lambda: integrate_orbit(CASE, state, shortened(t_max)), ["state", "t_max", "energy"])
    if orbit is not None:
        assert judge_orbit(orbit).describe()
        assert orbit.t.size == orbit.x.size == orbit.sali.size


@given(states, states, times)
def test_any_separation_gives_a_result_or_a_named_error(first: Any, second: Any, t_max: Any) -> None:
    result_or_error(lambda: compute_separation(CASE, first, second, shortened(t_max)), ["first", "second", "t_max"])


@given(states, times)
def test_any_birkhoff_digits_give_a_result_or_a_named_error(state: Any, t_max: Any) -> None:
    result_or_error(lambda: compute_birkhoff_digits(CASE, state, t_max), ["state", "t_max", "energy"])


@given(energies)
@example(0.25)
def test_any_energy_of_lyapunov_orbits_gives_a_result_or_a_named_error(energy: Any) -> None:
    orbits = result_or_error(lambda: find_lyapunov_orbits(CASE, energy), ["energy"])
    assert not any(np.isnan([orbit.period, *orbit.x, *orbit.y, *orbit.curve]).any() for orbit in orbits or ())


@given(planes, energies | st.tuples(energies, energies))
def test_any_default_window_gives_a_result_or_a_named_error(plane: Any, energy: Any) -> None:
    result_or_error(lambda: MapSpec(CASE, plane, energy).find_window(), ["energy", "plane"])


@given(st.sampled_from(list(Plane)), st.floats(), st.lists(st.floats(), min_size=1, max_size=4))
def test_any_start_states_give_a_result_or_a_named_error(plane: Plane, energy: float, x: list[float]) -> None:
    row = np.array(x)
    states = result_or_error(lambda: start_states(CASE, plane, energy, row, row[::-1]), ["energy"])
    assert states is None or states.shape == (row.size, 4)


@given(planes, energies, st.tuples(floats, floats, floats, floats))
def test_any_zero_velocity_curves_give_a_result_or_a_named_error(plane: Any, energy: Any, corners: Any) -> None:
    names = ["window", "energy", "plane"]
    result_or_error(lambda: MapSpec(CASE, plane, energy, window=corners).trace_zero_velocity_curve(), names)


@given(planes, energies, coordinates, coordinates, times, mostly(st.floats(1e-6, 0.01)))
def test_any_divergent_start_gives_a_result_or_a_named_error(
    plane: Any, energy: Any, x: Any, ordinate: Any, t_max: Any, furthest: Any
) -> None:
    names = ["plane", "energy", "x", "y", "px", "h", "ordinate", "t_max", "furthest"]
    result_or_error(lambda: find_divergent_start(CASE, plane, energy, x, ordinate, shortened(t_max), furthest=furthest), names)


@given(planes, mostly(st.lists(energies, max_size=4), anything), resolutions, st.none() | edges, times)
def test_any_sweep_request_gives_a_result_or_a_named_error(
    plane: Any, swept: Any, resolution: Any, window: Any, t_max: Any
) -> None:
    names = ["plane", "Plane", "energies", "values", "energy", "resolution", "window", "t_max"]
    result_or_error(lambda: SweepSpec(CASE, plane, swept, resolution, window, t_max), names)


@given(anything.filter(lambda cores: cores is not None))
def test_any_sweep_plan_gives_a_result_or_a_named_error(cores: Any) -> None:
    if isinstance(cores, int | np.integer) and 1 <= cores <= 10**6:
        return
    spec = SweepSpec(CASE, Plane.X_PX, (0.2,), (4, 4), t_max=5.0)
    assert result_or_error(lambda: plan_sweep(spec, cores=cores), ["cores"]) is None


@given(labels, labels | st.none(), mostly(st.integers(1, 5)))
def test_any_pixels_of_basin_measures_give_a_result_or_a_named_error(pixels: Any, valid: Any, box: Any) -> None:
    names = ["labels", "valid", "box"]
    result_or_error(lambda: compute_basin_entropy(pixels, valid, box=box), names)
    result_or_error(lambda: compute_wada_test(pixels, valid), names)
    frame = small_map()
    result_or_error(lambda: compute_basin_entropy(frame.fate, frame.fate >= 0, box=box), names)


@given(number_lists, count_lists, count_lists)
def test_any_counts_of_uncertain_pairs_give_a_result_or_a_named_error(separations: Any, pairs: Any, uncertain: Any) -> None:
    result_or_error(lambda: fit_uncertainty(separations, pairs, uncertain), ["separations", "pairs", "uncertain"])


@given(times, st.none() | st.tuples(floats, floats) | anything)
def test_any_decay_laws_give_a_result_or_a_named_error(t_max: Any, window: Any) -> None:
    statistics = compute_statistics(small_map())
    result_or_error(lambda: fit_decay_laws(statistics, t_max, window=window), ["t_max", "window"])


@given(mostly(st.integers(5, 12)), mostly(st.integers(3, 6)), mostly(st.floats(1.0, 10.0)), counts)
def test_any_uncertainty_exponent_gives_a_result_or_a_named_error(pairs: Any, separations: Any, work: Any, seed: Any) -> None:
    if any(isinstance(value, int | float) and value > 100 for value in (pairs, separations, work)):
        return
    names = ["pairs", "separations", "work", "rng"]
    options = {"pairs": pairs, "separations": separations, "work": work, "rng": seed}
    result_or_error(lambda: compute_uncertainty_exponent(small_map().spec, **options), names)


@given(mostly(st.just(0.05), anything), mostly(st.just(0), anything))
def test_any_stable_manifolds_give_a_result_or_a_named_error(energy: Any, images: Any) -> None:
    if isinstance(images, int | float) and images == 1 and isinstance(energy, int | float) and energy > 0.125:
        return
    result_or_error(lambda: find_stable_manifolds(CASE, energy, images=images), ["energy", "images"])
