"""Configure all tests: fixed inputs of Hypothesis, and one Chromium for all browser tests of a process.

``--hypothesis-profile=random`` makes inputs random, and four times as many.
"""

from __future__ import annotations

import gc
import importlib
import os
import shutil
import sys
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import settings
from playwright.sync_api import Browser, Playwright, expect, sync_playwright
from xdist.scheduler import LoadScopeScheduling

from engine.integrator.jit.compiled_operations import compiled_operations

# All processes of a run import the same modules. Without bytecode files, each process would compile the modules, which takes 9 s.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# If processes imported the same libraries at the same time, each would compile all of them. So each begins with different ones.
FIRST = {"gw1": ("sympy", "matplotlib.pyplot", "scipy.stats"), "gw2": ("zarr", "distributed", "xarray")}
for library in FIRST.get(os.environ.get("PYTEST_XDIST_WORKER", ""), ()):
    importlib.import_module(library)

# Servers under test refuse no page, however busy the machine.
os.environ.setdefault("ESCAPE_EXPLORER_CORES_PER_PAGE", "0.001")

TIMEOUT_MS = 120_000
"""Limit for a step in a browser: much longer than any step takes, even on a busy machine."""
BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")

settings.register_profile("fixed", derandomize=True, deadline=None, max_examples=15, database=None)
settings.register_profile("random", derandomize=False, deadline=None, max_examples=60, database=None, print_blob=True)
settings.load_profile("fixed")


OF_RESULTS = (
    "tests/engine/foundations/test_result.py",
    "tests/engine/sweeps/test_opened_results.py",
    "tests/plots/printed/test_results.py",
)


class SharedProcesses(LoadScopeScheduling):
    """Runs the tests of a file in one process.

    Tests in Chromium share a process, because they share a server, and so do tests of the results that `tests.results` computes.
    """

    def _split_scope(self, nodeid: str) -> str:
        file = nodeid.partition("::")[0]
        return "tests/browser" if file.startswith("tests/browser/") else "results" if file in OF_RESULTS else file


def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> SharedProcesses:
    """Schedule by `SharedProcesses`."""
    return SharedProcesses(config, log)


def pytest_collection_finish() -> None:
    """Exclude imported modules from garbage collections, because they stay until the end."""
    gc.freeze()


@pytest.fixture(autouse=True)
def _unlimited_compiled_code() -> Iterator[None]:
    """After each test, remove the limit of compiled code that a server state has set, and stop counting the code of the test."""
    yield
    compiled_operations.limit = None
    compiled_operations.reserve(compiled_operations.codes)


@pytest.fixture(scope="session")
def chromium_path() -> str:
    """The program of Chromium. Without Chromium, skip browser tests, or fail in CI."""
    path = next(filter(None, map(shutil.which, BROWSERS)), None)
    if path is None:
        message = f"no browser: none of {', '.join(BROWSERS)} is on PATH (Debian: apt-get install chromium-headless-shell)"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)
    return path


@pytest.fixture(scope="session")
def chromium(chromium_path: str) -> Iterator[Browser]:
    """Yield a running Chromium."""
    playwright: Playwright
    expect.set_options(timeout=TIMEOUT_MS)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium_path, args=["--no-sandbox"])
        yield browser
        browser.close()
