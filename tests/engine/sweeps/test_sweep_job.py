"""Jobs of typed formulas find their potentials within limits."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from engine import ParameterAxis, Plane, SweepSpec, System
from engine.jobs.manager import Jobs
from engine.sweeps.sweep_job import sweep_job
from engine.systems.system import TYPED
from tests.engine.jobs.inbox import Inbox
from tests.waiting import SECONDS

LETTER = System(TYPED, "½(x² + y²) − a x²y + y³/3")
KNOWN = System("I")


def sweep_along(system: System, name: str) -> SweepSpec:
    axis = ParameterAxis(name, 0.8, 1.2, system)
    return SweepSpec(system.potential, Plane.X_PX, (0.9, 1.1), (16, 16), t_max=50.0, measures=("shares",), along=axis, energy=0.2)


def refuse(call: Callable[[], Any], cancel: threading.Event) -> Any:
    raise ValueError("beyond its limits")


@pytest.mark.parametrize(("system", "name", "limited"), [(LETTER, "a", True), (KNOWN, "epsilon", False)])
def test_a_sweep_along_a_parameter_of_a_typed_formula_first_finds_the_potentials_within_limits(
    system: System, name: str, limited: bool
) -> None:
    inbox = Inbox()
    Jobs(run_limited=refuse).request(sweep_job(sweep_along(system, name)), inbox.result, inbox.error)
    assert inbox.done.wait(SECONDS)
    assert [str(error) for error in inbox.errors] == (["beyond its limits"] if limited else [])
    assert bool(inbox.results) is not limited


def test_a_sweep_along_two_letters_finds_the_potentials_of_each_line_within_limits() -> None:
    system, inbox, calls = System(TYPED, "½(x² + y²) − a x²y + b y³/3"), Inbox(), []

    def run_limited(call: Callable[[], Any], cancel: threading.Event) -> Any:
        calls.append(call)
        return call()

    axes = [ParameterAxis(name, 0.8, 1.2, system) for name in ("a", "b")]
    spec = replace(sweep_along(system, "a"), values=((0.9, 1.1), (1.0, 1.2)), along=axes)
    Jobs(run_limited=run_limited).request(sweep_job(spec), inbox.result, inbox.error)
    assert inbox.done.wait(SECONDS)
    assert inbox.results[0].axes == ("a", "b")
    # Along b, and along a at each of the two values of b.
    assert len(calls) == 3
