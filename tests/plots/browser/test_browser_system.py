"""A system for the browser has an individual key, and windows close to the default windows."""

from __future__ import annotations

import threading

import numpy as np

from engine import CASES, Plane, Potential, System
from engine.foundations.execution import Execution
from engine.slices.default_window import default_window
from engine.slices.portable_system import make_portable_system
from engine.systems.outcomes import Centre
from plots.browser.browser_system import make_browser_system, system_key


def test_windows_between_tabulated_energies_are_nearly_default_windows() -> None:
    system = make_browser_system(CASES["III"], 0.21, 1.0, execution=Execution(cancel=threading.Event()))
    table = system.to_dict()["windows"][Plane.X_PX.key]
    for energy in (0.3, 0.45, 0.8):
        window = default_window(CASES["III"], Plane.X_PX, energy)
        edge = np.interp(energy, table["energies"], [edges[1] for edges in table["windows"]])
        assert abs(edge - window.x_high) < 0.01


def test_each_potential_has_an_individual_key() -> None:
    systems = (System("I"), System("II"), System("I", parameters={"epsilon": 1.1}), System("typed", "x²+y²-x²y²"))
    assert len({system_key(system.potential) for system in systems}) == len(systems)


def test_frames_centres_and_escape_radii_change_the_key_and_names_of_potentials_do_not() -> None:
    well = CASES["I"]
    potentials = [
        well,
        # The same function in frames that rotate at different rates, and in opposite directions.
        *(Potential("", well.terms, rotation=rotation) for rotation in (0.3, -0.3, 0.4)),
        *(well.with_outcomes(centres, radius) for centres in ((), (Centre(0.1, 0.0, 0.01),)) for radius in (2.0, 3.0)),
        well.with_outcomes([Centre(0.1, 0.0, 0.02)], 2.0),
    ]
    assert len(set(map(system_key, potentials))) == len(potentials)
    assert system_key(Potential("another", well.terms)) == system_key(well)


def test_windows_of_a_system_with_an_escape_radius_are_tabulated_up_to_the_highest_energy() -> None:
    potential = CASES["I"].with_outcomes((), 3.0)
    table = make_browser_system(potential, -0.5, 0.3, execution=Execution()).to_dict()["windows"][Plane.X_PX.key]
    energies, windows = table["energies"], table["windows"]
    assert len(energies) == len(windows) > 5
    assert energies[-1] == 0.3
    window = default_window(potential, Plane.X_PX, 0.3)
    assert windows[-1] == [window.x_low, window.x_high, window.ordinate_low, window.ordinate_high]


def test_an_outcome_of_a_rotating_system_has_its_exit_and_no_mirror_image() -> None:
    potential = CASES["III"].in_rotating_frame(0.1).with_outcomes([Centre(0.0, 0.0, 0.01)], 3.0)
    data = make_portable_system(potential, 0.3).to_dict()
    assert [each["side"] for each in data["exits"]] == [-1, 1]
    assert data["mirror"] is None
    assert CASES["III"].well.mirror_in_x
