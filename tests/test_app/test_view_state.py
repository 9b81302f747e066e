"""The view state turns choices into requests."""

from __future__ import annotations

import numpy as np
import pytest

from app.paper_energies import ENERGIES
from app.view_state import ViewState
from engine import CASES, Plane


def test_the_request_is_what_was_chosen() -> None:
    spec = ViewState(case="III", plane=Plane.X_Y, energy=0.45, t_max=1e3, resolution=113).map_spec()
    assert (spec.potential, spec.plane, spec.energy, spec.resolution, spec.t_max) == (
        CASES["III"],
        Plane.X_Y,
        0.45,
        (113, 113),
        1e3,
    )


@pytest.mark.parametrize("case", list(CASES))
def test_the_energy_plane_spans_from_the_escape_energy_to_the_end_of_the_slider(case: str) -> None:
    spec = ViewState(case=case, plane=Plane.X_H).map_spec()
    assert spec.energy == (CASES[case].escape_energy, ENERGIES[case].high)


def test_a_start_gets_its_py_from_the_energy() -> None:
    state = ViewState(case="I", plane=Plane.X_PX, energy=0.2, start=(0.1, 0.05)).start_state()
    assert state[:3] == (0.1, 0.0, 0.05)
    assert CASES["I"].energy(np.array(state)) == pytest.approx(0.2, abs=1e-15)


def test_on_the_energy_plane_the_ordinate_is_the_energy() -> None:
    view = ViewState(case="II", plane=Plane.X_H, start=(0.1, 0.3))
    assert CASES["II"].energy(np.array(view.start_state())) == pytest.approx(0.3, abs=1e-15)


def test_a_forbidden_start_has_no_py() -> None:
    assert np.isnan(ViewState(case="I", plane=Plane.X_PX, energy=0.2, start=(0.0, 2.0)).start_state()[3])


@pytest.mark.parametrize("case", list(CASES))
def test_the_slider_spans_the_escape_energy_and_every_energy_of_the_paper(case: str) -> None:
    energies = ENERGIES[case]
    assert energies.low < CASES[case].escape_energy < min(energies.marked)
    assert len(energies.marked) == 9
    assert max(energies.marked) <= energies.high
    assert energies.low < energies.first < energies.high
