"""Zooming ends at the limit of double precision, with a message."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
from playwright.sync_api import expect

from app.state.presets import PRESETS
from tests.browser.explorer_page import ExplorerPage

DEEP = next(preset for preset in PRESETS if preset.key == "closer")


def link_to(window: tuple[float, float, float, float]) -> str:
    edges = ",".join(map(repr, window))
    return f"?case={DEEP.case}&plane={DEEP.plane.name.lower()}&h={DEEP.energy!r}&t_max=1000&window={edges}"


def test_a_window_of_1e_12_of_the_plane_is_computed(open_explorer: Callable[..., ExplorerPage]) -> None:
    window = DEEP.window
    assert window is not None
    assert window.x_high - window.x_low < 1e-11
    explorer = open_explorer(link=link_to((window.x_low, window.x_high, window.ordinate_low, window.ordinate_high)))
    assert len(np.unique(explorer.column("fate"))) > 2
    x = 0.5 * (window.x_low + window.x_high)
    explorer.hover("basins", x, 0.5 * (window.ordinate_low + window.ordinate_high))
    # Enough digits to distinguish neighbouring pixels.
    expect(explorer.text(re.compile(r"\(-?0\.\d{14,17}, -?0\.\d{14,17}\)"))).to_be_visible()


def test_zooming_beyond_double_precision_gives_a_message_and_the_picture_stays(
    open_explorer: Callable[..., ExplorerPage],
) -> None:
    window = DEEP.window
    assert window is not None
    explorer = open_explorer(link=link_to((window.x_low, window.x_high, window.ordinate_low, window.ordinate_high)))
    sentence = explorer.text("double precision ends here")
    for _ in range(12):
        if sentence.is_visible():
            break
        explorer.page.keyboard.press("+")
        explorer.page.wait_for_timeout(700)
    expect(sentence).to_be_visible()
    # The last window that could be computed, possibly not yet complete.
    assert 0 < explorer.column("dw") < 0.1 * (window.x_high - window.x_low)
    assert explorer.column("fate").size > 1
