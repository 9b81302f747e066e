"""Screenshots of the page for `docs/page.md`: each part at three widths, in both themes. Run: python docs/make_screenshots.py"""

from __future__ import annotations

import io
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, sync_playwright

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.browser.explorer_page import ExplorerPage
from tests.browser.served_app import served_app

HERE = Path(__file__).parent / "screenshots"
SIZES = {1600: 900, 1280: 800, 420: 860}
THEMES = ("light", "dark")
ORBITS = "?case=III&h=0.35&t_max=10000&orbits=0.1,0.2;-0.3,0.02"
# Of each picture: the link, what to do on the page, and whether all of it is taken or the window only.
PICTURES: dict[str, tuple[str, Callable[[ExplorerPage], None], bool]] = {
    "maps": ("", lambda explorer: None, False),
    "orbits": (ORBITS, lambda explorer: explorer.wait_for_data("points", "true"), True),
    "hover": ("?case=III&h=0.35&t_max=1000", lambda explorer: hover_when_ready(explorer), False),
    "layers": ("?case=II&h=0.24&judge=yes&trust=yes&manifolds=yes&origins=yes", lambda explorer: None, True),
    "statistics": ("?case=II&h=0.24&analysis=statistics", lambda explorer: None, True),
    "measures": ("?case=II&h=0.24&analysis=measures", lambda explorer: None, True),
    "gallery": ("", lambda explorer: explorer.press("Gallery"), False),
    "share": ("", lambda explorer: explorer.press("Share"), False),
    "help": ("", lambda explorer: explorer.press("Help"), False),
    "slice": ("?case=I&plane=x,epsilon=0.5:2&h=0.2&t_max=1000", lambda explorer: explorer.press("(x, ε) …"), False),
    "potential": ("", lambda explorer: explorer.press("Other …"), False),
}


def hover_when_ready(explorer: ExplorerPage) -> None:
    """Show the orbit under the cursor."""
    explorer.page.wait_for_timeout(4000)
    explorer.hover("basins", 0.35, 0.2)


def take(browser: Browser, address: str, name: str, width: int, theme: str) -> None:
    """Take one picture."""
    link, act, whole = PICTURES[name]
    context = browser.new_context(
        viewport={"width": width, "height": SIZES[width]}, color_scheme=theme, has_touch=width == min(SIZES)
    )
    explorer = ExplorerPage(context.new_page())
    explorer.page.goto(address + link)
    explorer.wait_until_complete()
    act(explorer)
    # Layers, analyses and thumbnails follow the map.
    explorer.page.wait_for_timeout(4000)
    png = explorer.page.screenshot(full_page=whole)
    Image.open(io.BytesIO(png)).convert("RGB").save(HERE / f"{name}-{width}-{theme}.webp", quality=70, method=6)
    context.close()


def main() -> None:
    """Take all pictures."""
    HERE.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, served_app(Path(folder) / "log") as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium") or shutil.which("chromium-headless-shell"), args=["--no-sandbox"]
        )
        for name in PICTURES:
            for width in SIZES:
                for theme in THEMES:
                    take(browser, address, name, width, theme)


if __name__ == "__main__":
    main()
