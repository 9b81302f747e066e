"""Gauges show the present state of the process."""

from __future__ import annotations

from app.runtime.health import StateCollector
from app.runtime.process_state import ProcessState
from app.runtime.settings import Settings


def test_gauges_show_the_current_state() -> None:
    state = ProcessState(Settings(cache_bytes=1234))
    state.metrics.registry.register(StateCollector(state))
    read = state.metrics.registry.get_sample_value
    assert read("escape_explorer_cache_limit_bytes") == 1234
    assert read("escape_explorer_kernels_ready") == 0
    state.capacity.cores, state.capacity.loop = 0.5, 0.3
    assert read("escape_explorer_cores") == 0.5
    assert read("escape_explorer_capacity_taken") == 0.3
    assert read("escape_explorer_crowded") == 0
    state.kernels_ready.set()
    assert read("escape_explorer_kernels_ready") == read("escape_explorer_ready") == 1
