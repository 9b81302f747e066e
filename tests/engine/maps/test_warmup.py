"""Kernels are compiled ahead of time, in the order of need, without delaying maps."""

from __future__ import annotations

import threading

import pytest

from engine import Potential, System
from engine.integrator.bound_kernels import load_kernels
from engine.integrator.jit.compiled_operations import compiled_operations
from engine.integrator.source.series import Setting
from engine.maps.warmup import Compilations, is_ready_for_maps, prepare_for_evidence, prepare_for_maps
from tests.waiting import SECONDS

# A structure that no other test compiles.
OTHER = Potential("other", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 1.0), (0, 3, -1 / 3), (1, 2, 1e-3), (3, 1, 1e-3)))


def test_kernels_are_compiled_in_the_order_of_need() -> None:
    kernels = load_kernels(OTHER.terms, Setting(OTHER.channels))
    compiled = []
    for prepare in (prepare_for_maps, prepare_for_evidence):
        prepare(OTHER)
        compiled.append({name for name in ("step", "jets", "limited_step") if getattr(kernels, name).signatures})
    assert compiled == [{"step", "jets"}, {"step", "jets", "limited_step"}]


@pytest.mark.parametrize("case", ["II", "Copenhagen", "Barred galaxy"])
def test_systems_are_ready_when_they_are_prepared_also_in_rotating_frames_and_with_bodies(case: str) -> None:
    prepare_for_maps(System(case).potential)
    assert is_ready_for_maps(System(case).potential)


def test_maps_go_before_background_compilation() -> None:
    compilations, order = Compilations(), []

    def background() -> None:
        compilations.wait()
        order.append("background")

    thread = threading.Thread(target=background)

    def compile_for_maps() -> None:
        thread.start()
        order.append("maps")

    compilations.run(compile_for_maps)
    thread.join(SECONDS)
    assert order == ["maps", "background"]


def test_the_question_whether_a_potential_is_ready_generates_no_code() -> None:
    potential = Potential("asked", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 1.0), (0, 3, -1 / 3), (4, 3, 1e-3)))
    assert not is_ready_for_maps(potential)
    assert compiled_operations.used == 0


def test_a_potential_beyond_the_limit_of_compiled_code_is_not_ready() -> None:
    compiled_operations.limit = 0
    same_powers = Potential("refused", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 1.0), (0, 3, 0.7)))
    assert not is_ready_for_maps(same_powers)
