"""A potential as data for an integrator on another machine: code, coefficients and exits, all in units of the well."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.dynamics.fates import Fate
from engine.exits.exit_tables import ExitTable, tabulate_exits
from engine.potentials.forms.expression_form import ExpressionForm
from engine.potentials.forms.polynomial_form import PolynomialForm
from engine.potentials.potential import Potential
from engine.taylor.jit.webassembly import constant_inputs, webassembly_module
from engine.taylor.source.recurrence import GATE, HIDDEN, LANES, OVERSHOOT, TOLERANCE, generate_code
from engine.taylor.source.series import ORDER


@dataclass(frozen=True, eq=False)
class PortableSystem:
    """What integrates the orbits of a potential, in units of its well.

    Attributes
    ----------
    potential
        The potential, in its own units.
    module
        WebAssembly with the functions ``step`` and ``jets``, see `engine.taylor.jit.webassembly`.
    constants
        Names of the inputs of ``step`` that are the same for all lanes, in order.
    table
        (m,) the coefficients in the form that the functions take.
    exits
        The exits of each channel.
    """

    potential: Potential
    module: bytes
    constants: tuple[str, ...]
    table: np.ndarray
    exits: tuple[ExitTable, ...]

    @property
    def nbytes(self) -> int:
        """Approximate size in bytes."""
        return len(self.module) + self.table.nbytes + sum(exits.rows.nbytes for exits in self.exits) + 2048

    def to_dict(self) -> dict[str, object]:
        """All of it but the module as lists and numbers."""
        well, units = self.potential.in_well_units, self.potential.units
        mirror = self.potential.mirror_channels.tolist() if self.potential.mirror_in_x else None
        exits = [
            {"saddle": each.saddle, "highest": each.highest, "nodes": each.nodes.tolist(), "rows": each.rows.tolist()}
            for each in self.exits
        ]
        return {
            "constants": list(self.constants),
            "layout": {
                "lanes": LANES,
                "order": ORDER,
                "hidden": HIDDEN,
                "gate": GATE,
                "overshoot": OVERSHOOT,
                "tolerance": TOLERANCE,
                "fates": {fate.name.lower(): int(fate) for fate in Fate},
            },
            "table": self.table.tolist(),
            "formula": _formula_data(well.form),
            "exits": exits,
            "mirror": mirror,
            "units": {"length": units.length, "time": units.time},
        }


@functools.singledispatch
def _formula_data(form: Any) -> dict[str, object]:
    """V as lists and numbers."""
    raise TypeError(form)


@_formula_data.register
def _terms(form: PolynomialForm) -> dict[str, object]:
    return {"terms": [list(term) for term in form.terms]}


@_formula_data.register
def _graph(form: ExpressionForm) -> dict[str, object]:
    """The operations of V, V_x and V_y, with their numbers in place."""
    graph, numbers = form.slopes_graph
    nodes = [node._asdict() | {"numbers": [numbers[place] for place in node.numbers]} for node in graph.nodes]
    return {"graph": {"nodes": nodes, "results": list(graph.results)}}


def make_portable_system(potential: Potential, highest: float) -> PortableSystem:
    """A potential as data, with exits for energies up to `highest`, in its own units.

    Takes up to a second the first time for each structure of a potential, and for exits that are not cached.
    """
    well = potential.in_well_units
    definition = well.form.definition
    code = generate_code(definition, well.channels)
    exits = tabulate_exits(well, highest / potential.units.energy)
    return PortableSystem(potential, webassembly_module(code), constant_inputs(code, "step"), code.tabulate(definition), exits)
