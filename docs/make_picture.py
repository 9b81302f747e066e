"""Record the animation of the README from the running page. Run: python docs/make_picture.py"""

from __future__ import annotations

import io
import shutil
import sys
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, sync_playwright

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.browser.explorer_page import ExplorerPage
from tests.browser.served_app import served_app

HERE = Path(__file__).parent
SWEPT = "?case=III&plane=x_y&h=0.28&t_max=1000"
FRAMES, FRAME_MS, WIDTH = 30, 250, 900
# Low enough for the tabs beside the maps to be short.
HEIGHT = 800


def open_page(browser: Browser, link: str, height: int) -> ExplorerPage:
    """Open the page on a wide screen."""
    context = browser.new_context(viewport={"width": 1600, "height": height})
    explorer = ExplorerPage(context.new_page())
    explorer.page.goto(link)
    explorer.wait_until_complete()
    return explorer


def take_animation(browser: Browser, address: str) -> None:
    """Animation of case III: the energy played upward from just above the escape energy."""
    explorer = open_page(browser, address + SWEPT, HEIGHT)
    page = explorer.page
    explorer.press("▶ Play")
    frames = []
    for _ in range(FRAMES):
        page.wait_for_timeout(FRAME_MS)
        frame = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
        frames.append(frame.resize((WIDTH, round(WIDTH * frame.height / frame.width)), Image.Resampling.LANCZOS))
    frames[0].save(
        HERE / "explorer.webp", save_all=True, append_images=frames[1:], duration=FRAME_MS, loop=0, quality=55, method=6
    )


def main() -> None:
    """Serve the app and record it."""
    with (
        tempfile.TemporaryDirectory() as folder,
        served_app(Path(folder) / "log") as address,
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium") or shutil.which("chromium-headless-shell"), args=["--no-sandbox"]
        )
        take_animation(browser, address)
        browser.close()


if __name__ == "__main__":
    main()
