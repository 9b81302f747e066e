"""Measure the first start of the server on a machine: nothing is compiled, neither kernels nor the bytecode of Python.

Each system has a fresh server, whose page Chromium opens as soon as the server listens. Times of pictures last from the first
byte of the page to the second animation frame after the pixels. Run: uv run python -m benchmarks.first_start I C8 Hill
"""

from __future__ import annotations

import argparse
import tempfile
import time
import urllib.parse
from collections.abc import Sequence
from dataclasses import astuple, dataclass
from pathlib import Path

import psutil
from playwright.sync_api import Browser, sync_playwright

from benchmarks.page import ALL_PIXELS, CHROMIUM, FIRST_PIXELS, TWO_FRAMES
from engine.foundations.cache_files import CACHE_VARIABLE
from engine.systems.catalogue.table import CATALOGUE
from tests.browser.served_app import PANEL, READY, started_app

LONGEST_MS = 300_000
# Milliseconds since the first byte of the page.
ELAPSED = "() => performance.now() - performance.getEntriesByType('navigation')[0].responseStart"


@dataclass(frozen=True)
class FirstStart:
    """Seconds of a first start.

    Attributes
    ----------
    listening
        From the command until the server listens.
    answer
        From the request of the page to its first byte.
    picture, whole
        From the first byte of the page to the first picture, and to the complete map of the server.
    ready
        From the command until all kernels are compiled.
    processor
        Processor time of the server and its processes until then.
    """

    listening: float
    answer: float
    picture: float
    whole: float
    ready: float
    processor: float


def start_once(browser: Browser, system: str) -> FirstStart:
    """Start a server with empty caches, and open the page of a system."""
    with tempfile.TemporaryDirectory() as folder:
        begin = time.perf_counter()
        variables = {CACHE_VARIABLE: f"{folder}/kernels", "PYTHONPYCACHEPREFIX": f"{folder}/bytecode"}
        with started_app(Path(folder) / "log", *PANEL, variables=variables) as running:
            listening = time.perf_counter() - begin
            page = browser.new_page(viewport={"width": 1600, "height": 1000})
            page.goto(f"{running.address}?{urllib.parse.urlencode({'case': system})}", timeout=LONGEST_MS)
            answer = page.evaluate("() => performance.getEntriesByType('navigation')[0].responseStart")
            times = []
            for condition in (FIRST_PIXELS, ALL_PIXELS):
                page.wait_for_function(condition, polling=20, timeout=LONGEST_MS)
                page.evaluate(TWO_FRAMES)
                times.append(page.evaluate(ELAPSED))
            running.output.wait_for(READY)
            ready = time.perf_counter() - begin
            page.close()
            processor = _processor_seconds(running.process.pid)
    return FirstStart(listening, *(each / 1000.0 for each in (answer, *times)), ready, processor)


def _processor_seconds(process_id: int) -> float:
    """Return the processor time of a process and its children, running or ended."""
    process = psutil.Process(process_id)
    times = [each.cpu_times() for each in (process, *process.children(recursive=True))]
    return sum(each.user + each.system for each in times) + times[0].children_user + times[0].children_system


def report(browser: Browser, systems: Sequence[str]) -> None:
    """Print the times of each system."""
    print("| system | server listens, s | answer, s | first picture, s | exact map, s | all kernels, s | processor time, s |")
    print("|---|---|---|---|---|---|---|")
    for system in systems:
        times = " | ".join(f"{seconds:.1f}" for seconds in astuple(start_once(browser, system)))
        print(f"| {system} | {times} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("systems", choices=CATALOGUE, nargs="*", default=list(CATALOGUE), help="systems to open")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        report(browser, parser.parse_args().systems)
        browser.close()


if __name__ == "__main__":
    main()
