"""Measure the engine in the browser: frames per second and delays of drags, times of single orbits, memory of the page.

Run alone on the machine: uv run python -m benchmarks.drag --memory 10
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, CDPSession, sync_playwright

from benchmarks.page import CHROMIUM, open_page
from tests.browser.explorer_page import ExplorerPage
from tests.browser.served_app import served_app

# Case and energy of each view.
VIEWS = (("I", 0.19), ("III", 0.45), ("III", 0.30))
# Half the range of a drag, in units of the energy.
SPAN = 0.06
DRAG_SECONDS = 4.0
# Number of orbits under the cursor.
HOVERS = 60
# Numbers of orbits in the tab "Watch".
ENSEMBLES = (1000, 5000, 20000)
# Number of times that orbits of each number are started.
REPEATS = 10
# Number of measurements of the memory after the first.
MEMORY_SAMPLES = 5
SCRIPT = Path(__file__).with_name("drag.js")


def ready_page(browser: Browser, address: str, case: str, energy: float, more: str = "") -> ExplorerPage:
    """Return a page whose engine in the browser is ready for the system of a view."""
    explorer = open_page(browser, address, f"?case={case}&h={energy}&t_max=1000{more}")
    explorer.page.evaluate(f"async () => {{ {SCRIPT.read_text()}; window.bench = bench }}")
    explorer.page.evaluate("() => window.bench.ready()")
    return explorer


def drag(explorer: ExplorerPage, energy: float, seconds: float) -> dict[str, Any]:
    """Drag the slider around an energy, and return what `SCRIPT` measured."""
    rail = explorer.page.get_by_role("slider", name="Energy h", exact=True)
    found: dict[str, Any] = rail.evaluate(
        "(rail, options) => window.bench.drag(rail, ...options)", [energy - SPAN, energy + SPAN, seconds]
    )
    return found


def report_drags(browser: Browser, address: str) -> None:
    """Print frames per second, and the time from a move of the slider to its pixels."""
    print(
        "| view | pictures per second | frames per second | ms from move to pixels: median, 95 %, worst |"
        " side in pixels: least, median | messages |"
    )
    print("|---|---|---|---|---|---|")
    for case, energy in VIEWS:
        explorer = ready_page(browser, address, case, energy)
        drag(explorer, energy, 2.0)
        found = drag(explorer, energy, DRAG_SECONDS)
        delays, sides = sorted(found["delays"]), found["sides"]
        print(
            f"| {case}, h = {energy} | {len(sides) / DRAG_SECONDS:.0f} | {found['frames'] / DRAG_SECONDS:.0f} |"
            f" {statistics.median(delays):.0f},"
            f" {delays[int(0.95 * len(delays))]:.0f}, {delays[-1]:.0f} | {min(sides)}, {statistics.median(sides):.0f} |"
            f" {found['sent']} |",
            flush=True,
        )
        explorer.page.context.close()


def report_hover(browser: Browser, address: str) -> None:
    """Print the time in which the thread of the page computes and draws the orbit under the cursor."""
    explorer = ready_page(browser, address, "III", 0.45)
    points = [explorer.point("basins", 0.5 * (2 * k / HOVERS - 1), 0.2) for k in range(HOVERS)]
    times = explorer.page.evaluate("points => window.bench.hover(points)", points)
    print(f"\nOrbit under the cursor, III: {statistics.median(times):.1f} ms, at most {max(times):.1f} ms")
    explorer.page.context.close()


def report_watch(browser: Browser, address: str) -> None:
    """Print the time to the first picture of new orbits, and frames per second while the orbits leave."""
    print("\n| orbits | ms to the first picture: median, worst | frames per second | ms of a frame: median, worst |")
    print("|---|---|---|---|")
    for count in ENSEMBLES:
        explorer = ready_page(browser, address, "III", 0.45, f"&analysis=watch&watch=well,{count},1,-2")
        found = explorer.page.evaluate("options => window.bench.watch(...options)", [REPEATS, DRAG_SECONDS])
        starts, frames = found["starts"], found["frames"]
        print(
            f"| {count} | {statistics.median(starts):.0f}, {max(starts):.0f} | {len(frames) / DRAG_SECONDS:.0f} |"
            f" {statistics.median(frames):.0f}, {max(frames):.0f} |",
            flush=True,
        )
        explorer.page.context.close()


def report_memory(browser: Browser, address: str, minutes: float) -> None:
    """Print the memory of the page's scripts after minutes of dragging."""
    explorer = ready_page(browser, address, "III", 0.45)
    session = explorer.page.context.new_cdp_session(explorer.page)
    sizes = [heap_megabytes(session)]
    for _ in range(MEMORY_SAMPLES):
        drag(explorer, 0.45, 60.0 * minutes / MEMORY_SAMPLES)
        sizes.append(heap_megabytes(session))
    print(f"\nMemory of scripts, dragging for {minutes:g} minutes, MB: {', '.join(f'{size:.1f}' for size in sizes)}")
    explorer.page.context.close()


def heap_megabytes(session: CDPSession) -> float:
    """Return the memory that scripts use after a garbage collection, in MB."""
    session.send("HeapProfiler.collectGarbage")
    usage = session.send("Runtime.getHeapUsage")
    return float(usage["usedSize"] + usage.get("backingStorageSize", 0)) / 1e6


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--memory", type=float, default=0.0, metavar="MINUTES", help="drag for as long, and measure the memory")
    minutes = parser.parse_args().memory
    with tempfile.TemporaryDirectory() as folder, served_app(Path(folder) / "log") as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        report_drags(browser, address)
        report_hover(browser, address)
        report_watch(browser, address)
        if minutes:
            report_memory(browser, address, minutes)
        browser.close()


if __name__ == "__main__":
    main()
