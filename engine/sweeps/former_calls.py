"""What stands for former calls of sweeps that had other parameters or results, see `engine.foundations.former_names`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from engine.slices.axes import ParameterAxis
from engine.slices.slice import Slice
from engine.sweeps.measures import CURVES, QUICK_CURVES
from engine.sweeps.spec import SweepSpec
from engine.sweeps.sweep import compute_sweep
from engine.systems.potential import Potential

if TYPE_CHECKING:
    import xarray as xr


def make_curves_spec(
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
    """Make the request of a sweep from the parameters of `CurvesSpec`."""
    measures = CURVES if exponent else QUICK_CURVES
    return SweepSpec(
        potential, plane, values, resolution, t_max=t_max, measures=measures, along=along, energy=energy, refine=refine
    )


def run_sweep(spec: SweepSpec, store: Any, **options: Any) -> xr.Dataset:
    """Compute a sweep into a store, and return its dataset."""
    return compute_sweep(spec, store, **options).dataset
