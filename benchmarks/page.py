"""From the release of the energy slider to new pixels on the screen, in Chromium, over several energies.

Run: uv run python -m benchmarks.page
"""

from __future__ import annotations

import shutil
import socket
import statistics
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

from playwright.sync_api import sync_playwright

from tests.browser.explorer_page import ExplorerPage

ROOT = Path(__file__).parents[1]
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


def serve() -> tuple[subprocess.Popen[bytes], str]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [sys.executable, "-m", "panel", "serve", "app", "--address", "127.0.0.1", "--port", str(port)]
    command += ["--allow-websocket-origin", f"127.0.0.1:{port}"]
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    address = f"http://127.0.0.1:{port}/app"
    for _ in range(600):
        try:
            urllib.request.urlopen(address, timeout=60).close()
            return process, address
        except OSError:
            time.sleep(0.3)
    process.terminate()
    raise SystemExit("the server did not start")


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
    process, address = serve()
    try:
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
            print(
                "| case | plane | first pixels, ms: median, worst | whole map to t = 1000, ms: median, worst |\n|---|---|---|---|"
            )
            for case in ("I", "III"):
                explorer = ExplorerPage(browser.new_page(viewport={"width": 1600, "height": 1200}))
                explorer.page.goto(address)
                explorer.wait_until_complete()
                explorer.choose("t_max", "1 000")
                explorer.press(case)
                time.sleep(3)
                explorer.wait_until_complete()
                columns = [
                    f"{statistics.median(values):.0f}, {max(values):.0f}" for values in zip(*measure(explorer), strict=True)
                ]
                print(f"| {case} | (x, px) | {' | '.join(columns)} |")
                explorer.page.close()
    finally:
        process.terminate()
        process.wait(30)


if __name__ == "__main__":
    main()
