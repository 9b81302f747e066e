"""The gallery opens, shows its cards, and each card opens its view."""

from __future__ import annotations

import re

from playwright.sync_api import expect

from app.state.presets import PRESETS
from tests.browser.explorer_page import ExplorerPage


def test_every_preset_has_a_card_with_a_picture(shared: ExplorerPage) -> None:
    shared.press("Gallery")
    for preset in PRESETS:
        card = shared.page.get_by_role("button", name=re.compile(re.escape(preset.title)))
        expect(card.first).to_be_attached()
    shared.page.wait_for_function(
        """() => {
            const pictures = []
            const look = root => { for (const node of root.querySelectorAll('*')) {
                if (node.tagName == 'IMG' && node.src.includes('/static/gallery/')) pictures.push(node)
                if (node.shadowRoot) look(node.shadowRoot)
            } }
            look(document)
            return pictures.length > 5 && pictures.some(picture => picture.complete && picture.naturalWidth == 160)
        }"""
    )
    shared.press("Gallery")


def test_a_card_opens_its_view(explorer: ExplorerPage) -> None:
    preset = next(preset for preset in PRESETS if preset.window is not None and preset.case == "III")
    explorer.press("Gallery")
    explorer.page.get_by_role("button", name=re.compile(re.escape(preset.title))).first.click()
    explorer.page.wait_for_url(
        re.compile(f"case=III&plane={preset.plane.name.lower()}&h={re.escape(repr(preset.energy))}.*window=")
    )
    # The previous picture is complete, too.
    explorer.wait_for_data("maps", f"data.complete[0] && data.x[0] == {preset.window.x_low!r}")
    assert explorer.ranges("basins")[0] == preset.window.x_low
    expect(explorer.radio("III")).to_be_checked()


def test_the_gallery_can_be_closed_again(shared: ExplorerPage) -> None:
    shared.press("Gallery")
    card = shared.page.get_by_role("button", name=re.compile(re.escape(PRESETS[0].title))).first
    expect(card).to_be_visible()
    shared.press("Gallery")
    expect(card).not_to_be_visible()
