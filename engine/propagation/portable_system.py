"""A potential as data for an integrator on another machine: code, coefficients and exits, all in units of the well."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.exits.exit_tables import ExitTable, tabulate_exits
from engine.exits.interior import find_inner_radius, tabulate_polynomial
from engine.integrator.jit.kernel_module import HEAP_CELL
from engine.integrator.jit.webassembly import FUNCTIONS, PAIR, webassembly_module
from engine.integrator.kernels import events
from engine.integrator.source.recurrence import ROWS, TOLERANCE, generate_code
from engine.integrator.source.series import ORDER, ROTATION
from engine.propagation.fates import Fate
from engine.systems.forms.polynomial_form import PolynomialForm
from engine.systems.potential import Potential

_EXIT_COLUMNS = {
    "count": events.CURVE_COLUMNS,
    "originX": events.ORIGIN_X,
    "originY": events.ORIGIN_Y,
    "outwardX": events.OUTWARD_X,
    "outwardY": events.OUTWARD_Y,
    "halfWidth": events.HALF_WIDTH,
    "shape": events.SHAPE,
    "shapes": {
        "closed": events.CLOSED,
        "curve": events.CURVE,
        "line": events.LINE,
        "disc": events.DISC,
        "circle": events.CIRCLE,
    },
}


@dataclass(frozen=True, eq=False)
class PortableSystem:
    """What integrates the orbits of a potential, in units of its well.

    Attributes
    ----------
    potential
        The potential, in its own units.
    module
        WebAssembly with the functions of its structure, see `engine.integrator.jit.webassembly`.
    table
        (m,) the coefficients in the form that the functions take.
    rotation
        Index of 2Ω in the table, which has the other sign backward in time; None in a frame that does not rotate.
    exits
        The exits of each channel.
    """

    potential: Potential
    module: bytes
    table: np.ndarray
    rotation: int | None
    exits: tuple[ExitTable, ...]

    @property
    def nbytes(self) -> int:
        """Approximate size in bytes."""
        return len(self.module) + self.table.nbytes + sum(exits.rows.nbytes for exits in self.exits) + 2048

    def to_dict(self) -> dict[str, object]:
        """All of it but the module as lists and numbers."""
        well, units = self.potential.in_well_units, self.potential.units
        mirror = self.potential.well.mirror_channels.tolist() if self.potential.well.mirror_in_x else None
        return {
            "layout": {
                "order": ORDER,
                "rows": ROWS,
                "lanes_together": PAIR,
                "tolerance": TOLERANCE,
                "heap": HEAP_CELL,
                "functions": list(FUNCTIONS),
                "fates": {fate.name.lower(): int(fate) for fate in Fate},
                "exits": _EXIT_COLUMNS,
            },
            "table": self.table.tolist(),
            "rotation": self.rotation,
            "polynomial": _polynomial_data(well.form),
            "innerRadius": find_inner_radius(well),
            "exits": [*self._tables(), *_circles(well)],
            "mirror": mirror,
            "units": {"length": units.length, "time": units.time},
        }

    def _tables(self) -> list[dict[str, object]]:
        """The exits over saddles."""
        shape = {"shape": "line" if self.potential.rotation else "curve"}
        return [
            {**shape, "saddle": each.saddle, "highest": each.highest, "nodes": each.nodes.tolist(), "rows": each.rows.tolist()}
            for each in self.exits
        ]


def _circles(well: Potential) -> list[dict[str, object]]:
    """The other ends."""
    return [{"side": end.side, "x": end.x, "y": end.y, "radius": end.radius} for end in well.ends]


def _polynomial_data(form: Any) -> dict[str, object] | None:
    """V as the interior test takes it, as lists; None for an expression."""
    if not isinstance(form, PolynomialForm):
        return None
    return {name: array.tolist() for name, array in tabulate_polynomial(form)._asdict().items()}


def make_portable_system(potential: Potential, highest: float) -> PortableSystem:
    """A potential as data, with exits for energies up to `highest`, in its own units.

    Takes up to a second the first time for each structure of a potential, and for exits that are not cached.
    """
    well = potential.in_well_units
    definition, setting = well.form.definition, well.well.setting
    code = generate_code(definition, **setting._asdict())
    table, rotation = code.tabulate(definition, well.rotation), code.entries.index(ROTATION) if setting.rotates else None
    exits = tabulate_exits(well, highest / potential.units.energy)
    return PortableSystem(potential, webassembly_module(code), table, rotation, exits)
