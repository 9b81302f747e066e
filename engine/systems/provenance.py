"""How a result was made, in plain values: the potential, what was asked for, the integrator and the version."""

from __future__ import annotations

import json
from dataclasses import asdict
from importlib import metadata
from typing import TYPE_CHECKING, Any

from engine.integrator.source.recurrence import TOLERANCE
from engine.integrator.source.series import ORDER

if TYPE_CHECKING:
    from engine.systems.potential import Potential


def describe_potential(potential: Potential) -> dict[str, Any]:
    """Return name, formula with all digits, rotation, centres, escape radius (0 for none) and origin of the axes."""
    return {
        "potential": potential.name,
        "terms": potential.form.text,
        "rotation": potential.rotation,
        "centres": json.dumps([asdict(centre) for centre in potential.centres]),
        "escape_radius": potential.escape_radius or 0.0,
        "origin": json.dumps(potential.origin),
    }


def describe_run(potential: Potential, **request: Any) -> dict[str, Any]:
    """How a computation with a potential was made: the potential, what was asked for, the integrator and the version."""
    return {
        **describe_potential(potential),
        **request,
        "integrator": f"Taylor series of order {ORDER}, tolerance {TOLERANCE:g}",
        "version": metadata.version("escape-explorer"),
    }
