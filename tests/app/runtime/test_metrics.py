"""What the server counts."""

from __future__ import annotations

import logging

from prometheus_client import REGISTRY

from app.runtime.metrics import FaultCounter, Figures
from app.runtime.process_state import ProcessState
from app.runtime.settings import Settings
from app.server.endpoints import status_page
from engine import Jobs


def test_a_site_reads_its_jobs_and_sessions_when_asked() -> None:
    site = ProcessState(Settings(), sessions=list, jobs=Jobs(cache_bytes=1234))
    read = Figures(site).registry.get_sample_value
    assert read("escape_explorer_cache_limit_bytes") == 1234
    assert read("escape_explorer_kernels_ready") == 0
    site.prepared.set()
    assert read("escape_explorer_kernels_ready") == read("escape_explorer_ready") == 1


def test_warnings_and_errors_are_counted_by_kind() -> None:
    figures = Figures(ProcessState(Settings()))
    logger = logging.Logger("one")
    logger.addHandler(FaultCounter(figures))
    logger.info("nothing")
    logger.warning("something")
    logger.error("worse", exc_info=ValueError("h"))
    read = figures.registry.get_sample_value
    assert read("escape_explorer_log_records_total", {"level": "warning", "exception": ""}) == 1
    assert read("escape_explorer_log_records_total", {"level": "error", "exception": "ValueError"}) == 1
    assert read("escape_explorer_log_records_total", {"level": "info", "exception": ""}) is None


def test_nothing_is_put_into_the_registry_of_the_process() -> None:
    Figures(ProcessState(Settings()))
    assert not [family.name for family in REGISTRY.collect() if family.name.startswith("escape_explorer")]


def test_the_table_has_a_row_for_each_figure_but_not_for_each_step_of_a_histogram() -> None:
    figures = Figures(ProcessState(Settings()))
    figures.first_frame.observe(0.2)
    page = status_page("A < B", figures.registry)
    assert "<p>A &lt; B</p>" in page
    assert page.count("first picture") == 2
    assert page.count("Sessions that began") == 1
