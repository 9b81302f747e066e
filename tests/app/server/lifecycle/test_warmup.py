"""Kernels are compiled in the background, beginning with those of the opened page."""

from __future__ import annotations

from app.runtime.process_state import ProcessState
from app.server.lifecycle.warmup import STEPS, prepare_for_layers, start_warmup
from app.state.view_state import ViewState
from engine import Potential
from engine.integrator.bound_kernels import load_kernels
from engine.integrator.source.series import Setting
from tests.waiting import SECONDS


def fail() -> None:
    raise OSError("no room on the disk")


def test_kernels_are_ready_after_the_last_step() -> None:
    state, seen = ProcessState(), []
    start_warmup(state, {"one": lambda: seen.append(state.kernels_ready.is_set())}).join(SECONDS)
    assert seen == [False]
    assert state.kernels_ready.is_set()


def test_failed_step_ends_the_warmup() -> None:
    state, seen = ProcessState(), []
    start_warmup(state, {"one": fail, "two": lambda: seen.append(2)}).join(SECONDS)
    assert state.kernels_failed.is_set()
    assert not state.kernels_ready.is_set()
    assert seen == []


def test_shutdown_ends_the_warmup_before_the_next_step() -> None:
    state, seen = ProcessState(), []
    start_warmup(state, {"one": state.stopping.set, "two": lambda: seen.append(2)}).join(SECONDS)
    assert seen == []


def test_the_map_of_the_opened_page_comes_first() -> None:
    first, *_ = STEPS
    assert first == f"the kernels of case {ViewState().system.case} for maps"


def test_layers_are_compiled_for_bounded_and_for_escaping_orbits() -> None:
    # A structure that no other test compiles.
    other = Potential("other", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 1.0), (0, 3, -1 / 3), (1, 2, 1e-3), (2, 3, 1e-3)))
    kernels = load_kernels(other.terms, Setting(other.channels))
    prepare_for_layers(other)
    # Deviation vectors are computed for bounded orbits, and series for orbits that escape.
    assert kernels.tangent.signatures
    assert kernels.jets.signatures
