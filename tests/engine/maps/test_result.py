from __future__ import annotations

import itertools
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from engine import (
    CASES,
    Certificate,
    EscapeMap,
    Fate,
    MapSpec,
    Outcomes,
    Plane,
    classify_orbits,
    compute_map,
    find_lyapunov_orbits,
    integrate_orbit,
    start_states,
)
from engine.dynamics import batch as orbit_batch
from engine.execution import Execution
from engine.maps.compute import frame_pause
from engine.maps.run import COARSE_PIXELS
from tests.forgetful_pool import ForgetfulPool

ARRAYS = ("fate", "escape_time", "crossings", "energy_error", "outside", "started")
OUTCOMES = ("fate", "escape_time", "crossings", "energy_error")
# Has bounded, escaping, forbidden and outside pixels, and more pixels than the first frame.
SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.35, (70, 66), t_max=300.0)
SPECS = {
    "I on (x, y)": MapSpec(CASES["I"], Plane.X_Y, 0.14, (50, 40), t_max=300.0),
    "II on (x, px)": MapSpec(CASES["II"], Plane.X_PX, 0.18, (50, 40), t_max=300.0),
    "III on (x, h)": MapSpec(CASES["III"], Plane.X_H, (0.2, 0.6), (50, 40), t_max=300.0),
}
each_spec = pytest.mark.parametrize("spec", [SPEC, *SPECS.values()], ids=["III on (x, px)", *SPECS])


def assert_bit_identical(one: EscapeMap | Outcomes, other: EscapeMap | Outcomes, names: tuple[str, ...] = ARRAYS) -> None:
    for name in names:
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


@pytest.fixture(scope="module")
def whole() -> EscapeMap:
    return compute_map(SPEC)


class CancelAfter:
    """An `on_frame` callback that cancels at the n-th frame."""

    def __init__(self, frames: int) -> None:
        self.remaining, self.event, self.seen = frames, threading.Event(), list[EscapeMap]()

    def __call__(self, frame: EscapeMap) -> None:
        self.seen.append(frame)
        self.remaining -= 1
        if self.remaining == 0:
            self.event.set()


# Contents of a map.


def test_complete_map_has_no_undecided_pixels(whole: EscapeMap) -> None:
    assert whole.complete
    assert (whole.undecided, whole.progress, whole.stride, whole.horizon) == (0.0, 1.0, 1, 300.0)


def test_exactly_the_escaping_pixels_have_an_escape_time(whole: EscapeMap) -> None:
    np.testing.assert_array_equal(np.isfinite(whole.escape_time), whole.fate >= 1)


def test_escape_times_lie_within_t_max(whole: EscapeMap) -> None:
    times = whole.escape_time[whole.fate >= 1]
    assert 0 < times.min() < times.max() <= 300.0


@each_spec
def test_pixels_have_the_outcomes_of_orbits_from_their_centres(spec: MapSpec) -> None:
    result = compute_map(spec)
    assert result.fate.shape == (spec.resolution[1], spec.resolution[0]) == (result.ordinate.size, result.x.size)
    for row, column in [(3, 25), (20, 20), (30, 12)]:
        if result.fate[row, column] in (Fate.FORBIDDEN, Fate.OUTSIDE):
            continue
        h = result.ordinate[row] if spec.plane is Plane.X_H else spec.energy
        start = start_states(spec.potential, spec.plane, h, result.x[[column]], result.ordinate[[row]])
        single = classify_orbits(spec.potential, h, start, spec.t_max)
        for name in OUTCOMES:
            # An orbit below every saddle is not integrated.
            if name in ("crossings", "energy_error") and h <= spec.potential.escape_energy:
                continue
            np.testing.assert_array_equal(getattr(single, name)[0], getattr(result, name)[row, column], err_msg=name)


@pytest.mark.parametrize("t_max", [100.0, 1e5])
def test_orbits_below_every_saddle_are_bounded_without_integration(t_max: float) -> None:
    result = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.12, (40, 40), t_max=t_max))
    inside = result.fate != Fate.FORBIDDEN
    assert inside.any()
    assert set(result.certificate[inside]) == {Certificate.CLOSED}
    assert set(result.crossings[inside]) == {0}


@each_spec
def test_exactly_the_starts_without_real_momentum_are_forbidden(spec: MapSpec) -> None:
    result = compute_map(spec)
    x, ordinate = (grid.ravel() for grid in np.meshgrid(result.x, result.ordinate))
    h = 0.0 if spec.plane is Plane.X_H else spec.energy
    exists = np.isfinite(start_states(spec.potential, spec.plane, h, x, ordinate)).all(axis=1)
    np.testing.assert_array_equal(result.fate.ravel() == Fate.FORBIDDEN, ~exists)


@pytest.mark.parametrize(("name", "escape_energy"), [("I", 1 / 8), ("II", 1 / 6), ("III", 1 / 4)])
@pytest.mark.parametrize("below", [0.0, 0.01])
@pytest.mark.parametrize("plane", [Plane.X_Y, Plane.X_PX])
def test_nothing_escapes_at_or_below_the_escape_energy(name: str, escape_energy: float, below: float, plane: Plane) -> None:
    fate = compute_map(MapSpec(CASES[name], plane, escape_energy - below, (24, 24), t_max=200.0)).fate
    # At the escape energy a pixel of the default window may lie just beyond a saddle.
    assert {Fate.BOUNDED, Fate.FORBIDDEN} <= set(np.unique(fate)) <= {Fate.BOUNDED, Fate.FORBIDDEN, Fate.OUTSIDE}


@pytest.mark.parametrize(("name", "escape_energy"), [("I", 1 / 8), ("II", 1 / 6), ("III", 1 / 4)])
@pytest.mark.parametrize("below", [0.0, 0.01])
def test_starts_beyond_the_closed_saddles_are_outside(name: str, escape_energy: float, below: float) -> None:
    spec = MapSpec(CASES[name], Plane.X_Y, escape_energy - below, (40, 40), window=(-2.0, 2.0, -2.0, 2.0), t_max=50.0)
    result = compute_map(spec)
    x, y = np.meshgrid(result.x, result.ordinate)
    # The wells of all cases lie within a distance 1 of the origin.
    beyond = (np.hypot(x, y) > 1.01) & (result.fate != Fate.FORBIDDEN)
    assert beyond.sum() > 100
    assert set(result.fate[beyond]) == {Fate.OUTSIDE}


def test_each_row_of_x_h_has_its_own_exits() -> None:
    spec = MapSpec(CASES["III"], Plane.X_H, (0.1, 0.6), (30, 20), t_max=300.0)
    escaping = (compute_map(spec).fate >= 1).any(axis=1)
    rows = spec.pixel_centres()[1]
    assert not escaping[rows <= 0.25].any()
    assert escaping[rows > 0.4].all()


def test_energy_errors_are_small(whole: EscapeMap) -> None:
    assert 0 < whole.worst_energy_error < 1e-13


def test_arrays_are_read_only(whole: EscapeMap) -> None:
    with pytest.raises(ValueError, match="read-only"):
        whole.fate[0, 0] = 1


@pytest.mark.parametrize("resolution", [(1, 1), (1, 7), (7, 1), (3, 200)])
def test_unusual_resolutions(resolution: tuple[int, int]) -> None:
    result = compute_map(MapSpec(CASES["I"], Plane.X_Y, 0.2, resolution, t_max=20.0))
    assert result.complete
    assert result.fate.shape == resolution[::-1]


def test_window_without_allowed_starts_is_all_forbidden() -> None:
    result = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.2, (8, 8), window=(0.0, 1.0, 5.0, 6.0)))
    assert set(np.unique(result.fate)) == {Fate.FORBIDDEN}
    assert (result.complete, result.progress, result.undecided) == (True, 1.0, 0.0)
    assert set(result.fractions().values()) == {0.0}


# Fractions.


def test_fractions_are_shares_of_the_interior_starts(whole: EscapeMap) -> None:
    counts = {code: int((whole.fate == code).sum()) for code in (1, 2, 3, 4, 0)}
    expected = {code: count / sum(counts.values()) for code, count in counts.items()} | {Fate.NOT_COMPUTED: 0.0, Fate.FAILED: 0.0}
    assert whole.fractions() == pytest.approx(expected)


def test_outside_starts_can_be_counted_as_escaped() -> None:
    result = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.4, (40, 40), window=(-1.0, 2.5, -2.0, 2.0), t_max=100.0))
    # Only channel 1 intersects y = 0.
    outside = int((result.fate == Fate.OUTSIDE).sum())
    first, interior = int((result.fate == 1).sum()), int((result.fate >= 0).sum())
    assert outside > 100
    assert set(np.unique(result.outside)) == {0, 1}
    assert result.fractions(count_outside=True)[1] == pytest.approx((first + outside) / (interior + outside))


@pytest.mark.parametrize("count_outside", [False, True])
def test_fractions_sum_to_one(count_outside: bool) -> None:
    result = compute_map(MapSpec(CASES["I"], Plane.X_Y, 0.3, (40, 40), window=(-2.0, 2.0, -2.0, 2.0), t_max=10.0))
    assert sum(result.fractions(count_outside=count_outside).values()) == pytest.approx(1.0)


# Frames.


@pytest.fixture(scope="module")
def frames() -> list[EscapeMap]:
    seen: list[EscapeMap] = []
    compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.3, (90, 83), t_max=2000.0), seen.append)
    return seen


def test_the_first_frame_is_coarse(frames: list[EscapeMap]) -> None:
    assert frames[0].started.sum() <= COARSE_PIXELS
    assert frames[0].stride > 1


def test_later_frames_keep_the_decided_pixels(frames: list[EscapeMap]) -> None:
    for earlier, later in itertools.pairwise(frames):
        assert np.all(later.started >= earlier.started)
        decided = earlier.fate != Fate.NOT_COMPUTED
        np.testing.assert_array_equal(later.fate[decided], earlier.fate[decided])
        np.testing.assert_array_equal(later.escape_time[decided], earlier.escape_time[decided])
        assert later.progress >= earlier.progress
        assert later.stride <= earlier.stride


def test_last_frame_equals_the_map(frames: list[EscapeMap]) -> None:
    assert_bit_identical(frames[-1], compute_map(frames[-1].spec))


def test_resuming_a_frame_raises(frames: list[EscapeMap]) -> None:
    with pytest.raises(ValueError, match="resume"):
        compute_map(frames[0].spec, resume=frames[0])


def test_each_square_of_a_frame_has_a_started_pixel(frames: list[EscapeMap]) -> None:
    for frame in frames:
        rows, columns = (-(-size // frame.stride) for size in frame.fate.shape)
        padded = np.zeros((rows * frame.stride, columns * frame.stride), bool)
        padded[: frame.fate.shape[0], : frame.fate.shape[1]] = frame.started
        assert padded.reshape(rows, frame.stride, columns, frame.stride).any(axis=(1, 3)).all()


@pytest.mark.parametrize("name", ["fate", "escape_time", "crossings"])
def test_thinned_frame_has_a_started_pixel_of_each_square(frames: list[EscapeMap], name: str) -> None:
    frame = frames[0]
    thinned, stride = frame.thinned()[0][name], frame.stride
    for row, column in np.ndindex(thinned.shape):
        square = np.s_[row * stride : (row + 1) * stride, column * stride : (column + 1) * stride]
        candidates = getattr(frame, name)[square][frame.started[square]]
        assert np.any(np.isclose(thinned[row, column], candidates, equal_nan=True))


def test_thinned_frame_has_the_window_of_its_squares(frames: list[EscapeMap]) -> None:
    frame = frames[0]
    images, window = frame.thinned()
    x, ordinate = window.pixel_centres(*images["fate"].shape[::-1])
    for centres, fine in ((x, frame.x), (ordinate, frame.ordinate)):
        pixel = fine[1] - fine[0]
        np.testing.assert_allclose(centres, fine[0] + pixel * (frame.stride * np.arange(centres.size) + (frame.stride - 1) / 2))


def test_thinning_a_complete_map_changes_nothing(whole: EscapeMap) -> None:
    images, window = whole.thinned()
    assert images["fate"] is whole.fate
    assert window == whole.spec.find_window()


@pytest.mark.parametrize(("elapsed", "pause"), [(0.0, 0.1), (1.0, 0.3), (60.0, 1.0)])
def test_pause_between_frames_grows_with_elapsed_time(elapsed: float, pause: float) -> None:
    assert frame_pause(elapsed) == pytest.approx(pause)


# Bit-identical results.


@pytest.mark.parametrize("workers", [1, 2, 3])
@each_spec
def test_result_does_not_depend_on_the_number_of_threads(spec: MapSpec, workers: int) -> None:
    with ThreadPoolExecutor(workers) as pool:
        assert_bit_identical(compute_map(spec, executor=pool), compute_map(spec))


@pytest.mark.parametrize("budget", [2_000, 50_001])
def test_result_does_not_depend_on_the_step_budget(whole: EscapeMap, budget: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(orbit_batch, "STEP_BUDGET", budget)
    assert_bit_identical(compute_map(SPEC), whole)


def test_result_does_not_depend_on_the_tile_size(whole: EscapeMap, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(orbit_batch, "LARGEST_TILE", 64)
    assert_bit_identical(compute_map(SPEC), whole)


# The calls: parts of the starts, of the test which starts are outside, then tiles.
@pytest.mark.parametrize("good_calls", [0, 1, 4, 5, 9])
def test_map_with_a_cancelled_call_can_be_resumed_to_the_same_result(whole: EscapeMap, good_calls: int) -> None:
    cancel = threading.Event()
    with ForgetfulPool(good_calls, cancel) as pool:
        cancelled = compute_map(SPEC, cancel=cancel, executor=pool)
    assert not cancelled.complete
    assert_bit_identical(compute_map(SPEC, resume=cancelled), whole)


@pytest.mark.parametrize("frame", [1, 2, 3, 4])
def test_cancelled_map_can_be_resumed_to_the_same_result(whole: EscapeMap, frame: int, monkeypatch: pytest.MonkeyPatch) -> None:
    # A small step budget, so that cancelling interrupts orbits; no pause, so that each tile gives a frame.
    monkeypatch.setattr(orbit_batch, "STEP_BUDGET", 3_000)
    monkeypatch.setattr("engine.maps.compute.frame_pause", lambda elapsed: 0.0)
    cancel = CancelAfter(frame)
    cancelled = compute_map(SPEC, cancel, cancel.event)
    assert not cancelled.complete
    assert_bit_identical(compute_map(SPEC, resume=cancelled), whole)


def test_map_can_be_cancelled_and_resumed_repeatedly(whole: EscapeMap, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(orbit_batch, "STEP_BUDGET", 3_000)
    monkeypatch.setattr("engine.maps.compute.frame_pause", lambda elapsed: 0.0)
    result, rounds = None, 0
    while result is None or not result.complete:
        # Each round repeats the frames of finished stages, so later rounds need more frames.
        cancel = CancelAfter(3 * (rounds + 1))
        result, rounds = compute_map(SPEC, cancel, cancel.event, resume=result), rounds + 1
    assert rounds > 3
    assert_bit_identical(result, whole)


def test_map_cancelled_before_the_start_is_empty() -> None:
    cancel = threading.Event()
    cancel.set()
    result = compute_map(SPEC, cancel=cancel)
    assert not result.started.any()
    assert set(np.unique(result.fate)) == {Fate.NOT_COMPUTED, Fate.FORBIDDEN}


def test_cancelled_map_has_the_stride_of_its_last_stage() -> None:
    cancel = CancelAfter(1)
    result = compute_map(SPEC, cancel, cancel.event)
    assert result.stride == cancel.seen[0].stride > 1


@pytest.mark.parametrize("first", [20.0, 99.0, 100.0, 150.0, 299.0])
@each_spec
def test_resuming_with_larger_t_max_equals_a_single_run(spec: MapSpec, first: float) -> None:
    short = compute_map(MapSpec(spec.potential, spec.plane, spec.energy, spec.resolution, spec.window, first))
    assert_bit_identical(compute_map(spec, resume=short), compute_map(spec))


def test_only_states_that_a_larger_t_max_can_change_are_kept() -> None:
    escapes = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.35, (20, 20), t_max=30.0))
    assert escapes.batch is not None
    bounded = np.isfinite(escapes.batch.state).all(axis=1) & (escapes.batch.fate == Fate.BOUNDED)
    assert bounded.all()
    assert bounded.size == np.sum(escapes.fate == Fate.BOUNDED) > 0


def test_resuming_does_not_change_the_earlier_map() -> None:
    short = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.35, (20, 20), t_max=30.0))
    before = short.fate.copy(), short.batch.t.copy() if short.batch else None
    compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.35, (20, 20), t_max=100.0), resume=short)
    np.testing.assert_array_equal(short.fate, before[0])
    np.testing.assert_array_equal(short.batch.t, before[1])


def changed_resolution(s: MapSpec) -> MapSpec:
    return MapSpec(s.potential, s.plane, s.energy, (71, 66), s.window, s.t_max)


def changed_energy(s: MapSpec) -> MapSpec:
    return MapSpec(s.potential, s.plane, 0.36, s.resolution, s.window, s.t_max)


def shorter(s: MapSpec) -> MapSpec:
    return MapSpec(s.potential, s.plane, s.energy, s.resolution, s.window, 299.0)


@pytest.mark.parametrize("change", [changed_resolution, changed_energy, shorter])
def test_resuming_another_map_raises(whole: EscapeMap, change: Callable[[MapSpec], MapSpec]) -> None:
    with pytest.raises(ValueError, match="resume"):
        compute_map(change(SPEC), resume=whole)


@pytest.fixture(scope="module")
def starts(whole: EscapeMap) -> np.ndarray:
    """Interior starts of the map, in pixel order."""
    x, px = (grid.ravel() for grid in np.meshgrid(whole.x, whole.ordinate))
    inside = (whole.fate.ravel() != Fate.FORBIDDEN) & (whole.fate.ravel() != Fate.OUTSIDE)
    return start_states(SPEC.potential, SPEC.plane, 0.35, x[inside], px[inside])


@pytest.fixture(scope="module")
def outcomes(starts: np.ndarray) -> Outcomes:
    return classify_orbits(SPEC.potential, 0.35, starts, 300.0)


def test_classified_orbits_have_the_outcomes_of_the_map(whole: EscapeMap, outcomes: Outcomes) -> None:
    inside = (whole.fate != Fate.FORBIDDEN) & (whole.fate != Fate.OUTSIDE)
    for name in OUTCOMES:
        np.testing.assert_array_equal(getattr(outcomes, name), getattr(whole, name)[inside], err_msg=name)


@pytest.mark.parametrize("seed", [0, 1])
def test_outcomes_do_not_depend_on_the_order_of_orbits(starts: np.ndarray, outcomes: Outcomes, seed: int) -> None:
    order = np.random.default_rng(seed).permutation(len(starts))
    shuffled = classify_orbits(SPEC.potential, 0.35, starts[order], 300.0)
    for name in OUTCOMES:
        np.testing.assert_array_equal(getattr(shuffled, name), getattr(outcomes, name)[order], err_msg=name)


@pytest.mark.parametrize("kind", [0, 1, 2, 3, 4])
def test_single_orbits_have_the_outcomes_of_the_map(starts: np.ndarray, outcomes: Outcomes, kind: int) -> None:
    for n in np.flatnonzero(outcomes.fate == kind)[::97][:6]:
        orbit = integrate_orbit(SPEC.potential, starts[n], 300.0)
        # The energy computed from the start may differ by 1e-16, and then the exits differ in the last digits.
        assert (orbit.fate, orbit.crossings) == (outcomes.fate[n], outcomes.crossings[n])
        assert orbit.escape_time == pytest.approx(outcomes.escape_time[n], rel=1e-9, nan_ok=True)


def test_dtypes_of_outcomes(outcomes: Outcomes) -> None:
    assert [getattr(outcomes, name).dtype for name in OUTCOMES] == [np.int8, np.float64, np.int32, np.float64]


def test_no_orbits_give_no_outcomes() -> None:
    assert classify_orbits(CASES["I"], 0.2, np.empty((0, 4))).fate.size == 0


def test_start_beyond_a_lyapunov_orbit_is_outside() -> None:
    energy = 0.3
    for orbit in find_lyapunov_orbits(CASES["II"], energy):
        x, y = 1.1 * orbit.x[[50]], 1.1 * orbit.y[[50]]
        outcome = classify_orbits(CASES["II"], energy, start_states(CASES["II"], Plane.X_Y, energy, x, y), 10.0)
        assert outcome.fate[0] == Fate.OUTSIDE
        assert np.isnan(outcome.escape_time[0])


def test_cancelled_orbits_stay_undecided(starts: np.ndarray) -> None:
    cancel = threading.Event()
    cancel.set()
    fate = classify_orbits(SPEC.potential, 0.35, starts[:2000], 1e7, execution=Execution(cancel=cancel)).fate
    assert Fate.NOT_COMPUTED in fate


# Invalid arguments.


@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({"energy": np.nan}, "energy=nan"),
        ({"energy": np.inf}, "energy=inf"),
        ({"states": [[0.0, 0.0, 0.0]]}, r"states of shape \(1, 3\)"),
        ({"states": [0.0, 0.0, 0.0, 0.5]}, r"states of shape \(4,\)"),
        ({"states": [[0, 0, 0, np.sqrt(0.4)], [np.nan, 0, 0, 0]]}, "states: row 1 .* not finite"),
        ({"states": [[0, 0, 0, np.sqrt(0.4)], [0, 0, np.inf, 0]]}, "states: row 1 .* not finite"),
        ({"states": [[0, 0, 0, np.sqrt(0.4)], [0, 0, 0, 0.1]]}, r"states: row 1 has energy 0\.005\d*; .* energy=0\.2"),
        ({"states": [[0, 0, 0, np.sqrt(0.4 + 4e-9)]]}, r"states: row 0 has energy 0\.2"),
        ({"t_max": 0.0}, r"t_max=0\.0"),
        ({"t_max": -3.0}, r"t_max=-3\.0"),
        ({"t_max": np.nan}, "t_max=nan"),
        ({"t_max": np.inf}, "t_max=inf"),
    ],
)
def test_error_names_the_invalid_argument(changed: dict, named: str) -> None:
    arguments = {"energy": 0.2, "states": [[0.0, 0.0, 0.0, np.sqrt(0.4)]], "t_max": 10.0} | changed
    with pytest.raises(ValueError, match=named):
        classify_orbits(CASES["I"], **arguments)


def test_states_may_differ_from_the_energy_by_rounding() -> None:
    assert classify_orbits(CASES["I"], 0.2, [[0.0, 0.0, 0.0, np.sqrt(0.4 + 1e-9)]], 5.0).fate[0] == Fate.BOUNDED


# Export.


@each_spec
def test_netcdf_round_trip_preserves_values_and_coordinates(spec: MapSpec, tmp_path: Path) -> None:
    exported = compute_map(spec).to_xarray()
    exported.to_netcdf(tmp_path / "map.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "map.nc", engine="h5netcdf") as loaded:
        xr.testing.assert_equal(loaded, exported)
        assert {name: loaded[name].dtype for name in exported} == {name: exported[name].dtype for name in exported}


def test_netcdf_round_trip_preserves_provenance(whole: EscapeMap, tmp_path: Path) -> None:
    whole.to_xarray().to_netcdf(tmp_path / "map.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "map.nc", engine="h5netcdf") as loaded:
        for name, value in whole.provenance().items():
            np.testing.assert_array_equal(loaded.attrs[name], value, err_msg=name)


def test_provenance_contains_the_request(whole: EscapeMap) -> None:
    provenance = whole.provenance()
    assert (provenance["potential"], provenance["energy"], provenance["plane"], provenance["t_max"]) == (
        "III",
        0.35,
        "(x, px)",
        300.0,
    )
    assert provenance["terms"] == "0.5 x^2 y^0; 0.5 x^0 y^2; -1.0 x^2 y^2"
    assert provenance["resolution"] == (70, 66)
    assert provenance["window"] == (
        SPEC.find_window().x_low,
        SPEC.find_window().x_high,
        SPEC.find_window().ordinate_low,
        SPEC.find_window().ordinate_high,
    )
    assert provenance["worst_energy_error"] == whole.worst_energy_error


def test_provenance_counts_all_pixels(whole: EscapeMap) -> None:
    counts = dict(entry.split(": ") for entry in whole.provenance()["counts"].split("; "))
    assert {int(code): int(count) for code, count in counts.items()} == {
        int(code): int((whole.fate == code).sum()) for code in np.unique(whole.fate)
    }


def test_incomplete_map_is_exported_as_incomplete(frames: list[EscapeMap]) -> None:
    assert frames[0].to_xarray().attrs["complete"] == 0
