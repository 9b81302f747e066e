"""The stored steps of an orbit follow each other without gaps."""

from __future__ import annotations

import numpy as np

from engine import CASES
from engine.integrator.bound_kernels import load_kernels
from engine.integrator.kernels import dense_output
from engine.integrator.source.series import Setting

POTENTIAL = CASES["III"]
START = np.array([0.1, 0.0, 0.2, 0.6])


def test_steps_cover_the_whole_time_and_each_starts_at_the_end_of_the_one_before() -> None:
    kernels = load_kernels(POTENTIAL.terms, Setting(POTENTIAL.channels))
    steps = dense_output.trace_steps(kernels, START, 50.0, 4)
    ends = dense_output.sample_path(kernels, steps, np.append(np.nextafter(steps[1:, 4], 0), 50.0))
    np.testing.assert_allclose(ends[:, :-1].T, steps[1:, :4], atol=1e-14)
    t = steps[:, 4]
    assert t[0] == 0.0
    assert np.all(np.diff(t) > 0)
    assert t[-1] < 50.0 <= t[-1] + 1.0
