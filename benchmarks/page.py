"""From the release of the energy slider to new pixels on the screen, in Chromium, over several energies.

Run: uv run python -m benchmarks.page
"""

from __future__ import annotations

import shutil
import statistics
import tempfile
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

from tests.browser.explorer_page import ExplorerPage
from tests.browser.served_app import served_app

SHARES = (0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.5, 0.4)
# Resolves at the second animation frame after the source has changed: by then the pixels are on the screen.
WATCH = """() => {
    const source = Bokeh.documents[0].get_model_by_name('maps')
    window.painted = {}
    const paint = () => requestAnimationFrame(() => requestAnimationFrame(() => {
        window.painted.first ??= performance.now()
        if (source.data.complete[0]) window.painted.whole ??= performance.now()
    }))
    source.connect(source.properties.data.change, paint)
    addEventListener('pointerup', () => { window.painted = {released: performance.now()} }, {capture: true})
}"""


def measure(explorer: ExplorerPage) -> list[tuple[float, float]]:
    """(first, whole) milliseconds after the release, for each place of the slider."""
    times = []
    explorer.page.evaluate(WATCH)
    for share in SHARES:
        explorer.drag_energy_to(share)
        explorer.page.wait_for_function("() => window.painted.whole !== undefined")
        painted = explorer.page.evaluate("() => window.painted")
        times.append((painted["first"] - painted["released"], painted["whole"] - painted["released"]))
        time.sleep(0.5)
    return times


def main() -> None:
    with (
        tempfile.TemporaryDirectory() as folder,
        served_app(Path(folder) / "log") as address,
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        print("| case | plane | first pixels, ms: median, worst | whole map to t = 1000, ms: median, worst |")
        print("|---|---|---|---|")
        for case in ("I", "III"):
            explorer = ExplorerPage(browser.new_page(viewport={"width": 1600, "height": 1200}))
            explorer.page.goto(address)
            explorer.wait_until_complete()
            explorer.choose("t_max", "1 000")
            explorer.press(case)
            time.sleep(3)
            explorer.wait_until_complete()
            stages = zip(*measure(explorer), strict=True)
            columns = [f"{statistics.median(times):.0f}, {max(times):.0f}" for times in stages]
            print(f"| {case} | (x, px) | {' | '.join(columns)} |")
            explorer.page.close()
        browser.close()


if __name__ == "__main__":
    main()
