"""The page in Chromium: how soon new pixels are there, how many quick looks a second, how many bytes, and what stays behind.

Run: uv run python -m benchmarks.page
"""

from __future__ import annotations

import shutil
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Browser, WebSocket, sync_playwright

from tests.browser.explorer_page import ExplorerPage
from tests.browser.served_app import served_app

SHARES = (0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.5, 0.4)
CYCLES = 30
TYPED = ("½(x² + y²) − x²y² − x³/4", "½(x² + y²) − x²y² − 0.1x⁴y²")
# Pixels are on the screen at the second animation frame after the source has changed. `begin` is set by whoever acts; only
# frames of the map that is waited for count, and they have 225 pixels a side at the end.
WATCH = """() => {
    const source = Bokeh.documents[0].get_model_by_name('maps')
    window.painted = {}
    window.looks = []
    const paint = () => {
        const now = performance.now(), {data} = source
        requestAnimationFrame(() => requestAnimationFrame(() => {
            window.painted.first ??= performance.now()
            if (data.complete[0]) window.painted.whole ??= performance.now()
        }))
        if (data.fate[0].shape[0] == 75) window.looks.push(now)
    }
    source.connect(source.properties.data.change, paint)
    window.begin = () => { window.painted = {begun: performance.now()} }
    addEventListener('pointerup', window.begin, {capture: true})
}"""


def waited(explorer: ExplorerPage) -> tuple[float, float]:
    """(first, whole) milliseconds after the beginning."""
    explorer.page.wait_for_function("() => window.painted.whole !== undefined")
    painted = explorer.page.evaluate("() => window.painted")
    time.sleep(0.5)
    return painted["first"] - painted["begun"], painted["whole"] - painted["begun"]


def release(explorer: ExplorerPage, share: float) -> None:
    explorer.drag_energy_to(share, steps=1)


def zoom(explorer: ExplorerPage, share: float) -> None:
    """One turn of the wheel; the page waits for the ranges to rest before it computes."""
    explorer.page.mouse.move(*explorer.point("basins", 0.1 * share, 0.1))
    explorer.page.evaluate("() => window.begin()")
    explorer.page.mouse.wheel(0, -100)


def zoom_box(explorer: ExplorerPage, share: float) -> None:
    """A box drawn around the middle and let go of; then back to the whole plane, which is kept."""
    explorer.page.evaluate(
        """() => {
            for (const tool of Bokeh.documents[0].get_model_by_name('basins').toolbar.tools)
                if (tool.type == 'BoxZoomTool') tool.active = true
        }"""
    )
    side = 0.2 + 0.3 * share
    explorer.page.mouse.move(*explorer.point("basins", -side, 0.4 + side / 2))
    explorer.page.mouse.down()
    explorer.page.mouse.move(*explorer.point("basins", 0.0, 0.4 - side / 2), steps=3)
    explorer.page.mouse.up()


def opened(browser: Browser, address: str, link: str = "") -> ExplorerPage:
    context = browser.new_context(viewport={"width": 1600, "height": 1200})
    context.add_init_script("localStorage.setItem('escape-explorer-visited', 'yes')")
    explorer = ExplorerPage(context.new_page())
    explorer.page.goto(address + link)
    explorer.wait_until_complete()
    return explorer


def report_latency(browser: Browser, address: str) -> None:
    print("| case | after | first pixels, ms: median, worst | whole map to t = 1000, ms: median, worst |")
    print("|---|---|---|---|")
    for case, h in (("I", 0.25), ("III", 0.45)):
        for name, act in (("release of the slider", release), ("release of a box", zoom_box), ("a turn of the wheel", zoom)):
            explorer = opened(browser, address, f"?case={case}&h={h}&t_max=1000")
            explorer.page.evaluate(WATCH)
            stages = zip(*(measure(explorer, act, share) for share in SHARES), strict=True)
            columns = [f"{statistics.median(times):.0f}, {max(times):.0f}" for times in stages]
            print(f"| {case} | {name} | {' | '.join(columns)} |", flush=True)
            explorer.page.context.close()


def measure(explorer: ExplorerPage, act: Callable[[ExplorerPage, float], None], share: float) -> tuple[float, float]:
    act(explorer, share)
    times = waited(explorer)
    if act is zoom_box:
        explorer.press("Whole plane")
        time.sleep(1.0)
    return times


def report_looks(browser: Browser, address: str) -> None:
    """Case III, dragged from h = 0.45 to h = 1 in about four seconds."""
    explorer = opened(browser, address, "?case=III&h=0.45&t_max=1000")
    explorer.page.evaluate(WATCH)
    explorer.drag_energy_to(1.0, steps=200, pause=15, let_go=False)
    looks = explorer.page.evaluate("() => window.looks")
    rate = (len(looks) - 1) / (looks[-1] - looks[0]) * 1000
    print(f"\nQuick looks while dragging, III from h = 0.45 up: {len(looks)}, {rate:.1f} a second", flush=True)
    explorer.page.mouse.up()
    explorer.page.context.close()


def report_typing(browser: Browser, address: str) -> None:
    """Potentials of kinds never seen before: from the last letter to the first pixels, looked over and compiled on the way."""
    for formula in TYPED:
        explorer = opened(browser, address, "?t_max=1000")
        explorer.press("Other …")
        box = explorer.page.get_by_label("V(x, y) =")
        explorer.forget_pixels()
        box.fill("")
        box.press_sequentially(formula, delay=40)
        begin = time.perf_counter()
        explorer.page.wait_for_timeout(200)
        box.press("Enter")
        explorer.wait_for_new_pixels()
        print(f"Typed for the first time, {formula}: first pixels after {time.perf_counter() - begin:.1f} s", flush=True)
        explorer.page.context.close()


def report_bytes(browser: Browser, address: str) -> None:
    """One full update: from the release of the slider to the whole map."""
    context = browser.new_context(viewport={"width": 1600, "height": 1200})
    received: list[int] = []

    def listen(socket: WebSocket) -> None:
        socket.on("framereceived", lambda payload: received.append(len(payload)))

    page = context.new_page()
    page.on("websocket", listen)
    page.goto(address + "?case=III&h=0.45&t_max=1000")
    explorer = ExplorerPage(page)
    explorer.wait_until_complete()
    explorer.page.evaluate(WATCH)
    time.sleep(1.0)
    received.clear()
    release(explorer, 0.6)
    waited(explorer)
    print(f"\nBytes for one full update at 225 × 225, III: {sum(received) / 1e6:.2f} MB", flush=True)
    context.close()


def report_memory(browser: Browser, address: str) -> None:
    """Open and close the page again and again, each time with an orbit."""
    process = server_process(address)
    sizes = []
    for _ in range(CYCLES):
        explorer = opened(browser, address, "?case=III&h=0.45&t_max=1000&orbits=0.1,0.2")
        explorer.wait_for_data("paths", "data.xs.length == 1")
        explorer.page.context.close()
        sizes.append(resident_megabytes(process))
    # Sessions end some 15 to 35 seconds after their page.
    time.sleep(40.0)
    sizes.append(resident_megabytes(process))
    marks = ", ".join(f"{sizes[k]:.0f}" for k in (0, 4, 9, 14, 19, 24, 29))
    print(f"\nServer's memory after 1, 5, 10, … {CYCLES} visits: {marks} MB; 40 s later {sizes[-1]:.0f} MB", flush=True)


def server_process(address: str) -> int:
    port = address.split(":")[-1].split("/")[0]
    for folder in Path("/proc").glob("[0-9]*"):
        command = (folder / "cmdline").read_bytes().split(b"\0")
        if b"serve" in command and port.encode() in command:
            return int(folder.name)
    raise LookupError(f"no server at port {port}")


def resident_megabytes(process: int) -> float:
    pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    return pages * 4096 / 2**20


def main() -> None:
    with (
        tempfile.TemporaryDirectory() as folder,
        served_app(Path(folder) / "log") as address,
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        for report in (report_typing, report_latency, report_looks, report_bytes, report_memory):
            report(browser, address)
        browser.close()


if __name__ == "__main__":
    main()
