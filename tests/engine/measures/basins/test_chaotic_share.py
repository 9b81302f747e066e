"""The chaotic share counts chaotic and regular bounded orbits only."""

from __future__ import annotations

import numpy as np

from engine import Regularity, compute_chaotic_share
from engine.measures.basins.starts import wilson_interval


def test_orbits_that_escape_or_are_not_judged_do_not_count() -> None:
    codes = [Regularity.CHAOTIC] * 3 + [Regularity.REGULAR] * 5 + [Regularity.NO_SIGN_OF_CHAOS] * 2
    found = compute_chaotic_share(np.array([*codes, Regularity.NOT_APPLICABLE, Regularity.NOT_JUDGED]))
    assert (found.chaotic, found.judged, found.share) == (3, 10, 0.3)
    assert (found.low, found.high) == tuple(map(float, wilson_interval(3, 10)))


def test_without_bounded_orbits_there_is_no_share() -> None:
    found = compute_chaotic_share(np.array([[Regularity.NOT_APPLICABLE]]))
    assert np.isnan([found.share, found.low, found.high]).all()
    assert found.describe() == "No bounded orbit was judged."
