"""Zooming ends at the limit of double precision, with a message."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from app.job_clients.error_messages import ZOOM_ENDS
from app.state.permalink import preset_view
from engine import Window
from plots.links.presets import PRESETS
from tests.browser.explorer_page import ExplorerPage

DEEP = preset_view(next(preset for preset in PRESETS if preset.key == "closer"))


# Width and height of the frame of the basins, in pixels.
_FRAME = """() => {
    const {width, height} = [...Bokeh.index.all_views()].find(view => view.model.name == "basins").frame.bbox
    return [width, height]
}"""
_MOVED_OR_LIMITED = """([address, limit]) =>
    window.location.href != address || Bokeh.documents[0].get_model_by_name("notice").text.includes(limit)"""


@pytest.fixture(scope="module")
def window() -> Window:
    assert DEEP.window is not None
    return DEEP.window


@pytest.fixture(scope="module")
def opened(open_for_all: Callable[..., ExplorerPage], window: Window) -> ExplorerPage:
    edges = ",".join(map(repr, (window.x_low, window.x_high, window.ordinate_low, window.ordinate_high)))
    view = DEEP
    link = f"?case={view.system.case}&plane={view.plane.key}&h={view.energy!r}&t_max=1000&resolution=112&window={edges}"
    return open_for_all(link=link)


def test_ticks_are_distances_from_a_stated_number_and_the_frame_stays_square(explorer: ExplorerPage, window: Window) -> None:
    explorer.hover("basins", 0.5 * (window.x_low + window.x_high), 0.5 * (window.ordinate_low + window.ordinate_high))
    # Enough digits to distinguish neighbouring pixels.
    expect(explorer.text(re.compile(r"\(−?0\.\d{14,17}, −?0\.\d{14,17}\)"))).to_be_visible()
    expect(explorer.page.get_by_text("x = 0.1149")).to_have_count(3)
    width, height = explorer.page.evaluate(_FRAME)
    assert abs(width - height) <= 1


@pytest.mark.slow
def test_zooming_beyond_double_precision_gives_a_message_and_the_picture_stays(explorer: ExplorerPage, window: Window) -> None:
    limit = explorer.text(ZOOM_ENDS)
    for _ in range(12):
        address = explorer.page.url
        explorer.page.keyboard.press("+")
        explorer.page.wait_for_function(_MOVED_OR_LIMITED, arg=[address, ZOOM_ENDS])
        if limit.is_visible():
            break
        explorer.wait_for_data("maps", "data.complete[0]")
    expect(limit).to_be_visible()
    assert explorer.page.url == address
    # The picture is that of the last window that could be computed.
    explorer.wait_for_data("maps", f"data.complete[0] && 0 < data.dw[0] && data.dw[0] < {0.1 * (window.x_high - window.x_low)}")
    assert explorer.column("fate").size > 1
