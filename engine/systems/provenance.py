"""The provenance of a result in plain values: the potential, the request, the integrator and the version."""

from __future__ import annotations

import json
from importlib import metadata
from typing import TYPE_CHECKING, Any

from engine.integrator.source.recurrence import TOLERANCE
from engine.integrator.source.series import ORDER
from engine.systems.outcomes import end_kinds

if TYPE_CHECKING:
    from engine.systems.potential import Potential


def describe_potential(potential: Potential) -> dict[str, Any]:
    """Return attributes of a potential: name, formula with all digits, rotation, mass, ends by kind, origin, and exit names."""
    return {
        "potential": potential.name,
        "terms": potential.form.text,
        "rotation": potential.rotation,
        "mass": potential.mass,
        **{kind.attribute: kind.write([end for end in potential.ends if isinstance(end, kind)]) for kind in end_kinds()},
        "origin": json.dumps(potential.origin),
        **({"exit_names": json.dumps(potential.exit_names)} if potential.exit_names else {}),
    }


def describe_run(potential: Potential, **request: Any) -> dict[str, Any]:
    """Return the provenance of a computation with a potential: the potential, the request, the integrator and the version."""
    energy = request.get("energy")
    constant = {"jacobi_constant": potential.jacobi_constant(energy)} if potential.rotation and isinstance(energy, float) else {}
    return {
        **describe_potential(potential),
        **request,
        **constant,
        "integrator": f"Taylor series of order {ORDER}, tolerance {TOLERANCE:g}",
        "version": metadata.version("escape-explorer"),
    }
