"""Deprecated names of the public objects of the package and of their fields."""

from __future__ import annotations

import functools
import sys
import warnings
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from importlib import import_module
from types import MappingProxyType
from typing import Any

from engine.foundations.stored_fields import FORMER_FIELDS

FORMER_NAMES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "CHAOS_THRESHOLD": ("its value, 1e-7", "propagation.fates:CHAOS_THRESHOLD"),
        "Certificate": ("Evidence", "propagation.fates:Evidence"),
        "Curves": ("escape_explorer.results.Sweep", "sweeps.sweep:Sweep"),
        "CurvesSpec": ("SweepSpec", ""),
        "IndicatorVerdict": ("OrbitVerdict.findings", "trajectories.chaos_indicators:IndicatorVerdict"),
        "SweepPlan": ("plan_sweep", "sweeps.plan:SweepPlan"),
        "Verdict": ("the words of OrbitVerdict.character", "trajectories.chaos_indicators:Verdict"),
        "channel_family": ('POTENTIALS["C3"] to POTENTIALS["C8"]', ""),
        "compute_birkhoff_digits": ("Orbit.compute_birkhoff_digits", "trajectories.birkhoff_digits:compute_birkhoff_digits"),
        "compute_curves": ("compute_sweep", "sweeps.sweep:compute_sweep"),
        "default_window": ("MapSpec.find_window", "slices.default_window:default_window"),
        "evaluate_indicators": ("OrbitVerdict.findings", "trajectories.chaos_indicators:evaluate_indicators"),
        "find_multipliers": ("LyapunovOrbit.find_multipliers", ""),
        "find_section_crossings": ("Orbit.find_section_crossings", ""),
        "run_sweep": ("compute_sweep", ""),
        "trace_zero_velocity_curve": ("MapSpec.trace_zero_velocity_curve", "slices.limiting_curves:trace_zero_velocity_curve"),
    }
)
"""Former public names, each with its replacement in words and the object to which it still refers, as "module:object", or ""."""


def find_former_name(name: str, stacklevel: int = 2) -> Any:
    """Return the object of a former public name of `escape_explorer`, and warn; raise an AttributeError for any other name.

    Former names are the keys of `FORMER_NAMES`, and names that have moved to `escape_explorer.results`. `stacklevel` has the
    meaning of `warnings.warn`; by default the warning refers to the caller.
    """
    if name in import_module("..results", __package__).__all__:
        replacement, location = f"escape_explorer.results.{name}", f"results:{name}"
    else:
        replacement, location = FORMER_NAMES.get(name, ("", ""))
    if not location:
        hint = f": use {replacement}" if replacement else ""
        raise AttributeError(f"module 'escape_explorer' has no attribute {name!r}{hint}")
    _warn(name, replacement, stacklevel + 1)
    module_name, _, attribute = location.partition(":")
    return getattr(import_module(f"..{module_name}", __package__), attribute)


def with_former_fields[T](cls: type[T]) -> type[T]:
    """Add the `FORMER_FIELDS` to a dataclass, as attributes and as parameters; each use of a former name gives a warning."""
    field_names = {field.name for field in fields(cls)}  # type: ignore[arg-type]
    for old, new in FORMER_FIELDS.items():
        if hasattr(cls, new) or new in field_names:
            setattr(cls, old, _former_attribute(old, new))
    former_parameters = {old: new for old, new in FORMER_FIELDS.items() if new in field_names}
    cls.__init__ = with_former_parameters(**former_parameters)(cls.__init__)  # type: ignore[method-assign]
    return cls


def _former_attribute(old: str, new: str) -> property:
    """Return a property that warns and returns the attribute with the new name."""

    def get(self: Any) -> Any:
        _warn(old, new)
        return getattr(self, new)

    return property(get)


def with_former_parameters[**P, T](**new_names: str) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Decorate a function to accept former names of parameters, given as ``former="new"``; each use gives a warning.

    Both names in one call are a TypeError. Only `dataclasses.replace` may pass both, because it adds the present value of each
    field that it is not given.
    """

    def decorate(function: Callable[P, T]) -> Callable[P, T]:
        @functools.wraps(function)
        def call(*args: P.args, **kwargs: P.kwargs) -> T:
            for old in new_names.keys() & kwargs.keys():
                new = new_names[old]
                if new in kwargs and not _is_called_by_replace():
                    raise TypeError(f"{old}: is the former name of {new}; must not be given with it")
                _warn(old, new)
                kwargs[new] = kwargs.pop(old)
            return function(*args, **kwargs)

        return call

    return decorate


def _is_called_by_replace() -> bool:
    """Return whether `dataclasses.replace` has called the function that calls this one."""
    return sys._getframe(2).f_globals.get("__name__") == replace.__module__


def _warn(old: str, new: str, stacklevel: int = 3) -> None:
    """Warn that a name is deprecated; by default the warning refers to the caller of the calling function."""
    warnings.warn(f"{old} is deprecated: use {new}", DeprecationWarning, stacklevel=stacklevel)
