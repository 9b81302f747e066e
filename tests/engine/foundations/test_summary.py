"""Results in a terminal: a few lines, with words instead of codes."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from engine import (
    CASES,
    MapSpec,
    Plane,
    Result,
    classify_orbits,
    compute_map,
    compute_regularity,
    compute_statistics,
    compute_trust,
    find_lyapunov_orbits,
    find_stable_manifolds,
    fit_decay_laws,
    integrate_orbit,
    review_potential,
    sample_starts,
)

III = CASES["III"]
SPEC = MapSpec(III, Plane.X_PX, 0.36, (30, 20), t_max=100.0)

RESULTS: dict[str, Callable[[], Result]] = {
    "map": lambda: compute_map(SPEC),
    "regularity": lambda: compute_regularity(compute_map(SPEC)),
    "trust": lambda: compute_trust(compute_map(SPEC)),
    "orbit": lambda: integrate_orbit(III, (0.1, 0.0, 0.05, 0.6), 20.0),
    "Lyapunov orbit": lambda: find_lyapunov_orbits(III, 0.36)[0],
    "manifolds": lambda: find_stable_manifolds(III, 0.36, images=1),
    "review": lambda: review_potential(III),
    "statistics": lambda: compute_statistics(compute_map(SPEC)),
    "decay laws": lambda: fit_decay_laws(compute_map(SPEC)),
    "outcomes": lambda: classify_orbits(III, 0.36, sample_starts(III, 0.36, 5), t_max=20.0),
}


@pytest.mark.parametrize("name", RESULTS)
def test_result_takes_a_few_short_lines(name: str) -> None:
    result = RESULTS[name]()
    lines = repr(result).splitlines()
    assert lines[0].startswith(type(result).__name__)
    assert len(lines) <= 7
    assert max(map(len, lines)) <= 100


def test_map_says_what_it_is_in_five_lines() -> None:
    text = repr(compute_map(SPEC))
    assert len(text.splitlines()) <= 5
    for part in ("potential III", "plane (x, px)", "energy 0.36", "channel 3 0.", "bounded 0.", "fate escape_time", "20 × 30"):
        assert part in text
