"""Pools of processes compute after their parent has computed, however their processes start."""

from __future__ import annotations

import multiprocessing
import warnings
from pathlib import Path

import pytest

from engine import CASES, MapSpec, Plane, compute_map
from tests import forked
from tests.waiting import SECONDS

SPEC = MapSpec(CASES["I"], Plane.X_PX, 0.3, (30, 30), t_max=50.0)


def shares_of(spec: MapSpec) -> dict[int, float]:
    return compute_map(spec).fractions()


def compute_in_a_pool(method: str) -> None:
    wanted = shares_of(SPEC)
    with warnings.catch_warnings():
        # Python 3.12 warns about a fork of a process with threads.
        warnings.simplefilter("ignore", DeprecationWarning)
        with multiprocessing.get_context(method).Pool(1) as pool:
            assert pool.apply_async(shares_of, (SPEC,)).get(SECONDS) == wanted


@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
def test_a_pool_computes_after_its_parent(method: str, tmp_path: Path) -> None:
    assert forked.run(tmp_path, compute_in_a_pool, method).code == 0
