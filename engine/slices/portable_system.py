"""A potential as data for an integrator on another machine: code, coefficients and exits, all in units of the well."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.exits.exit_rows import exit_gates
from engine.exits.exit_tables import ExitTable, tabulate_exits
from engine.exits.interior import find_inner_radius, tabulate_polynomial
from engine.integrator.jit.kernel_module import HEAP_CELL
from engine.integrator.jit.webassembly import FUNCTIONS, PAIR, webassembly_module
from engine.integrator.kernels import events, exit_geometry, slice_starts
from engine.integrator.kernels.random_starts import BEFORE_EXIT
from engine.integrator.source.recurrence import ROWS, TOLERANCE, generate_code
from engine.integrator.source.series import ORDER
from engine.slices.planes import ENERGY_SURFACE, SPACE
from engine.systems.forms.polynomial_form import PolynomialForm
from engine.systems.potential import Potential
from engine.systems.well_units import WellUnits

_EXIT_COLUMNS = {
    "count": exit_geometry.CURVE_COLUMNS,
    "shape": exit_geometry.SHAPE,
    "shapes": {
        "closed": exit_geometry.CLOSED,
        "curve": exit_geometry.CURVE,
        "line": exit_geometry.LINE,
    },
}


@dataclass(frozen=True, eq=False)
class PortableSystem:
    """The data needed to integrate the orbits of a potential, in units of its well.

    Attributes
    ----------
    potential
        The potential, in its own units.
    module
        WebAssembly with the functions of its structure, see `engine.integrator.jit.webassembly`.
    table
        (m,) the coefficients, as the functions of `module` take them.
    backward
        (m,) the coefficients of the system backward in time, whose orbits have the opposite velocities.
    exits
        The exits of each channel.
    """

    potential: Potential
    module: bytes
    table: np.ndarray
    backward: np.ndarray
    exits: tuple[ExitTable, ...]

    @property
    def nbytes(self) -> int:
        """Approximate size in bytes."""
        return len(self.module) + 2 * self.table.nbytes + sum(exits.rows.nbytes for exits in self.exits) + 2048

    def to_dict(self) -> dict[str, object]:
        """Return everything except the module as lists and numbers."""
        well, units = self.potential.in_well_units, self.potential.units
        mirror = self.potential.well.mirror_channels.tolist() if self.potential.well.mirror_in_x else None
        return {
            "layout": {
                "order": ORDER,
                "rows": ROWS,
                "lanes_together": PAIR,
                "tolerance": TOLERANCE,
                "heap": HEAP_CELL,
                "beforeExit": BEFORE_EXIT,
                "functions": list(FUNCTIONS),
                "fates": {"bounded": events.BOUNDED, "not_computed": events.NOT_COMPUTED},
                "exits": _EXIT_COLUMNS,
            },
            "table": self.table.tolist(),
            "backward": self.backward.tolist() if self.potential.rotation else None,
            "polynomial": _polynomial_data(well.form),
            "innerRadius": find_inner_radius(well),
            "exits": [*self._tables(), *_circles(well)],
            "mirror": mirror,
            "units": {"length": units.length, "time": units.time, "energy": units.energy},
            "space": SPACE.to_dict(units),
            "surface": _energy_surface(units),
        }

    def _tables(self) -> list[dict[str, object]]:
        """Return the exits over saddles."""
        shape = {"shape": "line" if self.potential.rotation else "curve"}
        return [
            {**shape, "saddle": each.saddle, "highest": each.highest, "nodes": each.nodes.tolist(), "rows": each.rows.tolist()}
            for each in self.exits
        ]


def _energy_surface(units: WellUnits) -> dict[str, object]:
    """Return the energy surface as a slice of positions with the angle of the velocity as third axis."""
    launched = ENERGY_SURFACE.to_dict(units)
    turned = [float(column == slice_starts.ANGLE) for column in range(slice_starts.COORDINATES)]
    return {**launched, "motion": [*launched["motion"], turned]}


def _circles(well: Potential) -> list[dict[str, object]]:
    """Return the rows for the kernels and the gates of the ends that are not over saddles."""
    return [
        {"side": end.side, "radius": end.radius, "row": end.row.tolist(), "gate": exit_gates(end.row[None, None])[0].tolist()}
        for end in well.ends
    ]


def _polynomial_data(form: Any) -> dict[str, object] | None:
    """Return a polynomial V as the interior test takes it, with lists for arrays; None for an expression."""
    if not isinstance(form, PolynomialForm):
        return None
    return {name: array.tolist() for name, array in tabulate_polynomial(form)._asdict().items()}


def make_portable_system(potential: Potential, highest: float) -> PortableSystem:
    """Return a potential as data, with exits for energies up to `highest`, in units of the potential.

    This takes up to a second for the first potential of a structure, and when exits are not cached.
    """
    well = potential.in_well_units
    definition, setting = well.form.definition, well.well.setting
    code = generate_code(definition, setting)
    table, backward = (code.tabulate(definition, rotation) for rotation in (well.rotation, -well.rotation))
    exits = tabulate_exits(well, highest / potential.units.energy)
    return PortableSystem(potential, webassembly_module(code), table, backward, exits)
