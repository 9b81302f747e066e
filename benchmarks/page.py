"""Measure the page in headless Chromium: opening, latency of the server's pixels, bytes of an update, server memory.

The engine in the browser is measured by `benchmarks.drag`. Run: uv run python -m benchmarks.page
"""

from __future__ import annotations

import argparse
import shutil
import statistics
import tempfile
import time
import urllib.request
from collections.abc import Callable
from dataclasses import astuple, dataclass
from pathlib import Path

from playwright.sync_api import Browser, Page, WebSocket, sync_playwright

from benchmarks.load import resident_megabytes
from tests.browser.explorer_page import ExplorerPage
from tests.browser.served_app import PANEL, served_app, started_app

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-headless-shell")
# Places of the actions, as shares of the range of the slider or of the plane.
SHARES = (0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.5, 0.4)
# Number of pages that are opened and closed for the memory of the server.
CYCLES = 30
NEW_POTENTIALS = ("½(x² + y²) − x²y² − x³/4", "½(x² + y²) − x²y² − 0.1x⁴y²")
# Script that stores the times of the first and of all pixels. Pixels are on the screen at the second animation frame after a
# change of the source. `begin` is called at the start of each action.
WATCH = """() => {
    const source = Bokeh.documents[0].get_model_by_name('maps')
    window.painted = {}
    const paint = () => {
        const {data} = source
        requestAnimationFrame(() => requestAnimationFrame(() => {
            window.painted.first ??= performance.now()
            if (data.complete[0]) window.painted.whole ??= performance.now()
        }))
    }
    source.connect(source.properties.data.change, paint)
    window.begin = () => { window.painted = {begun: performance.now()} }
    addEventListener('pointerup', window.begin, {capture: true})
}"""


def wait_for_map(explorer: ExplorerPage) -> tuple[float, float]:
    """Wait for the complete map; return the milliseconds from the start of the action to the first and to the last frame."""
    explorer.page.wait_for_function("() => window.painted.whole !== undefined")
    painted = explorer.page.evaluate("() => window.painted")
    time.sleep(0.5)
    return painted["first"] - painted["begun"], painted["whole"] - painted["begun"]


def release(explorer: ExplorerPage, share: float) -> None:
    """Drag the energy slider to a share of its range and release it."""
    explorer.drag_energy_to(share, steps=1)


def zoom(explorer: ExplorerPage, share: float) -> None:
    """Turn the wheel by one step; the page waits until the ranges stop changing."""
    explorer.page.mouse.move(*explorer.point("basins", 0.1 * share, 0.1))
    explorer.page.evaluate("() => window.begin()")
    explorer.page.mouse.wheel(0, -100)


def zoom_box(explorer: ExplorerPage, share: float) -> None:
    """Zoom to a box, whose size depends on the share."""
    explorer.set_drag("Zoom")
    side = 0.2 + 0.3 * share
    explorer.drag("basins", (-side, 0.4 + side / 2), (0.0, 0.4 - side / 2))


# Number of openings, the first with an empty browser cache.
OPENINGS = 11
LONGEST_OPENING_MS = 120_000
# Script that counts the elements of the page, also in shadow roots.
ELEMENTS = """() => {
    let count = 0
    const walk = root => {
        for (const element of root.querySelectorAll("*")) {
            count++
            if (element.shadowRoot) walk(element.shadowRoot)
        }
    }
    walk(document)
    return count
}"""
# Conditions in JavaScript: the first pixels have arrived; all pixels have arrived.
FIRST_PIXELS, ALL_PIXELS = (
    f"() => {{ const data = window.Bokeh?.documents[0]?.get_model_by_name('maps')?.data; return {condition} }}"
    for condition in ("data?.fate?.[0]?.shape[0] > 1", "data?.complete?.[0] === true")
)
TWO_FRAMES = "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"


def report_opening(browser: Browser, address: str) -> None:
    """Print the times from navigation to the first map, with an empty and a full browser cache, and of the server's answer."""
    context = browser.new_context(viewport={"width": 1600, "height": 1000})
    openings = []
    for _ in range(OPENINGS):
        page = context.new_page()
        openings.append(open_once(page, address))
        size = page.evaluate("() => Bokeh.documents[0]._all_models.size"), page.evaluate(ELEMENTS)
        page.close()
    context.close()
    answers = [seconds_to_answer(address) for _ in range(OPENINGS)]
    print("| opening | first pixels, s | complete map, s | transferred, MB |\n|---|---|---|---|")
    print(f"| empty browser cache | {openings[0]} |")
    warm = [statistics.median(column) for column in zip(*map(astuple, openings[1:]), strict=True)]
    print(f"| full browser cache, median of {OPENINGS - 1} | {Opening(*warm)} |")
    print(f"\n{size[0]} models, {size[1]} elements. The server's answer, without a browser: {statistics.median(answers):.2f} s.")
    print(
        f"On a fresh server, which still prepares its kernels, as its first visitor: {open_fresh_server(browser)}.\n", flush=True
    )


@dataclass(frozen=True)
class Opening:
    """Seconds from navigation to the first pixels and to the complete map, and bytes from the server until then."""

    first: float
    whole: float
    received: float

    def __str__(self) -> str:
        return f"{self.first:.2f} | {self.whole:.2f} | {self.received / 1e6:.2f}"


def open_once(page: Page, address: str) -> Opening:
    """Open the page, and wait until the complete map is on the screen."""
    session, received = page.context.new_cdp_session(page), list[float]()
    session.send("Network.enable")
    session.on("Network.loadingFinished", lambda event: received.append(event["encodedDataLength"]))
    session.on("Network.webSocketFrameReceived", lambda event: received.append(len(event["response"]["payloadData"])))
    begin, times = time.perf_counter(), list[float]()
    page.goto(address)
    for condition in (FIRST_PIXELS, ALL_PIXELS):
        page.wait_for_function(condition, polling=20, timeout=LONGEST_OPENING_MS)
        page.evaluate(TWO_FRAMES)
        times.append(time.perf_counter() - begin)
    return Opening(*times, sum(received))


def open_fresh_server(browser: Browser) -> str:
    """Return the wait of the first visitor of a server that is still loading its cached kernels."""
    with tempfile.TemporaryDirectory() as folder:
        begin = time.perf_counter()
        with started_app(Path(folder) / "log", *PANEL) as running:
            listening = time.perf_counter() - begin
            context = browser.new_context(viewport={"width": 1600, "height": 1000})
            opening = open_once(context.new_page(), running.address)
            context.close()
    return f"complete map {opening.whole:.2f} s after navigation, which begins {listening:.2f} s after the start"


def seconds_to_answer(address: str) -> float:
    """Return the server's time for a new page, from the request to the last byte of the document."""
    begin = time.perf_counter()
    with urllib.request.urlopen(address, timeout=60) as answer:
        answer.read()
    return time.perf_counter() - begin


def open_page(browser: Browser, address: str, link: str = "") -> ExplorerPage:
    context = browser.new_context(viewport={"width": 1600, "height": 1200})
    explorer = ExplorerPage(context.new_page())
    explorer.page.goto(address + link)
    explorer.wait_until_complete()
    return explorer


def report_latency(browser: Browser, address: str) -> None:
    """Print the latency of new pixels after three kinds of actions."""
    print("| case | action | first pixels, ms: median, maximum | complete map, ms: median, maximum |")
    print("|---|---|---|---|")
    for case, h in (("I", 0.25), ("III", 0.45)):
        for name, action in (("energy slider released", release), ("box zoom", zoom_box), ("one wheel step", zoom)):
            explorer = open_page(browser, address, f"?case={case}&h={h}&t_max=1000")
            explorer.page.evaluate(WATCH)
            stages = zip(*(measure(explorer, action, share) for share in SHARES), strict=True)
            columns = [f"{statistics.median(times):.0f}, {max(times):.0f}" for times in stages]
            print(f"| {case} | {name} | {' | '.join(columns)} |", flush=True)
            explorer.page.context.close()


def measure(explorer: ExplorerPage, action: Callable[[ExplorerPage, float], None], share: float) -> tuple[float, float]:
    """Return the latency of one action, as in `wait_for_map`. After a box zoom, show the whole plane again."""
    action(explorer, share)
    times = wait_for_map(explorer)
    if action is zoom_box:
        explorer.press("Whole plane")
        time.sleep(1.0)
    return times


def report_typing(browser: Browser, address: str) -> None:
    """Print the time from the last letter of a typed potential to its first pixels, including review and compilation."""
    for formula in NEW_POTENTIALS:
        explorer = open_page(browser, address, "?t_max=1000")
        explorer.press("Other …")
        box = explorer.page.get_by_label("V(x, y) =")
        box.fill("")
        box.press_sequentially(formula, delay=40)
        begin = time.perf_counter()
        explorer.page.wait_for_timeout(200)
        explorer.forget_pixels()
        box.press("Enter")
        explorer.wait_for_new_pixels()
        print(f"New potential {formula}: first pixels after {time.perf_counter() - begin:.1f} s", flush=True)
        explorer.page.context.close()


def report_bytes(browser: Browser, address: str) -> None:
    """Print the bytes from the release of the slider to the complete map."""
    context = browser.new_context(viewport={"width": 1600, "height": 1200})
    received: list[int] = []

    def record(socket: WebSocket) -> None:
        socket.on("framereceived", lambda payload: received.append(len(payload)))

    page = context.new_page()
    page.on("websocket", record)
    page.goto(address + "?case=III&h=0.45&t_max=1000")
    explorer = ExplorerPage(page)
    explorer.wait_until_complete()
    explorer.page.evaluate(WATCH)
    time.sleep(1.0)
    received.clear()
    release(explorer, 0.6)
    wait_for_map(explorer)
    print(f"\nBytes for one full update at 224 × 224, III: {sum(received) / 1e6:.2f} MB", flush=True)
    context.close()


def report_memory(browser: Browser, address: str) -> None:
    """Print the memory of the server while the page, with one orbit, is opened and closed repeatedly."""
    process = server_process(address)
    sizes = []
    for _ in range(CYCLES):
        explorer = open_page(browser, address, "?case=III&h=0.45&t_max=1000&orbits=0.1,0.2")
        explorer.wait_for_data("paths", "data.xs.length == 1")
        explorer.page.context.close()
        sizes.append(resident_megabytes(process))
    # Sessions end about 15 to 35 s after their page.
    time.sleep(40.0)
    sizes.append(resident_megabytes(process))
    marks = ", ".join(f"{sizes[k]:.0f}" for k in (0, 4, 9, 14, 19, 24, 29))
    print(f"\nMemory of the server after 1, 5, 10, … {CYCLES} sessions: {marks} MB; 40 s later {sizes[-1]:.0f} MB", flush=True)


def server_process(address: str) -> int:
    """Return the process ID of the server."""
    port = address.split(":")[-1].split("/")[0]
    for folder in Path("/proc").glob("[0-9]*"):
        command = (folder / "cmdline").read_bytes().split(b"\0")
        if b"serve" in command and port.encode() in command:
            return int(folder.name)
    raise LookupError(f"no server at port {port}")


REPORTS: dict[str, Callable[[Browser, str], None]] = {
    "opening": report_opening,
    "typing": report_typing,
    "latency": report_latency,
    "bytes": report_bytes,
    "memory": report_memory,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=REPORTS, nargs="*", default=list(REPORTS), help="what to measure")
    chosen = parser.parse_args().only
    with (
        tempfile.TemporaryDirectory() as folder,
        served_app(Path(folder) / "log") as address,
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        for name in chosen:
            REPORTS[name](browser, address)
        browser.close()


if __name__ == "__main__":
    main()
