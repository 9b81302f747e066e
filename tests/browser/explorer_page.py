"""Act on the page in a browser, and read what it shows."""

from __future__ import annotations

import re
from typing import Any
from urllib.parse import unquote

import numpy as np
from playwright.sync_api import Locator, Page, expect

_DOCUMENT = "Bokeh.documents[0]"
# Bokeh's tool for each choice of what a drag does.
_DRAG_TOOLS = {"Move": "PanTool", "Zoom": "BoxZoomTool", "Count": "BoxSelectTool"}
# Screen position of a point of a picture.
_POINT = """([name, x, y]) => {
    for (const view of Bokeh.index.all_views()) {
        if (view.model.name !== name) continue
        const box = view.canvas_view.el.getBoundingClientRect()
        return [box.left + view.frame.x_scale.compute(x), box.top + view.frame.y_scale.compute(y)]
    }
}"""
# A column of the maps' source. Images are objects with shape and values.
_COLUMN = """name => {
    const value = Bokeh.documents[0].get_model_by_name('maps').data[name][0]
    return typeof value == 'object' ? {shape: [...value.shape], values: [...value]} : value
}"""

# All columns of a source as plain lists.
_DATA = """name => {
    const plain = value => ArrayBuffer.isView(value) ? [...value] : Array.isArray(value) ? value.map(plain) : value
    const {data} = Bokeh.documents[0].get_model_by_name(name) ?? {data: {}}
    return Object.fromEntries(Object.entries(data).map(([key, value]) => [key, plain(value)]))
}"""

_RANGES = """name => {
    const {x_range, y_range} = Bokeh.documents[0].get_model_by_name(name)
    return [x_range.start, x_range.end, y_range.start, y_range.end]
}"""

# Whether the window in the address is that of a picture, to rounding.
_ADDRESSED = """name => {
    const {x_range, y_range} = Bokeh.documents[0].get_model_by_name(name)
    const edges = new URL(location.href).searchParams.get("window")?.split(",").map(Number)
    return edges && [x_range.start, x_range.end, y_range.start, y_range.end].every((end, k) => Math.abs(end - edges[k]) < 1e-9)
}"""

# Remove the focus from a box, which would receive the keys of the page.
_BLUR = """() => {
    let focused = document.activeElement
    while (focused.shadowRoot?.activeElement) focused = focused.shadowRoot.activeElement
    focused.blur()
}"""

# Whether browser and page are at the first entry of the history.
_RETURNED = """() => history.state.entry === 0
    && [...Bokeh.documents[0].all_models].some(model => model.data?.attributes?.address?.entry === 0)"""

# Whether the pixels are those of a preview at an energy: incomplete, with at least some pixels along a side.
_PREVIEW = "!data.complete[0] && data.fate[0].shape[0] >= {least} && Math.abs(data.energy[0] - {energy}) < 1e-9"

# Places on the slider. The thumb of Chromium is 16 pixels wide, so its middle stays 8 pixels from both ends.
_RAIL_AND_THUMB = """rail => {
    const {x, y, width, height} = rail.getBoundingClientRect(), reach = width - 16
    const share = (rail.value - rail.min) / (rail.max - rail.min)
    return {begin: x + 8 + share * reach, low: x + 8, reach, middle: y + height / 2}
}"""


class ExplorerPage:
    """Acts on the page of one session, which opens at the address `home`. `problems` is a list to which others append."""

    def __init__(self, page: Page, home: str = "", problems: list[str] | None = None) -> None:
        self.page, self._home = page, home
        self._problems = [] if problems is None else problems

    def open(self) -> None:
        """Open the address, and wait for its map."""
        self.page.goto(self._home)
        self.wait_until_complete()

    def take_problems(self) -> list[str]:
        """Return the problems since the last call."""
        taken = [*self._problems]
        self._problems.clear()
        return taken

    def wait_until_complete(self) -> None:
        self.page.wait_for_function(
            f"window.Bokeh?.documents.length && {_DOCUMENT}.get_model_by_name('maps')?.data.complete[0] === true"
        )

    def wait_for_view(self, *parts: str) -> None:
        """Wait until the address has all of these parts, and the map of its view is complete."""
        # The server writes "Starting …" before the address.
        self.page.wait_for_url(lambda address: all(part in unquote(address) for part in parts))
        self.wait_until_done()

    def wait_until_done(self) -> None:
        """Wait until the status line says that the map is complete."""
        expect(self.text("✓ t =")).to_be_visible()

    def return_home(self) -> None:
        """Leave the box that has the focus, go back to the view that was opened, and wait for its map."""
        self.page.evaluate(_BLUR)
        steps = self.page.evaluate("() => history.state.entry")
        if steps:
            self.page.evaluate("steps => history.go(-steps)", steps)
            # The page writes the address of an entry when it shows the view of the entry.
            self.page.wait_for_function(_RETURNED)
            self.wait_until_done()

    def column(self, name: str) -> Any:
        """Return a column of the maps' source: an image as an array, or a plain value."""
        value = self.page.evaluate(_COLUMN, name)
        return np.array(value["values"]).reshape(value["shape"]) if isinstance(value, dict) else value

    def model_data(self, name: str) -> dict[str, list[Any]]:
        """Return the columns of a source, as lists; empty while the source is not on the page."""
        return self.page.evaluate(_DATA, name)

    def wait_for_data(self, name: str, condition: str) -> None:
        """Wait until a JavaScript condition on the columns `data` of a source holds."""
        self.page.wait_for_function(
            f"([name, test]) => {{ const model = {_DOCUMENT}.get_model_by_name(name);"
            " return model && new Function('data', 'return ' + test)(model.data) }",
            arg=[name, condition],
        )

    def forget_pixels(self) -> None:
        """Store the present pixels for `wait_for_new_pixels`."""
        self.page.evaluate(f"() => {{ window.before = {_DOCUMENT}.get_model_by_name('maps').data }}")

    def wait_for_new_pixels(self) -> None:
        self.page.wait_for_function(f"{_DOCUMENT}.get_model_by_name('maps').data !== window.before")

    def ranges(self, picture: str) -> list[float]:
        return self.page.evaluate(_RANGES, picture)

    def wait_for_address_of(self, picture: str) -> None:
        """Wait until the window in the address is that of a picture."""
        self.page.wait_for_function(_ADDRESSED, arg=picture)

    def button(self, label: str) -> Locator:
        return self.page.get_by_role("button", name=label, exact=True)

    def press(self, label: str) -> None:
        self.button(label).click()

    def open_fold(self, title: str) -> None:
        """Open a fold, unless it is open."""
        self.page.get_by_role("button", name=re.compile(f"^[▸▾] {title}$")).wait_for()
        if self.button(f"▸ {title}").is_visible():
            self.press(f"▸ {title}")
            self.button(f"▾ {title}").wait_for()

    def point(self, picture: str, x: float, ordinate: float) -> list[float]:
        """Return the position of a point of the plane on the screen."""
        return self.page.evaluate(_POINT, [picture, x, ordinate])

    def click(self, picture: str, x: float, ordinate: float) -> None:
        self.page.mouse.click(*self.point(picture, x, ordinate))

    def drag(self, picture: str, begin: tuple[float, float], end: tuple[float, float]) -> None:
        """Drag from one point of the plane to another."""
        self.page.mouse.move(*self.point(picture, *begin))
        self.page.mouse.down()
        self.page.mouse.move(*self.point(picture, *end), steps=5)
        self.page.mouse.up()

    def turn_wheel(self, picture: str, x: float, ordinate: float, delta: float) -> None:
        """Turn the wheel over a point of the plane; a negative `delta` zooms in."""
        self.page.mouse.move(*self.point(picture, x, ordinate))
        self.page.mouse.wheel(0, delta)

    def hover(self, picture: str, x: float, ordinate: float) -> None:
        left, top = self.point(picture, x, ordinate)
        self.page.mouse.move(left - 3, top)
        self.page.mouse.move(left, top)

    def text(self, pattern: str) -> Locator:
        return self.page.get_by_text(pattern).first

    def radio(self, label: str) -> Locator:
        """Return a button of a segmented control."""
        return self.page.get_by_role("radio", name=label, exact=True)

    def pick(self, label: str) -> None:
        """Press a button of a segmented control."""
        self.radio(label).click()

    def choose(self, label: str, option: str) -> None:
        """Choose an option of a list in "Quality and colours"."""
        self.open_fold("Quality and colours")
        self.page.get_by_label(label, exact=True).select_option(label=option)

    def set_drag(self, mode: str) -> None:
        """Choose what a drag over a map does, and wait until the maps do it."""
        self.pick(mode)
        self.page.wait_for_function(
            f"tool => {_DOCUMENT}.get_model_by_name('basins').toolbar.gestures.pan.active?.type == tool", arg=_DRAG_TOOLS[mode]
        )

    def type_number(self, label: str, value: str) -> None:
        box = self.page.get_by_label(label, exact=True).first
        box.fill(value)
        box.press("Enter")

    def drag_energy_to(self, share: float, *, steps: int = 5, let_go: bool = True) -> None:
        """Drag the thumb of the energy slider to a share of its length."""
        rail = self._rail()
        begin, end = rail["begin"], rail["low"] + share * rail["reach"]
        self.page.mouse.move(begin, rail["middle"])
        self.page.mouse.down()
        self.page.mouse.move(end, rail["middle"], steps=steps)
        if let_go:
            self.page.mouse.up()

    def wait_for_preview(self, energy: float, least: int = 76) -> None:
        """Wait for pixels of the browser at an energy, with at least this number along a side."""
        self.wait_for_data("maps", _PREVIEW.format(energy=energy, least=least))

    def start_engine(self) -> None:
        """Wait until the browser has its engine. This requests a preview of case I at h = 0.22, and goes back to h = 0.19."""
        self.drag_energy_to(0.3, let_go=False)
        self.wait_for_preview(0.22)
        self.drag_energy_to(0.225)

    def move_slider_to(self, share: float) -> None:
        """Move the thumb that is being dragged to a share of its length."""
        rail = self._rail()
        self.page.mouse.move(rail["low"] + share * rail["reach"], rail["middle"])

    def _rail(self) -> dict[str, float]:
        """Return places on the slider of the energy, on the screen."""
        return self.page.get_by_role("slider", name="Energy h", exact=True).evaluate(_RAIL_AND_THUMB)

    def window_of_pixels(self) -> list[float]:
        """Return the window that the pixels cover: lowest x, highest x, lowest ordinate and highest ordinate."""
        x, y, width, height = (self.column(name) for name in ("x", "y", "dw", "dh"))
        return [x, x + width, y, y + height]
