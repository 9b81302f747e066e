"""A system with two exits and a collision: case I with a disc in its well."""

from __future__ import annotations

from engine import EscapeMap, MapSpec, Plane, compute_map, parse_formula
from engine.systems.outcomes import Centre

DISC = parse_formula("½(x² + y²) − xy²").with_outcomes([Centre(0.2, 0.3, 0.05, "a disc")])
LABELS = ["exit 1", "exit 2", "collision with a disc"]


def disc_map() -> EscapeMap:
    """Return a map on which all three outcomes occur."""
    return compute_map(MapSpec(DISC, Plane.X_PX, 0.19, (40, 40), t_max=300.0))
