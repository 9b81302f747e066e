"""Options for the start of an orbit: a point of a plane at an energy, or a whole state."""

from __future__ import annotations

from typing import Annotated

import numpy as np
import typer

from cli.option_marks import DocumentedBy
from engine import Potential, Slice
from engine.foundations.validation import checked_number

State = tuple[float, float, float, float]
"""x, y, px, py."""


def find_state(
    potential: Potential, plane: Slice, energy: float | None, start: tuple[float, float] | None, state: State | None
) -> State:
    """Return x, y, px, py of a start, given as a state or as a point of a plane; ValueError for a forbidden start.

    Parameters
    ----------
    potential
        The potential.
    plane
        The plane of `start`.
    energy
        The energy of `start`; None if it is not given.
    start
        Start on the plane, at --energy.
    state
        Full initial state, instead of --start and --energy.
    """
    if start is not None and state is not None:
        raise ValueError("start: give either --start X ORDINATE on a plane, or --state X Y PX PY")
    if state is not None:
        if energy is not None:
            raise ValueError("energy: --state already determines it; leave --energy out")
        return state
    assert start is not None
    plane.check_one_potential("start")
    if plane.energy_axis is not None and energy is not None:
        raise ValueError(f"energy: on the plane {plane.key} it is a coordinate, so leave --energy out")
    if plane.energy_axis is None and energy is None:
        raise ValueError(f"energy: a start on the plane {plane.key} needs --energy H")
    x, ordinate = np.array([checked_number("start", number) for number in start])[:, None]
    found_state = plane.states(potential, energy, x, ordinate)[0]
    if np.isnan(found_state).any():
        raise ValueError(f"start={start}: forbidden, an orbit there would have negative kinetic energy")
    # mypy does not know the length of a list.
    x_start, y_start, px_start, py_start = found_state.tolist()
    return x_start, y_start, px_start, py_start


Start = Annotated[tuple[float, float] | None, typer.Option(metavar="X ORDINATE"), DocumentedBy(find_state)]
"""Type of the option for a point of a plane."""

GivenState = Annotated[State | None, typer.Option("--state", metavar="X Y PX PY"), DocumentedBy(find_state, "state")]
"""Type of the option for a state."""
