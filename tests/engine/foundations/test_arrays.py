"""Arrays of results stay read-only where results are copied, as between processes."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest

from engine import (
    CASES,
    MapSpec,
    Plane,
    classify_orbits,
    compute_map,
    compute_statistics,
    find_lyapunov_orbits,
    find_stable_manifolds,
    integrate_orbit,
    sample_starts,
)

SPEC = MapSpec(CASES["I"], Plane.X_PX, 0.2, (10, 10), t_max=100.0)

RESULTS: dict[str, Callable[[], Any]] = {
    "map": lambda: compute_map(SPEC),
    "orbit": lambda: integrate_orbit(CASES["I"], (0.1, 0.0, 0.05, 0.6), t_max=10.0),
    "outcomes": lambda: classify_orbits(CASES["I"], 0.2, sample_starts(CASES["I"], 0.2, 5), t_max=10.0),
    "manifolds": lambda: find_stable_manifolds(CASES["I"], 0.19, images=1),
    "Lyapunov orbits": lambda: find_lyapunov_orbits(CASES["I"], 0.2),
    "statistics": lambda: compute_statistics(compute_map(SPEC)),
}
COPIES: dict[str, Callable[[Any], Any]] = {"pickle": lambda result: pickle.loads(pickle.dumps(result)), "copy": copy.deepcopy}


def arrays_of(result: Any) -> Iterator[np.ndarray]:
    """The arrays of a result, and of the results in it; a map keeps the state of its orbits, which is no result."""
    if isinstance(result, np.ndarray):
        yield result
    elif isinstance(result, tuple):
        for part in result:
            yield from arrays_of(part)
    elif is_dataclass(result) and not isinstance(result, type):
        for field in fields(result):
            if field.name != "batch":
                yield from arrays_of(getattr(result, field.name))


@pytest.mark.parametrize("name", RESULTS)
@pytest.mark.parametrize("how", COPIES)
def test_arrays_of_a_copy_are_read_only(name: str, how: str) -> None:
    result = RESULTS[name]()
    copied = COPIES[how](result)
    pairs = list(zip(arrays_of(result), arrays_of(copied), strict=True))
    assert pairs
    for original, array in pairs:
        assert not original.flags.writeable
        assert not array.flags.writeable
        np.testing.assert_array_equal(array, original)
