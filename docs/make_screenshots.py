"""Screenshots of the page for `docs/page.md`. Run: python docs/make_screenshots.py"""

from __future__ import annotations

import io
import shutil
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, sync_playwright

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.browser.explorer_page import ExplorerPage
from tests.browser.served_app import served_app

FOLDER = Path(__file__).parent / "screenshots"
HEIGHTS = {1600: 900, 1280: 800, 420: 860}
ORBITS = "?case=III&h=0.35&t_max=10000&orbits=0.1,0.2;-0.3,0.02"


@dataclass(frozen=True)
class Screenshot:
    """A picture of the page: its link, width in pixels, theme, what is done first, and whether it shows more than the window."""

    name: str
    width: int
    theme: str
    link: str = ""
    act: Callable[[ExplorerPage], None] = lambda explorer: None
    whole: bool = False


def hover_when_ready(explorer: ExplorerPage) -> None:
    """Show the orbit under the cursor."""
    explorer.page.wait_for_timeout(4000)
    explorer.hover("basins", 0.35, 0.2)


SCREENSHOTS = (
    Screenshot("maps", 1600, "light"),
    Screenshot("maps", 420, "light"),
    Screenshot("hover", 1280, "light", "?case=III&h=0.35&t_max=1000", hover_when_ready),
    Screenshot("layers", 1600, "dark", "?case=II&h=0.24&judge=yes&trust=yes&manifolds=yes&origins=yes"),
    Screenshot("orbits", 1280, "dark", ORBITS, lambda explorer: explorer.wait_for_data("points", "true")),
    Screenshot("orbits", 420, "dark", ORBITS, lambda explorer: explorer.wait_for_data("points", "true"), whole=True),
    Screenshot("statistics", 1280, "light", "?case=II&h=0.24&analysis=statistics"),
    Screenshot("measures", 1280, "light", "?case=II&h=0.24&analysis=measures"),
    Screenshot("potential", 1280, "light", act=lambda explorer: explorer.press("Other …")),
    Screenshot("slice", 1280, "light", "?case=I&plane=x,epsilon=0.5:2&h=0.2", lambda explorer: explorer.press("(x, ε) …")),
    Screenshot("gallery", 1280, "light", act=lambda explorer: explorer.press("Gallery")),
    Screenshot("share", 1280, "light", act=lambda explorer: explorer.press("Share")),
)


def take(browser: Browser, address: str, shot: Screenshot) -> None:
    """Take one picture."""
    viewport = {"width": shot.width, "height": HEIGHTS[shot.width]}
    context = browser.new_context(viewport=viewport, color_scheme=shot.theme, has_touch=shot.width == min(HEIGHTS))
    explorer = ExplorerPage(context.new_page())
    explorer.page.goto(address + shot.link)
    explorer.wait_until_complete()
    shot.act(explorer)
    # Layers, analyses and thumbnails follow the map.
    explorer.page.wait_for_timeout(4000)
    png = explorer.page.screenshot(full_page=shot.whole)
    file = FOLDER / f"{shot.name}-{shot.width}-{shot.theme}.webp"
    Image.open(io.BytesIO(png)).convert("RGB").save(file, quality=70, method=6)
    context.close()


def main() -> None:
    """Take all pictures."""
    FOLDER.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, served_app(Path(folder) / "log") as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium") or shutil.which("chromium-headless-shell"), args=["--no-sandbox"]
        )
        for shot in SCREENSHOTS:
            take(browser, address, shot)


if __name__ == "__main__":
    main()
