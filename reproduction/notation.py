"""Names of planes and axes as in the paper, in Matplotlib's math notation."""

from __future__ import annotations

from engine import Plane

ORDINATES = {Plane.X_Y: "$y$", Plane.X_PX: r"$\dot{x}$", Plane.X_H: "$h$"}
"""Name of the upright axis of each plane."""

PLANES = {Plane.X_Y: "$(x, y)$", Plane.X_PX: r"$(x, \dot{x})$", Plane.X_H: "$(x, h)$"}
"""Name of each plane."""
