"""Takes the README's picture from the real page. Run with the app served: python docs/make_picture.py http://127.0.0.1:5006/app"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from playwright.sync_api import expect, sync_playwright

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.browser.explorer_page import ExplorerPage


def main(address: str) -> None:
    """Save the picture of case III at h = 0.45, with an orbit that wanders before it leaves."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1600, "height": 1150})
        page.goto(address)
        explorer = ExplorerPage(page)
        explorer.wait_until_complete()
        for label in ("III", "(x, y)"):
            explorer.forget_pixels()
            explorer.press(label)
            explorer.wait_for_new_pixels()
        explorer.type_number("h exactly", "0.45")
        explorer.page.wait_for_timeout(1000)
        explorer.wait_until_complete()
        explorer.click("basins", 0.35, 0.12)
        expect(explorer.text("upward crossings of y = 0")).to_be_visible()
        page.mouse.move(5, 1100)
        page.wait_for_timeout(3000)
        page.screenshot(path=str(Path(__file__).with_name("explorer.png")))
        browser.close()


if __name__ == "__main__":
    main(sys.argv[1])
