"""A slice qualifies if its starts are on the section and a symmetry with reversed time leaves them unchanged."""

from __future__ import annotations

import pytest

from engine import (
    CASES,
    POTENTIALS,
    Coordinate,
    Direction,
    MapSpec,
    ParameterAxis,
    Plane,
    Potential,
    Slice,
    System,
    parse_formula,
)
from engine.periodic.symmetric.reversals import find_reversal

C = Coordinate
III, HH = CASES["III"], POTENTIALS["HH"]
Y_H = Slice(C.Y, C.H, C.PX)
ANGLE_H = Slice(C.THETA, C.H)


@pytest.mark.parametrize(
    ("potential", "plane", "section", "name"),
    [
        (III, Plane.X_H, "y = 0", "y → −y with reversed time"),
        (III, Slice(C.H, C.X, C.PY, -1), "y = 0", "y → −y with reversed time"),
        (III, Slice(C.X, C.H, fixed=((C.THETA, 1.5707963267948966),)), "y = 0", "y → −y with reversed time"),
        (III, Y_H, "x = 0", "x → −x with reversed time"),
        (HH, Y_H, "x = 0, px > 0", "x → −x with reversed time"),
        # Orbits that start at the origin in any direction.
        (III, ANGLE_H, "y = 0", "rotation by 180° with reversed time"),
        (III, Plane.X_H, "px = 0", "y → −y with reversed time"),
        (III, Plane.X_H, "y + 0.5 px = 0", "y → −y with reversed time"),
        (III, Slice(C.PX, C.H, C.PY), "x + y = 0", "rotation by 180° with reversed time"),
        (POTENTIALS["Copenhagen"], Plane.X_H, "y = 0", "y → −y with reversed time"),
        (POTENTIALS["Hill"], Y_H, "x = 0", "x → −x with reversed time"),
    ],
)
def test_slices_of_symmetric_starts_qualify(potential: Potential, plane: Slice, section: str, name: str) -> None:
    reversal = find_reversal(MapSpec(potential, plane, (0.1, 0.2), section=section))
    assert reversal is not None
    assert reversal.symmetry.name == name


@pytest.mark.parametrize(
    ("potential", "plane", "section"),
    [
        # The potential is not symmetric in y.
        (HH, Plane.X_H, "y = 0"),
        (parse_formula("½(x² + y²) + 0.1 x² y − 0.2 y³ + 0.01 x³"), Y_H, "x = 0"),
        # The starts are not on the section.
        (III, Plane.X_H, "x = 0"),
        (III, Y_H, "y = 0"),
        (III, Plane.X_H, "y = 0.1"),
        # The starts are not at right angles to the line.
        (III, Slice(C.X, C.H, C.PY, fixed=((C.PX, 0.1),)), "y = 0"),
        (III, Slice(C.X, C.H, fixed=((C.THETA, 1.0),)), "y = 0"),
        (III, Slice(Direction("u", x=1.0, px=0.1), C.H, C.PY), "y = 0"),
        # The orbit may be its own image on the other half of the line.
        (III, Plane.X_H, "angle = 0"),
        # An orbit through the centre is there at an apsis, and need not be its own image.
        (III, Plane.X_H, "apsis"),
        # A rotation by 180° does not reverse the rotation of the frame.
        (POTENTIALS["Hill"], ANGLE_H, "y = 0"),
    ],
)
def test_other_slices_along_h_do_not_qualify(potential: Potential, plane: Slice, section: str) -> None:
    assert find_reversal(MapSpec(potential, plane, (0.1, 0.2), section=section)) is None


@pytest.mark.parametrize("plane", [Plane.X_PX, Plane.X_Y, Slice(C.X, ParameterAxis("epsilon", 0.5, 2.0, System("III")))])
def test_slices_of_one_energy_do_not_qualify(plane: Slice) -> None:
    assert find_reversal(MapSpec(III, plane, 0.2)) is None
