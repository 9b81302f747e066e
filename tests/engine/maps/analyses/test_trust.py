"""Doubtful pixels are those whose outcome changes in direct reruns. heyoka agrees with the map on confirmed pixels."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from engine import CASES, EscapeMap, Evidence, Fate, MapSpec, Plane, Window, compute_map
from engine.exits.exit_rows import exit_curves
from engine.integrator.kernels.dense_output import advance_states
from engine.integrator.source.recurrence import TOLERANCE
from engine.maps.analyses.reruns import LARGEST_DELAY, SECOND_TOLERANCE, SHIFT, shifted_starts
from engine.maps.analyses.trust import CHAOTIC_DISTANCE, Trust, TrustMap, compute_trust
from engine.maps.spec import FINEST_PIXEL
from engine.propagation.batch import OrbitBatch
from engine.propagation.batch_propagation import propagate_batch
from engine.slices.default_window import default_window

SAMPLE = 60
ZOOM = Window(0.25739561116 - 5e-10, 0.25739561116 + 5e-10, 0.13079102903 - 5e-10, 0.13079102903 + 5e-10)


@cache
def map_and_trust(
    name: str = "III",
    energy: float | tuple[float, float] = 0.45,
    plane: Plane = Plane.X_PX,
    side: int = 61,
    t_max: float = 1000.0,
    use_evidence: bool = True,
    window: Window = None,  # type: ignore[assignment]
) -> tuple[EscapeMap, TrustMap]:
    spec = MapSpec(CASES[name], plane, energy, (side, side), window, t_max, use_evidence)
    whole = compute_map(spec)
    return whole, compute_trust(whole)


def rerun(whole: EscapeMap, x: np.ndarray, ordinate: np.ndarray, tolerance: float) -> tuple[OrbitBatch, np.ndarray]:
    """Return orbits integrated directly to t_max, and their states at the escape or at t_max, of shape (n, 4)."""
    potential, t_max = whole.spec.potential, whole.spec.t_max
    energies, row = np.unique(
        ordinate if whole.spec.plane is Plane.X_H else np.full(x.size, whole.spec.energy), return_inverse=True
    )
    curves = np.array([exit_curves(potential, float(energy)) for energy in energies])
    batch = OrbitBatch.from_starts(whole.spec.start_states(x, ordinate), row)
    propagate_batch(potential, curves, batch, np.arange(x.size), t_max, final=True, tolerance=tolerance)
    remaining = np.where(batch.fate == Fate.BOUNDED, t_max - batch.t, 0.0)
    return batch, advance_states(potential.well.kernels, batch.state, remaining)


@pytest.mark.parametrize(
    ("name", "energy", "plane"),
    [("I", 0.2, Plane.X_Y), ("II", 0.2, Plane.X_PX), ("III", 0.45, Plane.X_PX), ("III", (0.3, 0.7), Plane.X_H)],
)
def test_doubtful_pixels_are_those_that_change_or_end_apart_in_direct_reruns(
    name: str, energy: float | tuple[float, float], plane: Plane
) -> None:
    whole, trust = map_and_trust(name, energy, plane, side=41, t_max=500.0)
    rows, columns = np.nonzero(np.isin(trust.trust, (Trust.CONFIRMED, Trust.DOUBTFUL)))
    # Only the first of two mirror images is tested.
    images = plane.find_mirror_images(whole.spec.potential, whole.x, whole.ordinate)
    pixels = rows * whole.x.size + columns
    first = np.ones(pixels.size, bool) if images is None else pixels <= images[pixels]
    rows, columns = rows[first], columns[first]
    x, ordinate, fate = whole.x[columns], whole.ordinate[rows], whole.fate[rows, columns]
    changes, ends = [], []
    for start, tolerance in zip(shifted_starts(whole.spec, x, ordinate), (TOLERANCE, SECOND_TOLERANCE), strict=True):
        batch, end = rerun(whole, *start, tolerance)
        delay = np.abs(batch.t - whole.escape_time[rows, columns])
        other = (batch.crossings != whole.crossings[rows, columns]) | (delay > LARGEST_DELAY)
        changes.append((batch.fate != fate) | ((fate >= 1) & other))
        ends.append(end)
    changed = np.any(changes, axis=0) | (fate == Fate.BOUNDED) & (np.linalg.norm(ends[1] - ends[0], axis=1) > CHAOTIC_DISTANCE)
    np.testing.assert_array_equal(trust.trust[rows, columns] == Trust.DOUBTFUL, changed)
    assert all(np.any(change) for change in changes)
    assert not changed.all()


# The first of starts 1e-12 apart in the chaotic sea of III at h = 0.3. Of 20 starts, the first 4 and 8 others stay until t = 1e5.
SEA = -0.3286892133349522, 0.7231162693368949


def test_bounded_orbits_of_a_slow_chaotic_sea_are_doubtful() -> None:
    x, y = SEA
    window = Window(x - 0.01, x + 0.01, y - 0.01, y + 0.01)
    sea = compute_map(MapSpec(CASES["III"], Plane.X_Y, 0.3, (1, 1), window))
    assert sea.fate == Fate.BOUNDED
    assert sea.evidence == Evidence.INTEGRATED
    assert compute_trust(sea).trust == Trust.DOUBTFUL


@pytest.mark.slow
def test_shifted_trusted_bounded_orbits_stay_bounded() -> None:
    spec = MapSpec(CASES["III"], Plane.X_Y, 0.3, (57, 57))
    whole = compute_map(spec)
    trusted = np.isin(compute_trust(whole).trust, (Trust.LIKE_NEIGHBOURS, Trust.CONFIRMED))
    rows, columns = np.nonzero(trusted & (whole.evidence == Evidence.INTEGRATED))
    assert rows.size >= 10
    doubtful = np.count_nonzero(whole.evidence == Evidence.INTEGRATED) - rows.size
    assert doubtful > 5 * rows.size
    for shift in 1e-12 * np.random.default_rng(3).uniform(-10.0, 10.0, (4, 2, rows.size)):
        assert np.all(
            rerun(whole, whole.x[columns] + shift[0], whole.ordinate[rows] + shift[1], TOLERANCE)[0].fate == Fate.BOUNDED
        )


@pytest.mark.slow
def test_heyoka_agrees_on_confirmed_pixels_and_differs_on_doubtful_ones() -> None:
    pytest.importorskip("heyoka")
    from tests.peers import taylor_heyoka
    from tests.peers.exit_lines import exit_lines

    whole, trust = map_and_trust()
    potential, energy = whole.spec.potential, 0.45
    disagreeing = {}
    for code in (Trust.LIKE_NEIGHBOURS, Trust.CONFIRMED, Trust.DOUBTFUL):
        rows, columns = np.nonzero(trust.trust == code)
        chosen = np.random.default_rng(5).permutation(rows.size)[:SAMPLE]
        rows, columns = rows[chosen], columns[chosen]
        starts = whole.spec.start_states(whole.x[columns], whole.ordinate[rows])
        answers = taylor_heyoka.classify(potential, exit_lines(potential, energy), starts, whole.spec.t_max)
        fate = whole.fate[rows, columns]
        other = (answers.fate != fate) | ((fate >= 1) & (answers.crossings != whole.crossings[rows, columns]))
        disagreeing[code] = float(other.mean())
    assert disagreeing[Trust.LIKE_NEIGHBOURS] == 0.0
    assert disagreeing[Trust.CONFIRMED] <= 0.01
    assert disagreeing[Trust.DOUBTFUL] >= 0.1


def test_doubtful_pixels_escape_late() -> None:
    whole, trust = map_and_trust("II", 0.2, side=101)
    doubtful = whole.escape_time[(trust.trust == Trust.DOUBTFUL) & (whole.fate >= 1)]
    confirmed = whole.escape_time[(trust.trust == Trust.CONFIRMED) & (whole.fate >= 1)]
    # A distance of 1e-11 needs 25 e-foldings to grow to order 1; Lyapunov exponents are at most about 0.5.
    assert doubtful.min() > 40.0
    assert doubtful.min() > np.median(confirmed)
    assert np.median(doubtful) > 3.0 * np.median(confirmed)


def test_deeper_zooms_have_more_doubtful_pixels() -> None:
    _, whole_picture = map_and_trust()
    _, zoom = map_and_trust(window=ZOOM)
    assert zoom.doubtful_share > 3.0 * whole_picture.doubtful_share


def test_pixels_are_tested_without_evidence_or_if_a_neighbour_has_another_outcome() -> None:
    whole, trust = map_and_trust("III", 0.45, side=31)
    rows, columns = whole.fate.shape
    for row, column in np.ndindex(rows, columns):
        fate = whole.fate[row, column]
        if fate < Fate.BOUNDED:
            assert trust.trust[row, column] == Trust.NOT_APPLICABLE
            continue
        near = np.s_[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2]
        fates, crossings = whole.fate[near], whole.crossings[near]
        other = (fates >= 0) & ((fates != fate) | ((fate >= 1) & (crossings != whole.crossings[row, column])))
        tested = trust.trust[row, column] in (Trust.CONFIRMED, Trust.DOUBTFUL)
        assert tested == (other.any() or whole.evidence[row, column] == Evidence.INTEGRATED)


def test_mirror_images_have_the_same_trust() -> None:
    plane = Plane.X_PX
    whole, trust = map_and_trust(plane=plane, window=default_window(CASES["III"], plane, 0.45))
    images = plane.find_mirror_images(whole.spec.potential, whole.x, whole.ordinate)
    assert images is not None
    np.testing.assert_array_equal(trust.trust.ravel(), trust.trust.ravel()[images])


def test_shifted_starts_from_the_axis_have_no_additional_crossing() -> None:
    whole, trust = map_and_trust(plane=Plane.X_Y)
    middle = whole.ordinate == 0.0
    assert middle.any()
    early = middle[:, None] & (whole.escape_time < 50.0)
    assert np.any(early & (trust.trust == Trust.CONFIRMED))
    assert not np.any(early & (trust.trust == Trust.DOUBTFUL))


def test_pixels_doubtful_with_evidence_are_doubtful_without() -> None:
    on_evidence, trust = map_and_trust("III", 0.28, side=25, t_max=1e4)
    integrated, integrated_trust = map_and_trust("III", 0.28, side=25, t_max=1e4, use_evidence=False)
    np.testing.assert_array_equal(on_evidence.fate, integrated.fate)
    doubtful = integrated_trust.trust == Trust.DOUBTFUL
    assert np.all(doubtful[trust.trust == Trust.DOUBTFUL])
    # Some chaotic orbits are enclosed by tori. Without evidence, the analysis does not know that they stay inside.
    assert np.all(on_evidence.evidence[doubtful & (trust.trust != Trust.DOUBTFUL)] > Evidence.INTEGRATED)
    assert np.any((trust.trust == Trust.CONFIRMED) & (on_evidence.fate == Fate.BOUNDED))


def test_later_frames_keep_the_decided_pixels(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("engine.maps.stages.LONGEST_PAUSE", 0.0)
    whole, trust = map_and_trust()
    frames: list[TrustMap] = []
    compute_trust(whole, on_frame=frames.append)
    assert len(frames) > 3
    assert not frames[0].complete
    for before, after in pairwise(frames):
        decided = before.trust != Trust.NOT_TESTED
        np.testing.assert_array_equal(before.trust[decided], after.trust[decided])
    np.testing.assert_array_equal(frames[-1].trust, trust.trust)


def test_shares_refer_to_the_interior_pixels() -> None:
    codes = np.array([[0, 0, 1, 1, 1], [2, 2, 2, 3, 4]], np.int8)
    trust = TrustMap(MapSpec(CASES["I"], Plane.X_PX, 0.2, (5, 2)), codes, complete=False)
    assert trust.doubtful_share == 1 / 8
    assert trust.tested_share == 4 / 8
    assert trust.describe().startswith("Of the pixels inside, 50.00 % were tested so far and 12.50 % are doubtful")


@pytest.mark.parametrize("size", [1.0, 1e-10, 1e-13])
def test_shift_is_far_below_a_pixel_and_above_rounding(size: float) -> None:
    spec = MapSpec(CASES["III"], Plane.X_PX, 0.45, (40, 40), Window(0.3 - size, 0.3, -0.2 - size, -0.2))
    x, ordinate = spec.pixel_centres()
    for before, after in zip((x, ordinate), shifted_starts(spec, x, ordinate)[0], strict=True):
        shift = np.abs(before) - np.abs(after)
        smallest = 0.9 * min(SHIFT, 0.01 * size / 40)
        assert np.all(shift > max(smallest, 0.9 * FINEST_PIXEL))
        # In the deepest zoom, rounding is a large part of a pixel.
        assert np.all(shift < max(1.1 * min(SHIFT, 0.01 * size / 40), 1.1 * FINEST_PIXEL))
