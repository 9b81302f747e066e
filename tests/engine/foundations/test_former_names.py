"""Former names work like the present names, with a warning."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

import engine
import escape_explorer
from engine import (
    CASES,
    Evidence,
    MapSpec,
    Plane,
    compute_map,
    compute_separation,
    integrate_orbit,
    results,
)
from engine.foundations.former_names import FORMER_NAMES

SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.36, (12, 10), t_max=200.0, use_evidence=False)


@pytest.mark.parametrize(
    ("old", "new"),
    [("Certificate", "Evidence"), ("compute_curves", "compute_sweep")],
)
@pytest.mark.parametrize("package", [engine, escape_explorer])
def test_former_public_names_stand_for_the_present_ones(old: str, new: str, package: ModuleType) -> None:
    with pytest.warns(DeprecationWarning, match=f"^{old} is deprecated: use {new}$") as caught:
        assert getattr(package, old) is getattr(engine, new)
    assert caught[0].filename == __file__


@pytest.mark.parametrize("name", [*(name for name, (_, location) in FORMER_NAMES.items() if location), *results.__all__])
def test_a_former_public_name_works_for_a_release_with_a_warning(name: str) -> None:
    assert name not in engine.__all__
    with pytest.warns(DeprecationWarning, match=f"^{name} is deprecated: use "):
        assert getattr(engine, name) is not None


def test_the_former_name_of_the_time_of_a_separation_works() -> None:
    states = (0.1, 0.0, 0.05, 0.6), (0.1 + 1e-9, 0.0, 0.05, 0.6)
    with pytest.warns(DeprecationWarning, match="^t_end is deprecated: use t_max$") as caught:
        former = compute_separation(CASES["I"], *states, t_end=5.0)  # type: ignore[call-arg]
    assert caught[0].filename == __file__
    np.testing.assert_array_equal(former.distance, compute_separation(CASES["I"], *states, t_max=5.0).distance)


@pytest.mark.parametrize(
    ("name", "present"), [("CurvesSpec", "SweepSpec"), ("find_multipliers", "LyapunovOrbit.find_multipliers")]
)
def test_a_name_that_is_gone_tells_what_to_use(name: str, present: str) -> None:
    with pytest.raises(AttributeError, match=f"no attribute '{name}': use {present}$"):
        getattr(engine, name)


def test_an_unknown_name_is_not_taken_for_a_former_name() -> None:
    with pytest.raises(AttributeError, match=r"no attribute 'Certificates'$"):
        engine.Certificates  # type: ignore[attr-defined]  # noqa: B018


@pytest.mark.parametrize(
    "make",
    [
        lambda: MapSpec(SPEC.potential, SPEC.plane, 0.36, (12, 10), t_max=200.0, certify=False),  # type: ignore[call-arg]
        lambda: replace(SPEC, use_evidence=True, certify=False),  # type: ignore[call-arg]
    ],
)
def test_former_parameters_are_taken(make: Callable[[], MapSpec]) -> None:
    with pytest.warns(DeprecationWarning, match="^certify is deprecated: use use_evidence$"):
        assert make() == SPEC


def test_both_names_of_a_parameter_are_refused() -> None:
    states = (0.1, 0.0, 0.05, 0.6), (0.1 + 1e-9, 0.0, 0.05, 0.6)
    with pytest.raises(TypeError, match=r"^t_end: is the former name of t_max; must not be given with it$"):
        compute_separation(CASES["I"], *states, t_max=5.0, t_end=6.0)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"^certify: is the former name of use_evidence"):
        MapSpec(SPEC.potential, SPEC.plane, 0.36, use_evidence=True, certify=False)  # type: ignore[call-arg]


def test_former_attributes_are_those_of_the_present_names() -> None:
    orbit, frame = integrate_orbit(CASES["II"], (0.1, 0.0, 0.0, 0.3), t_max=100.0), compute_map(SPEC)
    for thing, old, value in (
        (orbit, "certificate", Evidence.CLOSED),
        (frame, "certificate", frame.evidence),
        (SPEC, "certify", False),
        (SPEC.potential, "certifies_tori", True),
    ):
        with pytest.warns(DeprecationWarning, match=f"^{old} is deprecated") as caught:
            assert getattr(thing, old) is value
        assert caught[0].filename == __file__
