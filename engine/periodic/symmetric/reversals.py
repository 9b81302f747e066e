"""Slices on which every start is its own image under a symmetry of the motion with reversed time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.maps.spec import MapSpec
from engine.periodic.symmetries import Symmetry, symmetries_of
from engine.slices.sections.linear_section import LinearSection
from engine.slices.slice import Slice
from engine.systems.potential import Potential

# Places on a slice at which starts are compared with their images, in units of the well; arbitrary, but on no body of a system.
_PLACES = np.array([[-0.71, -0.43], [-0.37, 0.61], [0.23, 0.31], [0.57, -0.19]])
# Largest distance between a start and its image, and from the section, in units of the well: rounding errors.
_ROUNDING = 1e-12


class Reversal(NamedTuple):
    """A symmetry with reversed time that leaves the starts of a slice unchanged.

    Attributes
    ----------
    symmetry
        The symmetry.
    coordinate
        (4,) coefficients of x, y, px and py of the coordinate on the section that is 0 where the symmetry changes nothing.
    """

    symmetry: Symmetry
    coordinate: np.ndarray


def find_reversal(spec: MapSpec) -> Reversal | None:
    """Return the symmetry with reversed time that leaves all starts of a slice along h unchanged; None if there is none.

    The starts must also be on the section of the request, which must be a linear form: on a ray, the other half of the line is
    missing, and at apsides, orbits through the centre could count as unchanged.
    """
    if spec.plane.energy_axis is None or spec.plane.parameter is not None or not isinstance(spec.section, LinearSection):
        return None
    starts, units = _some_starts(spec.plane, spec.potential), spec.potential.units
    if not _vanishes(spec.section.in_well_units(units).values(starts)):
        return None
    for symmetry in symmetries_of(spec.potential):
        if symmetry.reverses_time and _vanishes(starts * symmetry.factors - starts):
            components = spec.section.axes.components
            # The symmetry reverses the form, too, and no further combination of coordinates.
            (coordinate,) = components[np.all(components * symmetry.factors == -components, axis=1)]
            return Reversal(symmetry, coordinate)
    return None


def _some_starts(plane: Slice, potential: Potential) -> np.ndarray:
    """Return starts of a slice along h, (n, 4), in units of the well."""
    well_plane, places = plane.in_well_units(potential.units), _PLACES.copy()
    # On a slice along h, the lowest energy is relative to the energy of the place.
    places[:, plane.energy_axis] += well_plane.required_energy(potential.in_well_units, *places.T) + 1.0
    return well_plane.states(potential.in_well_units, None, *places.T)


def _vanishes(values: np.ndarray) -> bool:
    """Return whether values are 0 to within rounding; False if one is not a number."""
    return bool(np.all(np.abs(values) < _ROUNDING))
