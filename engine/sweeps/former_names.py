"""Former names of sweeps, which are deprecated."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from engine.slices.axes import ParameterAxis
from engine.slices.slice import Slice
from engine.sweeps.measures import CURVES, QUICK_CURVES
from engine.sweeps.spec import SweepSpec
from engine.sweeps.sweep import Sweep, compute_sweep
from engine.systems.potential import Potential

if TYPE_CHECKING:
    import xarray as xr


def _make_curves_spec(
    potential: Potential,
    plane: Slice,
    values: Sequence[float],
    resolution: tuple[int, int] = (112, 112),
    t_max: float = 1e5,
    exponent: bool = True,
    along: ParameterAxis | None = None,
    energy: float | None = None,
    refine: int = 0,
) -> SweepSpec:
    measures = CURVES if exponent else QUICK_CURVES
    return SweepSpec(
        potential, plane, values, resolution, t_max=t_max, measures=measures, along=along, energy=energy, refine=refine
    )


def _run_sweep(spec: SweepSpec, store: Any, **options: Any) -> xr.Dataset:
    return compute_sweep(spec, store, **options).dataset


_FORMER: Mapping[str, tuple[Any, str]] = {
    "Curves": (Sweep, "Sweep"),
    "CurvesSpec": (_make_curves_spec, "SweepSpec"),
    "compute_curves": (compute_sweep, "compute_sweep"),
    "run_sweep": (_run_sweep, "compute_sweep"),
}

FORMER_NAMES = tuple(_FORMER)


def find_former_name(name: str) -> Any:
    """What stands for a former name, with a warning that names the new one. Raises AttributeError for any other name."""
    if name not in _FORMER:
        raise AttributeError(f"module 'engine' has no attribute {name!r}")
    found, new = _FORMER[name]
    warnings.warn(f"{name} is deprecated: use {new}", DeprecationWarning, stacklevel=2)
    return found
