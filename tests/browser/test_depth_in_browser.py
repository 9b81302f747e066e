"""Zooming ends at the limit of double precision, with a message."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import expect

from app.state.presets import PRESETS
from engine import Window
from tests.browser.explorer_page import ExplorerPage

DEEP = next(preset for preset in PRESETS if preset.key == "closer")


@pytest.fixture(scope="module")
def window() -> Window:
    assert DEEP.window is not None
    return DEEP.window


@pytest.fixture(scope="module")
def opened(open_for_all: Callable[..., ExplorerPage], window: Window) -> ExplorerPage:
    edges = ",".join(map(repr, (window.x_low, window.x_high, window.ordinate_low, window.ordinate_high)))
    plane = DEEP.plane.key
    return open_for_all(link=f"?case={DEEP.case}&plane={plane}&h={DEEP.energy!r}&t_max=1000&resolution=112&window={edges}")


def test_a_window_of_1e_12_of_the_plane_is_computed(explorer: ExplorerPage, window: Window) -> None:
    assert window.x_high - window.x_low < 1e-11
    assert len(np.unique(explorer.column("fate"))) > 2
    explorer.hover("basins", 0.5 * (window.x_low + window.x_high), 0.5 * (window.ordinate_low + window.ordinate_high))
    # Enough digits to distinguish neighbouring pixels.
    expect(explorer.text(re.compile(r"\(-?0\.\d{14,17}, -?0\.\d{14,17}\)"))).to_be_visible()


@pytest.mark.slow
def test_zooming_beyond_double_precision_gives_a_message_and_the_picture_stays(explorer: ExplorerPage, window: Window) -> None:
    limit = explorer.page.get_by_role("alert").filter(has_text="double precision ends here")
    for _ in range(12):
        address = explorer.page.url
        explorer.page.keyboard.press("+")
        expect(explorer.page).not_to_have_url(address)
        expect(explorer.text("Done, t =").or_(limit).first).to_be_visible()
        if limit.is_visible():
            break
    expect(limit).to_be_visible()
    # The last window that could be computed.
    assert 0 < explorer.column("dw") < 0.1 * (window.x_high - window.x_low)
    assert explorer.column("fate").size > 1
