"""Curves from their datasets."""

from __future__ import annotations

import json
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.potentials.stored_potential import read_potential
from engine.potentials.system import System
from engine.slices.axes import ParameterAxis
from engine.slices.slice_text import read_slice
from engine.sweeps.curve_points import CurvePoint
from engine.sweeps.curves import Curves, CurvesSpec

if TYPE_CHECKING:
    import xarray as xr


def read_curves(dataset: xr.Dataset) -> Curves:
    """The curves of a dataset; ValueError if an attribute is missing."""
    try:
        spec = _read_spec(dataset.attrs)
    except KeyError as error:
        raise ValueError(f"dataset: has no attribute {error}; must be one of curves, written by this version") from None
    shares = dataset["share"].values.tolist()
    numbers = {each.name: dataset[each.name].values for each in fields(CurvePoint) if each.name not in ("value", "shares")}
    # Variables are floating-point numbers.
    numbers["islands"] = numbers["islands"].astype(int)
    points = (
        CurvePoint(value, tuple(shares[place]), **{name: column[place].item() for name, column in numbers.items()})
        for place, value in enumerate(dataset[spec.name].values.tolist())
    )
    return Curves(spec, tuple(points))


def _read_spec(found: dict[Any, Any]) -> CurvesSpec:
    """The request, from the attributes of `CurvesSpec.provenance`."""
    along = None
    if found["along"]:
        axis = read_slice(str(found["along"]), "", System(**json.loads(found["along_system"]))).parameter
        assert isinstance(axis, ParameterAxis)
        along = axis
    columns, rows = map(int, found["resolution"])
    return CurvesSpec(
        read_potential(found) if along is None else along.system.potential,
        read_slice(str(found["axes"]), str(found["fix"]), System("I")),
        tuple(map(float, np.atleast_1d(found["requested"]))), (columns, rows), float(found["t_max"]),
        bool(found["exponent"]), along, None if along is None else float(found["energy"]), int(found["refine"]),
    )  # fmt: skip
