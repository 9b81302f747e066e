"""Log records are counted, and the status page lists the metrics."""

from __future__ import annotations

import logging

from app.runtime.metrics import LogRecordCounter
from app.runtime.process_state import ProcessState
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
