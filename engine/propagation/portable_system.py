"""A potential as data for an integrator on another machine: code, coefficients and exits, all in units of the well."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.exits.exit_tables import ExitTable, tabulate_exits
from engine.exits.interior import find_inner_radius
from engine.integrator.jit.webassembly import constant_inputs, webassembly_module
from engine.integrator.source.recurrence import LANES, TOLERANCE, generate_code
from engine.integrator.source.series import ORDER, ROTATION
from engine.integrator.source.step_flags import GATE, HIDDEN, NEAR, OVERSHOOT
from engine.propagation.fates import Fate
from engine.systems.forms.expression_form import ExpressionForm
from engine.systems.forms.polynomial_form import PolynomialForm
from engine.systems.potential import Potential


@dataclass(frozen=True, eq=False)
class PortableSystem:
    """What integrates the orbits of a potential, in units of its well.

    Attributes
    ----------
    potential
        The potential, in its own units.
    module
        WebAssembly with the functions ``step`` and ``jets``, see `engine.integrator.jit.webassembly`.
    constants
        Names of the inputs of ``step`` that are the same for all lanes, in order.
    table
        (m,) the coefficients in the form that the functions take.
    rotation
        Index of 2Ω in the table, which has the other sign backward in time; None in a frame that does not rotate.
    exits
        The exits of each channel.
    """

    potential: Potential
    module: bytes
    constants: tuple[str, ...]
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
            "constants": list(self.constants),
            "layout": {
                "lanes": LANES,
                "order": ORDER,
                "hidden": HIDDEN,
                "gate": GATE,
                "near": NEAR,
                "overshoot": OVERSHOOT,
                "tolerance": TOLERANCE,
                "fates": {fate.name.lower(): int(fate) for fate in Fate},
            },
            "table": self.table.tolist(),
            "rotation": self.rotation,
            "formula": _formula_data(well.form, well),
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


@functools.singledispatch
def _formula_data(form: Any, well: Potential) -> dict[str, object]:
    """V as lists and numbers."""
    raise TypeError(form)


@_formula_data.register
def _terms(form: PolynomialForm, _well: Potential) -> dict[str, object]:
    return {"terms": [list(term) for term in form.terms]}


@_formula_data.register
def _graph(form: ExpressionForm, well: Potential) -> dict[str, object]:
    """The operations of V, V_x and V_y, with their numbers in place."""
    graph, numbers = form.slopes_graph
    nodes = [node._asdict() | {"numbers": [numbers[place] for place in node.numbers]} for node in graph.nodes]
    return {"graph": {"nodes": nodes, "results": list(graph.results), "innerRadius": find_inner_radius(well)}}


def make_portable_system(potential: Potential, highest: float) -> PortableSystem:
    """A potential as data, with exits for energies up to `highest`, in its own units.

    Takes up to a second the first time for each structure of a potential, and for exits that are not cached.
    """
    well = potential.in_well_units
    definition, setting = well.form.definition, well.well.setting
    code = generate_code(definition, **setting._asdict())
    table, rotation = code.tabulate(definition, well.rotation), code.entries.index(ROTATION) if setting.rotates else None
    exits = tabulate_exits(well, highest / potential.units.energy)
    return PortableSystem(potential, webassembly_module(code), constant_inputs(code, "step"), table, rotation, exits)
