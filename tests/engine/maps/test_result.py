"""Maps have the right codes, shares, frames and provenance."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from engine import CASES, EscapeMap, Evidence, Fate, MapSpec, Plane, classify_orbits, compute_map, start_states
from engine.results import Outcomes

OUTCOMES = ("fate", "escape_time", "crossings", "energy_error")
# A map with bounded, escaping, forbidden and outside pixels, and more pixels than the first frame.
SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.35, (70, 66), t_max=300.0)


@pytest.fixture(scope="module")
def whole() -> EscapeMap:
    return compute_map(SPEC)


# Contents of a map.


def test_complete_map_has_no_undecided_pixels(whole: EscapeMap) -> None:
    assert whole.complete
    np.testing.assert_array_equal(np.isfinite(whole.escape_time), whole.fate >= 1)
    assert 0 < np.nanmin(whole.escape_time) < np.nanmax(whole.escape_time) <= 300.0
    assert 0 < whole.worst_energy_error < 1e-13
    assert (whole.undecided, whole.progress, whole.stride, whole.horizon) == (0.0, 1.0, 1, 300.0)


def test_orbits_below_every_saddle_are_bounded_without_integration() -> None:
    result = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.12, (40, 40), t_max=1e5))
    inside = result.fate != Fate.FORBIDDEN
    assert inside.any()
    assert set(result.evidence[inside]) == {Evidence.CLOSED}
    assert set(result.crossings[inside]) == {0}


def test_exactly_the_starts_without_real_momentum_are_forbidden() -> None:
    spec = MapSpec(CASES["III"], Plane.X_H, (0.2, 0.6), (50, 40), t_max=10.0)
    result = compute_map(spec)
    x, ordinate = (grid.ravel() for grid in np.meshgrid(result.x, result.ordinate))
    exists = np.isfinite(start_states(spec.potential, spec.plane, 0.0, x, ordinate)).all(axis=1)
    np.testing.assert_array_equal(result.fate.ravel() == Fate.FORBIDDEN, ~exists)


@pytest.mark.parametrize(("name", "escape_energy"), [("I", 1 / 8), ("II", 1 / 6), ("III", 1 / 4)])
def test_at_the_escape_energy_nothing_escapes_and_starts_beyond_the_saddles_are_outside(name: str, escape_energy: float) -> None:
    spec = MapSpec(CASES[name], Plane.X_Y, escape_energy, (40, 40), window=(-2.0, 2.0, -2.0, 2.0), t_max=50.0)
    result = compute_map(spec)
    assert set(np.unique(result.fate)) == {Fate.BOUNDED, Fate.FORBIDDEN, Fate.OUTSIDE}
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


# Frames.


@pytest.fixture(scope="module")
def frames() -> list[EscapeMap]:
    seen: list[EscapeMap] = []
    compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.3, (90, 83), t_max=2000.0), seen.append)
    return seen


def test_later_frames_keep_the_decided_pixels(frames: list[EscapeMap]) -> None:
    for earlier, later in itertools.pairwise(frames):
        assert np.all(later.started >= earlier.started)
        decided = earlier.fate != Fate.NOT_COMPUTED
        np.testing.assert_array_equal(later.fate[decided], earlier.fate[decided])
        np.testing.assert_array_equal(later.escape_time[decided], earlier.escape_time[decided])
        assert later.progress >= earlier.progress
        assert later.stride <= earlier.stride


def test_thinned_frame_has_a_started_pixel_of_each_square(frames: list[EscapeMap]) -> None:
    frame = frames[0]
    thinned, stride = frame.thinned()[0]["escape_time"], frame.stride
    for row, column in np.ndindex(thinned.shape):
        square = np.s_[row * stride : (row + 1) * stride, column * stride : (column + 1) * stride]
        candidates = frame.escape_time[square][frame.started[square]]
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


# Bit-identical results.


def test_resuming_does_not_change_the_earlier_map() -> None:
    short = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.35, (20, 20), t_max=30.0))
    before = short.fate.copy(), short.batch.t.copy() if short.batch else None
    compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.35, (20, 20), t_max=100.0), resume=short)
    np.testing.assert_array_equal(short.fate, before[0])
    np.testing.assert_array_equal(short.batch.t, before[1])


@pytest.fixture(scope="module")
def starts(whole: EscapeMap) -> np.ndarray:
    """Return the interior starts of the map, in the order of its pixels."""
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


# Export.


def test_provenance_contains_the_request(whole: EscapeMap) -> None:
    window = SPEC.find_window()
    expected = {
        "potential": "III",
        "terms": "0.5 x^2 y^0; 0.5 x^0 y^2; -1.0 x^2 y^2",
        "energy": 0.35,
        "plane": "(x, px)",
        "t_max": 300.0,
        "resolution": (70, 66),
        "window": (window.x_low, window.x_high, window.ordinate_low, window.ordinate_high),
        "worst_energy_error": whole.worst_energy_error,
    }
    assert expected.items() <= whole.provenance().items()


def test_incomplete_map_is_exported_as_incomplete(frames: list[EscapeMap]) -> None:
    assert frames[0].to_xarray().attrs["complete"] == 0


@pytest.mark.parametrize("resolution", [(1, 1), (1, 7), (7, 1), (3, 200)])
def test_maps_of_unusual_resolutions_are_computed(resolution: tuple[int, int]) -> None:
    result = compute_map(MapSpec(CASES["I"], Plane.X_Y, 0.2, resolution, t_max=20.0))
    assert result.complete
    assert result.fate.shape == resolution[::-1]
