"""A potential as data for an integrator on another machine: code, coefficients and exits, all in units of the well."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.exits.exit_shapes import exit_gates
from engine.exits.exit_tables import ExitTable, tabulate_exits
from engine.exits.interior import find_inner_radius, tabulate_polynomial
from engine.integrator.jit.code_outlines import find_outline
from engine.integrator.jit.webassembly import webassembly_module
from engine.integrator.jit.webassembly_object import FUNCTIONS, HEAP_CELL, VECTOR_LANES
from engine.integrator.kernels import events, exit_geometry, slice_starts
from engine.integrator.kernels.random_starts import BEFORE_EXIT
from engine.integrator.source.recurrence import ROWS, TOLERANCE
from engine.integrator.source.series import ORDER
from engine.slices.planes import ENERGY_SURFACE, SPACE
from engine.slices.sections.section import Section
from engine.systems.forms.expression_form import Form
from engine.systems.forms.polynomial_form import PolynomialForm
from engine.systems.potential import Potential
from engine.systems.well_units import WellUnits

# For JavaScript: the number of columns of an exit, the column of its shape, and the codes of the shapes.
_EXIT_COLUMNS = {
    "count": exit_geometry.CURVE_COLUMNS,
    "shape": exit_geometry.SHAPE,
    "shapes": {"closed": exit_geometry.CLOSED, "curve": exit_geometry.CURVE, "line": exit_geometry.LINE},
}


@dataclass(frozen=True, eq=False)
class PortableSystem:
    """The data for the integration of the orbits of a potential, in units of its well.

    Attributes
    ----------
    potential
        The potential, in its own units.
    module
        WebAssembly with the functions of the potential's structure, see `engine.integrator.jit.webassembly`.
    table
        (m,) the coefficients, as the functions of `module` take them.
    backward_table
        (m,) the coefficients of the system backward in time, whose orbits have the opposite velocities.
    exits
        The exits of each channel.
    section
        The surface of section at which crossings are counted, in the units of the potential.
    """

    potential: Potential
    module: bytes
    table: np.ndarray
    backward_table: np.ndarray
    exits: tuple[ExitTable, ...]
    section: Section = Section.Y_UP

    def to_dict(self) -> dict[str, object]:
        """Return everything except the module as lists and numbers."""
        scaled_potential, units = self.potential.in_well_units, self.potential.units
        mirror = self.potential.well.mirror_fates.tolist() if self.potential.well.mirror_in_x else None
        return {
            "layout": {
                "order": ORDER,
                "rows": ROWS,
                "lanesTogether": VECTOR_LANES,
                "tolerance": TOLERANCE,
                "heap": HEAP_CELL,
                "beforeExit": BEFORE_EXIT,
                "functions": list(FUNCTIONS),
                "fates": {"bounded": events.BOUNDED, "notComputed": events.NOT_COMPUTED},
                "exits": _EXIT_COLUMNS,
            },
            "table": self.table.tolist(),
            "backward": self.backward_table.tolist() if self.potential.rotation else None,
            "polynomial": _polynomial_data(scaled_potential.form),
            "innerRadius": find_inner_radius(scaled_potential),
            "exits": [*self._saddle_exits(), *_end_exits(scaled_potential)],
            "section": [list(row) for row in self.section.in_well_units(units).numbers.rows],
            "mirror": mirror,
            "units": {"length": units.length, "time": units.time, "energy": units.energy},
            "space": SPACE.to_dict(units),
            "surface": _energy_surface(units),
        }

    def _saddle_exits(self) -> list[dict[str, object]]:
        """Return the exits over saddles as plain data."""
        shape = "line" if self.potential.rotation else "curve"
        return [
            {
                "shape": shape,
                "saddle": table.saddle,
                "highest": table.highest,
                "nodes": table.nodes.tolist(),
                "rows": table.rows.tolist(),
            }
            for table in self.exits
        ]


def _energy_surface(units: WellUnits) -> dict[str, object]:
    """Return the energy surface as a slice of positions with the angle of the velocity as third axis."""
    surface = ENERGY_SURFACE.to_dict(units)
    angle_motion = [float(column == slice_starts.ANGLE) for column in range(slice_starts.COORDINATES)]
    return {**surface, "motion": [*surface["motion"], angle_motion]}


def _end_exits(potential: Potential) -> list[dict[str, object]]:
    """Return the ends other than exits over saddles as plain data, with their rows for the kernels and their gates."""
    return [
        {"side": end.side, "radius": end.radius, "row": end.row.tolist(), "gate": exit_gates(end.row[None, None])[0].tolist()}
        for end in potential.ends
    ]


def _polynomial_data(form: Form) -> dict[str, object] | None:
    """Return a polynomial V as the interior test takes it, with lists in place of arrays; None for an expression."""
    if not isinstance(form, PolynomialForm):
        return None
    return {name: array.tolist() for name, array in tabulate_polynomial(form)._asdict().items()}


def make_portable_system(potential: Potential, highest_energy: float, section: Section = Section.Y_UP) -> PortableSystem:
    """Return a potential as data, with exits for energies up to `highest_energy`, in units of the potential.

    Crossings are counted at the section.

    This takes up to a second for the first potential of a structure, or if exits are not cached. Raises a ValueError if another
    process compiles and cannot.
    """
    scaled_potential = potential.in_well_units
    definition, outline = scaled_potential.form.definition, find_outline(scaled_potential.well.structure)
    form = section.in_well_units(potential.units).numbers.form
    section_outline = None if form is None else find_outline(scaled_potential.well.structure_of(form))
    # Backward in time, the frame rotates in the opposite direction.
    rotation = scaled_potential.rotation
    table, backward_table = outline.tabulate(definition, rotation), outline.tabulate(definition, -rotation)
    exits = tabulate_exits(scaled_potential, highest_energy / potential.units.energy)
    return PortableSystem(potential, webassembly_module(outline, section_outline), table, backward_table, exits, section)
