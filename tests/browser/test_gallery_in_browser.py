"""The folder of the command ``gallery`` works from a disk without a network."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from engine.foundations.execution import DEFAULT_EXECUTION
from plots.links.presets import PRESETS
from plots.live.gallery import entry_files, preset_entry, shared_files
from plots.pictures.palette import PAPER

KEYS = ("crossings", "strength")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    entries = [preset_entry(preset) for preset in PRESETS if preset.key in KEYS]
    small = [replace(entry, spec=replace(entry.spec, resolution=(40, 40), t_max=50.0)) for entry in entries]
    path = tmp_path_factory.mktemp("gallery")
    for files in (shared_files(small), *(entry_files(entry, PAPER, DEFAULT_EXECUTION) for entry in small)):
        for name, content in files.items():
            (path / name).write_bytes(content.encode() if isinstance(content, str) else content)
    return path


@pytest.fixture
def open_gallery(open_offline: Callable[..., Page], folder: Path) -> Callable[..., Page]:
    """Return a function that opens the list in a window of a given width."""
    return partial(open_offline, folder / "index.html")


def test_a_card_opens_a_figure_that_the_browser_computes(open_gallery: Callable[..., Page]) -> None:
    page = open_gallery()
    page.get_by_role("link", name="Counting crossings").click()
    expect(page.locator("#live")).to_be_visible()
    expect(page.locator("#picture")).to_have_value("crossings")
    page.locator("#map").focus()
    page.keyboard.press("+")
    expect(page.locator("#status")).to_contain_text("Preview, computed here")
    page.get_by_role("link", name="All figures").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("Escapes in open Hamiltonian systems")


def test_cards_are_reached_and_opened_by_keys(open_gallery: Callable[..., Page]) -> None:
    page = open_gallery()
    card = page.get_by_role("link", name="From order to escape")
    for _ in range(4):
        page.keyboard.press("Tab")
    expect(card).to_be_focused()
    page.keyboard.press("Enter")
    expect(page.get_by_text("A still picture: along ε")).to_be_visible()
    assert page.locator("img").evaluate("image => image.naturalWidth") > 0


@pytest.mark.parametrize(("width", "theme"), [(320, "dark"), (420, "light"), (1600, "dark")])
def test_nothing_is_wider_than_the_window(open_gallery: Callable[..., Page], width: int, theme: str) -> None:
    page = open_gallery(width, theme)
    for address in (page.url, *(page.url.replace("index", key) for key in KEYS)):
        page.goto(address)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
