from __future__ import annotations

import inspect

import pytest

import engine
from engine import service

OPTIONS = {"t_max", "execution", "executor", "cancel", "on_frame", "on_progress"}
# Their parameters may be given by position, as in earlier releases.
STABLE = {"classify_orbits", "compute_map", "integrate_orbit"}


def functions() -> list[str]:
    return [name for name in engine.__all__ if inspect.isfunction(getattr(engine, name))]


def test_each_name_is_public_or_for_programs() -> None:
    assert not set(engine.__all__) & set(service.__all__)
    assert all(hasattr(engine, name) for name in engine.__all__)


@pytest.mark.parametrize("name", functions())
def test_optional_parameters_are_keywords(name: str) -> None:
    parameters = inspect.signature(getattr(engine, name)).parameters.values()
    optional = [one.name for one in parameters if one.default is not one.empty and one.kind is one.POSITIONAL_OR_KEYWORD]
    assert name in STABLE or not (set(optional) & OPTIONS - {"t_max"})


def test_name_that_moved_works_with_a_warning() -> None:
    with pytest.warns(DeprecationWarning, match=r"engine\.Jobs is deprecated: import it from engine\.service"):
        assert engine.Jobs is service.Jobs


def test_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="has no attribute 'nothing'"):
        _ = engine.nothing
