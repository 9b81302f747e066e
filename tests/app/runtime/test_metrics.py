"""Log records are counted, gauges show the present state of the process, and the status page lists the metrics."""

from __future__ import annotations

import logging
from functools import partial

from app.runtime.health import StateCollector
from app.runtime.metrics import LogRecordCounter
from app.runtime.process_state import ProcessState
from app.runtime.settings import Settings
from app.server.endpoints import status_page


def test_log_records_are_counted_by_level_and_exception() -> None:
    metrics = ProcessState().metrics
    logger = logging.Logger("one")
    logger.addHandler(LogRecordCounter(metrics))
    logger.info("nothing")
    logger.warning("something")
    logger.error("worse", exc_info=ValueError("h"))
    read = metrics.registry.get_sample_value
    assert read("escape_explorer_log_records_total", {"level": "warning", "exception": ""}) == 1
    assert read("escape_explorer_log_records_total", {"level": "error", "exception": "ValueError"}) == 1
    assert read("escape_explorer_log_records_total", {"level": "info", "exception": ""}) is None


def test_status_page_has_one_row_per_metric_without_histogram_buckets() -> None:
    metrics = ProcessState().metrics
    metrics.first_frame.observe(0.2)
    page = status_page("A < B", metrics.registry)
    assert "<p>A &lt; B</p>" in page
    assert page.count("first frame") == 2
    assert page.count("Sessions created") == 1


def test_gauges_show_the_current_state() -> None:
    state = ProcessState(Settings(cache_bytes=1234))
    state.metrics.registry.register(StateCollector(state))
    read = state.metrics.registry.get_sample_value
    assert read("escape_explorer_cache_limit_bytes") == 1234
    assert read("escape_explorer_kernels_ready") == 0
    state.capacity.cores, state.capacity.loop_share = 0.5, 0.3
    assert read("escape_explorer_cores") == 0.5
    assert read("escape_explorer_capacity_taken") == 0.3
    assert read("escape_explorer_crowded") == 0
    state.kernels_ready.set()
    assert read("escape_explorer_kernels_ready") == read("escape_explorer_ready") == 1


def test_reviews_and_compilations_have_metrics() -> None:
    state = ProcessState(Settings())
    state.metrics.registry.register(StateCollector(state))
    assert state.limited(partial(divmod, 7, 2)) == (3, 1)
    read = partial(state.metrics.registry.get_sample_value, labels={"task": "review"})
    assert read("escape_explorer_limited_calls_total", labels={"task": "review", "how": "answered"}) == 1
    assert read("escape_explorer_limited_calls_total", labels={"task": "compilation", "how": "answered"}) == 0
    assert read("escape_explorer_limited_seconds_total") is not None
    assert (read("escape_explorer_limited_memory_bytes") or 0) > 0
    assert state.metrics.registry.get_sample_value("escape_explorer_reviews_waiting") == 0
    state.limited.close()
