"""Take screenshots of the page, docs/screenshots/<name>-<width>-<theme>.webp, and record the animation docs/explorer.webp."""

from __future__ import annotations

import io
import shutil
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, expect, sync_playwright

from tests.browser.explorer_page import ExplorerPage
from tests.browser.served_app import served_app

DOCS = Path(__file__).parents[1]
HEIGHTS = {1600: 900, 1280: 800, 420: 860}
TIMEOUT_MS = 120_000.0
ORBITS = "?case=III&h=0.35&t_max=10000&orbits=0.1,0.2;-0.3,0.02"

PLAYED = "?case=III&plane=x_y&h=0.28&t_max=1000"
"""Link to case III just above its escape energy."""
# Number, duration and width of the frames of the animation.
FRAMES, FRAME_MS, PLAYED_WIDTH = 30, 250, 900


@dataclass(frozen=True)
class Screenshot:
    """A picture of the page after `act`, in a window of some width in pixels. With `whole`, it shows more than the window."""

    name: str
    width: int
    theme: str
    link: str = ""
    act: Callable[[ExplorerPage], None] = lambda explorer: None
    whole: bool = False

    def take(self, browser: Browser, address: str) -> None:
        """Open the page, act, and save what it shows."""
        viewport = {"width": self.width, "height": HEIGHTS[self.width]}
        context = browser.new_context(viewport=viewport, color_scheme=self.theme, has_touch=self.width == min(HEIGHTS))
        context.set_default_timeout(TIMEOUT_MS)
        explorer = ExplorerPage(context.new_page(), address + self.link)
        explorer.open()
        self.act(explorer)
        # Layers, analyses and thumbnails follow the map.
        explorer.page.wait_for_timeout(4000)
        expect(explorer.page.get_by_text("computing").filter(visible=True)).to_have_count(0, timeout=TIMEOUT_MS)
        png = explorer.page.screenshot(full_page=self.whole)
        file = DOCS / "screenshots" / f"{self.name}-{self.width}-{self.theme}.webp"
        Image.open(io.BytesIO(png)).convert("RGB").save(file, quality=70, method=6)
        context.close()


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


def record(browser: Browser, address: str) -> None:
    """Record the page while the energy is played upward."""
    explorer = ExplorerPage(browser.new_context(viewport={"width": 1600, "height": 800}).new_page(), address + PLAYED)
    explorer.open()
    explorer.press("▶ Play")
    frames = []
    for _ in range(FRAMES):
        explorer.page.wait_for_timeout(FRAME_MS)
        frame = Image.open(io.BytesIO(explorer.page.screenshot())).convert("RGB")
        size = PLAYED_WIDTH, round(PLAYED_WIDTH * frame.height / frame.width)
        frames.append(frame.resize(size, Image.Resampling.LANCZOS))
    file = DOCS / "explorer.webp"
    frames[0].save(file, save_all=True, append_images=frames[1:], duration=FRAME_MS, loop=0, quality=55, method=6)


PICTURES = {f"screenshots/{one.name}-{one.width}-{one.theme}": one.take for one in SCREENSHOTS} | {"explorer": record}


def make(names: Sequence[str]) -> None:
    """Serve the page, and take the pictures with these names."""
    if not names:
        return
    with tempfile.TemporaryDirectory() as folder, served_app(Path(folder) / "log") as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium") or shutil.which("chromium-headless-shell"), args=["--no-sandbox"]
        )
        for name in names:
            PICTURES[name](browser, address)
        browser.close()
