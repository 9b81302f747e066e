"""Slices are read as they were written."""

from __future__ import annotations

import pytest
from hypothesis import given

from engine import Coordinate, Direction, ParameterAxis, Plane, Slice, System
from engine.slices.planes import checked_slice
from engine.slices.slice_text import read_slice, write_slice
from tests.engine.slices.test_slice import slices

C = Coordinate
TYPED = System("typed", "0.5(x^2 + y^2) - a x y^2 - b x^3", {"b": 0.2})
LETTER = ParameterAxis("b", 0.1, 0.3, TYPED)


@given(slices())
def test_a_slice_is_read_as_it_was_written(plane: Slice) -> None:
    # If a named slice has the same axes, the text is read as the named slice.
    assert read_slice(*write_slice(plane), System("I")) == checked_slice(plane)


@pytest.mark.parametrize("plane", [Slice(C.X, LETTER), Slice(LETTER, C.H, fixed=((C.PX, 0.125),))])
def test_a_slice_along_a_letter_is_read_as_it_was_written(plane: Slice) -> None:
    assert read_slice(*write_slice(plane), TYPED) == plane


@pytest.mark.parametrize("plane", Plane)
def test_a_named_slice_is_written_as_its_name(plane: Plane) -> None:
    assert write_slice(plane) == (plane.key, "")
    assert read_slice(plane.key, "", System("I")) is plane


@pytest.mark.parametrize(
    ("axes", "held", "plane"),
    [
        ("y,py", "x=0", Plane.Y_PY),
        ("x,θ", "", Slice(C.X, C.THETA)),
        ("x,px", "py=-", Slice(C.X, C.PX, C.PY, -1)),
        ("x,eps=0.5:2", "px=0", Slice(C.X, ParameterAxis("epsilon", 0.5, 2.0, System("I")))),
        ("u=1:0.5:0:0,px", "", Slice(Direction("u", 1.0, 0.5), C.PX)),
    ],
)
def test_axes_and_held_coordinates_are_read(axes: str, held: str, plane: Slice) -> None:
    assert read_slice(axes, held, System("I")) == plane
