"""Public names exist, and optional parameters are keywords."""

from __future__ import annotations

import inspect

import pytest

import engine

OPTIONS = {"t_max", "execution", "executor", "cancel", "on_frame", "on_progress"}
# Functions whose parameters may be given by position, as in earlier releases.
STABLE = {"classify_orbits", "compute_map", "integrate_orbit"}


def functions() -> list[str]:
    return [name for name in engine.__all__ if inspect.isfunction(getattr(engine, name))]


def test_each_public_name_is_there() -> None:
    assert all(hasattr(engine, name) for name in engine.__all__)


@pytest.mark.parametrize("name", functions())
def test_optional_parameters_are_keywords(name: str) -> None:
    parameters = inspect.signature(getattr(engine, name)).parameters.values()
    optional = [one.name for one in parameters if one.default is not one.empty and one.kind is one.POSITIONAL_OR_KEYWORD]
    assert name in STABLE or not (set(optional) & OPTIONS - {"t_max"})
