"""What can be asked of the engine with any values: it is answered, or refused in a sentence that names the parameter."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from engine import (
    CASES,
    LONGEST_TIME,
    EnergyCurvesSpec,
    EscapeMap,
    MapSpec,
    Plane,
    Potential,
    SweepSpec,
    Window,
    classify_orbits,
    compute_basin_entropy,
    compute_birkhoff_digits,
    compute_map,
    compute_radius_envelope,
    compute_separation,
    compute_statistics,
    compute_uncertainty_exponent,
    compute_wada_test,
    default_window,
    find_lyapunov_orbits,
    find_stable_manifolds,
    find_twin,
    fit_decay_laws,
    fit_direct_shares,
    fit_escape_shares,
    fit_uncertainty,
    integrate_orbit,
    measure_deviation,
    plan_sweep,
    preview_spec,
    start_states,
    trace_equipotentials,
    trace_zero_velocity_curve,
)
from tests.fuzz.hostile import answer_or_refusal, anything, either, floats

CASE = CASES["I"]
energies = either(st.floats(0.05, 0.3))
times = either(st.floats(1e-3, 50.0))
planes = either(st.sampled_from(list(Plane)))
coordinates = either(st.floats(-0.5, 0.5))
edges = either(st.tuples(*[st.floats(-1.0, 1.0)] * 4), st.tuples(floats, floats, floats, floats) | anything)
sides = either(st.integers(1, 12))
resolutions = either(st.tuples(sides, sides))
states = either(st.tuples(*[st.floats(-0.3, 0.3)] * 4), st.tuples(*[floats] * 4) | anything)
counts = either(st.integers(0, 6))
powers = either(st.integers(0, 4))
numbers_in_a_row = either(st.lists(st.floats(0.0, 1.0), max_size=8), st.lists(floats, max_size=8) | anything)
counts_in_a_row = either(st.lists(st.integers(0, 300), max_size=8), st.lists(st.integers() | floats, max_size=8) | anything)
labels = st.lists(st.lists(either(st.integers(0, 3)), max_size=7), max_size=7) | anything


@functools.cache
def small_map() -> EscapeMap:
    return compute_map(MapSpec(CASE, Plane.X_PX, 0.2, (12, 12), t_max=50.0))


@given(floats | anything, floats | anything, floats | anything, floats | anything)
def test_a_window(x_low: Any, x_high: Any, low: Any, high: Any) -> None:
    window = answer_or_refusal(lambda: Window(x_low, x_high, low, high), ["window"])
    if window is not None:
        centres = answer_or_refusal(lambda: window.pixel_centres(3, 4), ["window"])
        assert all(np.isfinite(row).all() and np.all(np.diff(row) >= 0) for row in centres)


@given(planes, energies | st.tuples(energies, energies), resolutions, st.none() | edges, times)
def test_a_map(plane: Any, energy: Any, resolution: Any, window: Any, t_max: Any) -> None:
    names = ["plane", "energy", "resolution", "window", "t_max", "Plane"]
    spec = answer_or_refusal(lambda: MapSpec(CASE, plane, energy, resolution, window, t_max), names)
    if spec is None:
        return
    assert hash(spec) == hash(spec)
    assert spec.provenance()
    answer_or_refusal(lambda: spec.pixel_at(spec.window.x_low, spec.window.ordinate_high), names)
    assert preview_spec(spec).t_max <= LONGEST_TIME
    if spec.t_max <= 100.0 and np.prod(spec.resolution) <= 144:
        frame = answer_or_refusal(lambda: compute_map(spec), names)
        if frame is not None:
            assert frame.complete
            assert np.isin(frame.fate, range(-4, CASE.channels + 1)).all()
            answer_or_refusal(lambda: compute_statistics(frame).shares, names)


@given(
    st.lists(st.tuples(either(st.integers(0, 4)), either(st.integers(0, 4)), either(st.floats(-2.0, 2.0))), max_size=5) | anything
)
def test_a_potential(terms: Any) -> None:
    terms = tuple(terms) if isinstance(terms, list) else terms
    potential = answer_or_refusal(lambda: Potential("odd", terms), ["terms"])
    if potential is not None:
        hash(potential)
        answer_or_refusal(lambda: potential.value(0.1, 0.2), ["terms"])
        answer_or_refusal(lambda: potential.saddles, ["terms", "isolated"])


@given(energies, st.lists(states, max_size=3) | anything, times)
def test_a_list_of_orbits(energy: Any, rows: Any, t_max: Any) -> None:
    on_shell = [(0.1, 0.0, 0.0, 0.5)]
    for tried in (rows, on_shell):
        answer_or_refusal(functools.partial(classify_orbits, CASE, energy, tried, t_max), ["energy", "states", "t_max"])


@given(states, times)
def test_an_orbit_in_full(state: Any, t_max: Any) -> None:
    short = t_max if not (isinstance(t_max, int | float) and 100.0 < t_max <= LONGEST_TIME) else 100.0
    orbit = answer_or_refusal(lambda: integrate_orbit(CASE, state, short), ["state", "t_max", "energy"])
    if orbit is not None:
        assert orbit.describe()
        assert orbit.t.size == orbit.x.size == orbit.sali.size


@given(states, states, times)
def test_two_orbits(first: Any, second: Any, t_end: Any) -> None:
    short = t_end if not (isinstance(t_end, int | float) and 100.0 < t_end <= LONGEST_TIME) else 100.0
    answer_or_refusal(lambda: compute_separation(CASE, first, second, short), ["first", "second", "t_max", "t_end"])


@given(states, times)
def test_digits(state: Any, t_max: Any) -> None:
    answer_or_refusal(lambda: compute_birkhoff_digits(CASE, state, t_max), ["state", "t_max", "energy"])


@given(states, times, either(st.integers(1, 20)))
def test_the_envelope_of_r2(state: Any, t_max: Any, intervals: Any) -> None:
    short = t_max if not (isinstance(t_max, int | float) and 100.0 < t_max <= LONGEST_TIME) else 100.0
    answer_or_refusal(lambda: compute_radius_envelope(CASE, state, short, intervals), ["state", "t_max", "intervals", "energy"])


@given(energies)
def test_exits(energy: Any) -> None:
    orbits = answer_or_refusal(lambda: find_lyapunov_orbits(CASE, energy), ["energy"])
    assert all(np.isfinite(orbit.curve).all() and np.isfinite(orbit.period) for orbit in orbits or ())


@given(planes, energies | st.tuples(energies, energies))
def test_the_window_of_the_interior(plane: Any, energy: Any) -> None:
    answer_or_refusal(lambda: default_window(CASE, plane, energy), ["energy", "plane"])


@given(st.sampled_from(list(Plane)), st.floats(), st.lists(st.floats(), min_size=1, max_size=4))
def test_starts_on_a_plane(plane: Plane, energy: float, x: list[float]) -> None:
    row = np.array(x)
    found = answer_or_refusal(lambda: start_states(CASE, plane, energy, row, row[::-1]), ["energy"])
    assert found is None or found.shape == (row.size, 4)


@given(planes, energies, st.tuples(floats, floats, floats, floats))
def test_equipotentials(plane: Any, energy: Any, corners: Any) -> None:
    names = ["window", "energy", "energies", "plane"]
    window = answer_or_refusal(lambda: Window(*corners), names) or small_map().spec.window
    answer_or_refusal(lambda: trace_zero_velocity_curve(CASE, plane, energy, window), names)
    answer_or_refusal(lambda: trace_equipotentials(CASE, plane, (energy, energy), window), names)


@given(planes, energies, coordinates, coordinates, times, either(st.floats(1e-6, 0.01)))
def test_a_twin(plane: Any, energy: Any, x: Any, ordinate: Any, t_max: Any, furthest: Any) -> None:
    names = ["plane", "energy", "x", "y", "px", "h", "ordinate", "t_max", "furthest"]
    short = t_max if not (isinstance(t_max, int | float) and 100.0 < t_max <= LONGEST_TIME) else 100.0
    answer_or_refusal(lambda: find_twin(CASE, plane, energy, x, ordinate, short, furthest=furthest), names)


@given(planes, either(st.lists(energies, max_size=4), anything), resolutions, st.none() | edges, times)
def test_sweeps(plane: Any, swept: Any, resolution: Any, window: Any, t_max: Any) -> None:
    names = ["plane", "Plane", "energies", "energy", "resolution", "window", "t_max"]
    answer_or_refusal(lambda: EnergyCurvesSpec(CASE, plane, swept, resolution, t_max), names)
    answer_or_refusal(lambda: SweepSpec(CASE, plane, swept, resolution, window, t_max), names)


@given(anything.filter(lambda cores: cores is not None))
def test_the_plan_of_a_sweep(cores: Any) -> None:
    if isinstance(cores, int | np.integer) and 1 <= cores <= 10**6:
        return
    spec = SweepSpec(CASE, Plane.X_PX, (0.2,), (4, 4), t_max=5.0)
    assert answer_or_refusal(lambda: plan_sweep(spec, cores=cores), ["cores"]) is None


@given(labels, labels | st.none(), either(st.integers(1, 5)))
def test_measures_of_a_picture(picture: Any, valid: Any, box: Any) -> None:
    names = ["labels", "valid", "box"]
    answer_or_refusal(lambda: compute_basin_entropy(picture, valid, box), names)
    answer_or_refusal(lambda: compute_wada_test(picture, valid), names)
    frame = small_map()
    answer_or_refusal(lambda: compute_basin_entropy(frame.fate, frame.fate >= 0, box), names)


@given(numbers_in_a_row, counts_in_a_row, counts_in_a_row, counts)
def test_fits_of_shares(h: Any, part: Any, whole: Any, degree: Any) -> None:
    names = ["h", "escaped", "direct", "counts", "starts", "degree", "separations", "pairs", "uncertain"]
    answer_or_refusal(lambda: fit_escape_shares(h, part, whole), names)
    answer_or_refusal(lambda: fit_direct_shares(h, part, whole, degree), names)
    answer_or_refusal(lambda: fit_uncertainty(h, whole, part), names)
    answer_or_refusal(lambda: measure_deviation(np.cos, h, part, whole), names)


@given(times, st.none() | st.tuples(floats, floats) | anything, either(st.just(500)), counts)
def test_fits_of_escape_times(t_max: Any, window: Any, resamples: Any, seed: Any) -> None:
    if isinstance(resamples, int | float) and resamples > 1000:
        return
    statistics = compute_statistics(small_map())
    names = ["t_max", "window", "resamples", "seed"]
    answer_or_refusal(lambda: fit_decay_laws(statistics, t_max, window=window, resamples=resamples, seed=seed), names)


@given(either(st.integers(5, 12)), either(st.integers(3, 6)), either(st.floats(1.0, 10.0)), counts)
def test_the_uncertainty_exponent(pairs: Any, separations: Any, work: Any, seed: Any) -> None:
    if any(isinstance(value, int | float) and value > 100 for value in (pairs, separations, work)):
        return
    names = ["pairs", "separations", "work", "seed"]
    options = {"pairs": pairs, "separations": separations, "work": work, "seed": seed}
    answer_or_refusal(lambda: compute_uncertainty_exponent(small_map().spec, **options), names)


@given(either(st.just(0.05), anything), either(st.just(0), anything))
def test_stable_manifolds(energy: Any, images: Any) -> None:
    if isinstance(images, int | float) and images == 1 and isinstance(energy, int | float) and energy > 0.125:
        return
    answer_or_refusal(lambda: find_stable_manifolds(CASE, energy, images), ["energy", "images"])
