"""Basin entropy agrees with a simple loop, known distributions and published values."""

from __future__ import annotations

import math
from collections import Counter
from itertools import product

import numpy as np
import pytest

from engine import CASES, MapSpec, Plane, compute_map
from engine.measures.basins.basin_entropy import COUNTS_BOUNDED, compute_basin_entropy
from engine.measures.basins.starts import exit_labels

LN2 = math.log(2.0)


def entropy_of(*shares: float) -> float:
    return math.fsum(-share * math.log(share) for share in shares if share)


def random_labels(side: int, labels: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).integers(labels, size=(side, side))


def box_by_box(labels: np.ndarray, valid: np.ndarray, box: int) -> list[float]:
    """Return entropies of the boxes that count, by a simple loop."""
    rows, columns = labels.shape
    entropies = []
    for row, column in product(range(0, rows - box + 1, box), range(0, columns - box + 1, box)):
        part = np.s_[row : row + box, column : column + box]
        if valid[part].all():
            counts = Counter(labels[part].ravel().tolist())
            entropies.append(entropy_of(*(count / box**2 for count in counts.values())))
    return entropies


def grebogi_basins(side: int) -> np.ndarray:
    """Return the two basins of the map of Grebogi, McDonald, Ott & Yorke (1983), with fixed points at θ = 0 and π."""
    theta, x = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, side), np.linspace(-0.5, 0.5, side))
    for _ in range(150):
        theta, x = theta + 1.32 * np.sin(2.0 * theta) - 0.9 * np.sin(4.0 * theta) - x * np.sin(theta), -0.3 * np.cos(theta)
    assert np.abs(np.sin(theta)).max() < 1e-6
    basins: np.ndarray = (np.cos(theta) > 0).astype(int)
    return basins


# Values.


def test_a_straight_boundary_has_the_entropy_of_two_shares() -> None:
    columns = 2
    labels = np.zeros((20, 25), int)
    labels[:, 10 + columns :] = 7
    result = compute_basin_entropy(labels)
    assert result.s_bb == pytest.approx(entropy_of(columns / 5, 1 - columns / 5), rel=1e-14)
    assert result.s_b == pytest.approx(result.s_bb / 5, rel=1e-14)
    assert (result.boxes, result.boundary_boxes, result.labels) == (20, 4, 2)


@pytest.mark.parametrize("box", [2, 5])
def test_random_images_agree_with_a_loop_over_boxes(box: int) -> None:
    seed = box
    labels = random_labels(41, 4, seed)[:, :37] - 2
    labels[:20] = np.minimum(labels[:20], -1)
    valid = np.random.default_rng(seed).random(labels.shape) > 0.02
    entropies = box_by_box(labels, valid, box)
    result = compute_basin_entropy(labels, valid, box=box)
    assert result.boxes == len(entropies)
    assert result.s_b == pytest.approx(np.mean(entropies), rel=1e-12)
    assert result.s_bb == pytest.approx(np.mean([entropy for entropy in entropies if entropy]), rel=1e-12)


def test_grebogis_map_has_the_entropies_of_attractors_jl() -> None:
    """The bounds are those of test/basins/uncertainty_tests.jl in Attractors.jl, for 300 × 300 starts and boxes of 6 × 6."""
    result = compute_basin_entropy(grebogi_basins(300), box=6)
    assert 0.40 <= result.s_b <= 0.42
    assert 0.60 <= result.s_bb <= 0.61


# The ln 2 criterion.


def test_three_random_basins_are_beyond_ln2() -> None:
    labels = random_labels(100, 3)
    labels[:, :50] = 0
    result = compute_basin_entropy(labels)
    assert result.s_b < LN2 < result.s_bb
    assert result.beyond_ln2


def test_two_basins_in_equal_parts_are_not_beyond_ln2() -> None:
    labels = np.indices((60, 60)).sum(axis=0) % 2
    result = compute_basin_entropy(labels, box=6)
    assert result.s_bb == pytest.approx(LN2, rel=1e-14)
    assert not result.beyond_ln2


# Invariance, and pixels that do not count.


# Descriptions and a map.


@pytest.mark.parametrize(
    ("labels", "words"),
    [
        (np.zeros((10, 10), int), "no box holds more than one label"),
        (random_labels(100, 3), "S_bb > ln 2"),
    ],
)
def test_the_description_states_the_conclusion(labels: np.ndarray, words: str) -> None:
    assert words in compute_basin_entropy(labels).describe()


def test_the_boundaries_of_henon_heiles_are_beyond_ln2() -> None:
    """The boundaries are fractal: Aguirre, Vallejo & Sanjuán 2001, Phys. Rev. E 64, 066208."""
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (150, 150), t_max=1e3))
    assert compute_basin_entropy(*exit_labels(frame.fate, bounded=COUNTS_BOUNDED)).beyond_ln2
