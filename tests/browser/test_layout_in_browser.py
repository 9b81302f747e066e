"""The parts of the page have their places on wide, medium and narrow screens, and nothing idle is shown."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from html import escape, unescape

import pytest
from playwright.sync_api import Locator, expect

from app.state.help_texts import HELP_TEXTS
from app.views.maps.picture_grid import SHORT_TITLES
from app.views.maps.well import TITLE
from engine import CASES, MapSpec, Plane
from plots.layers.table import PICTURES as PICTURE_ENTRIES
from plots.layers.table import TITLES
from plots.pictures.palette import DEFAULT_COLOURS, PALETTES
from plots.texts.typeset import typeset
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

OpenExplorer = Callable[..., ExplorerPage]
MAPS = ("basins", "times", "crossings")
PICTURES = ("well", *MAPS)
# The map of `QUICK`, in titles.
SPEC = MapSpec(CASES["I"], Plane.X_PX, 0.19)
Box = tuple[float, float, float, float]

# Left, top, right and bottom of each visible figure on the screen, clipped by parts that scroll; width and height of its frame.
_FIGURES = """() => {
    const clipped = element => {
        let {left, top, right, bottom} = element.getBoundingClientRect()
        for (let node = element; node; node = node.parentElement ?? node.getRootNode().host) {
            if (getComputedStyle(node).overflowY != "auto") continue
            const box = node.getBoundingClientRect()
            top = Math.max(top, box.top)
            bottom = Math.min(bottom, box.bottom)
        }
        return [left, top, right, bottom]
    }
    return Object.fromEntries([...Bokeh.index.all_views()].filter(view => view.model.type == "Figure" && view.el.offsetWidth > 0)
        .map(view => [view.model.name, [...clipped(view.el), view.frame.bbox.width, view.frame.bbox.height]]))
}"""
# Number of elements of the page, also in shadow roots.
_ELEMENTS = """() => {
    let count = 0
    const walk = root => {
        for (const node of root.querySelectorAll("*")) {
            count++
            if (node.shadowRoot) walk(node.shadowRoot)
        }
    }
    walk(document)
    return count
}"""
_LEGEND = """foot => [...foot.querySelectorAll(".patch")]
    .map(patch => [patch.textContent.trim(), patch.getAttribute("style").replace("--colour:", "")])"""
# Labels of buttons that have no use when the page opens.
_IDLE = (
    "Whole plane",
    "Stop",
    "Continue",
    "Clear all",
    "Remove",
    "Add this neighbour",
    "Nearest periodic orbit",
    "Count the whole view",
)


def figures(explorer: ExplorerPage) -> dict[str, list[float]]:
    return explorer.page.evaluate(_FIGURES)


def boxes(explorer: ExplorerPage) -> list[Box]:
    """Return left, top, right and bottom of the pictures on the screen."""
    shown = figures(explorer)
    return [tuple(shown[name][:4]) for name in PICTURES]


def overlap(one: Box, other: Box) -> bool:
    return min(one[2], other[2]) > max(one[0], other[0]) + 1 and min(one[3], other[3]) > max(one[1], other[1]) + 1


@pytest.fixture(scope="module")
def wide(open_for_all: OpenExplorer) -> ExplorerPage:
    return open_for_all(1600, 1000, QUICK)


@pytest.fixture(scope="module")
def middling(open_for_all: OpenExplorer) -> ExplorerPage:
    return open_for_all(1280, 720, QUICK)


@pytest.fixture(scope="module")
def phone(open_for_all: OpenExplorer) -> ExplorerPage:
    explorer = open_for_all(420, 900, QUICK, touch=True)
    expect(explorer.radio(SHORT_TITLES["basins"])).to_be_checked()
    return explorer


def test_the_page_opens_with_few_models_and_elements(wide: ExplorerPage) -> None:
    assert wide.page.evaluate("() => [...Bokeh.documents[0].all_models].length") <= 210
    assert wide.page.evaluate(_ELEMENTS) <= 1280


def test_nothing_idle_is_shown(wide: ExplorerPage) -> None:
    for label in _IDLE:
        expect(wide.button(label)).to_be_hidden()
    for disabled in wide.page.locator(":disabled, [aria-disabled=true]").all():
        expect(disabled).to_be_hidden()
    assert set(figures(wide)) == set(PICTURES)


@pytest.mark.parametrize(("page", "height", "least"), [("wide", 1000, 300), ("middling", 720, 200)])
def test_well_and_basins_are_above_the_other_pictures_and_all_are_seen_beside_the_orbits(
    page: str, height: int, least: int, request: pytest.FixtureRequest
) -> None:
    explorer: ExplorerPage = request.getfixturevalue(page)
    places = boxes(explorer)
    assert len({place[1] for place in places}) == 2
    well, basins, times, crossings = (figures(explorer)[name][4] for name in PICTURES)
    assert well == pytest.approx(basins, abs=1.0)
    assert times == pytest.approx(crossings, abs=1.0)
    assert well > 1.2 * times
    assert max(place[3] for place in places) <= height
    assert min(min(figures(explorer)[name][4:]) for name in PICTURES) >= least
    hint = explorer.text("Click a map: the orbit").bounding_box()
    assert hint is not None
    assert hint["x"] >= max(place[2] for place in places)
    assert hint["y"] < places[2][1]


# Class names of titles, legends and names that cover the frame of a picture, for each large picture.
_COVERED = """() => {
    const shown = [...Bokeh.index.all_views()].filter(view => view.model.type == "Figure" && view.canvas_view.el.clientWidth
        && ["picked", "equal", "half"].includes(view.model.css_classes[1]))
    return shown.map(view => {
        const [canvas, {left, top, right, bottom}] = [view.canvas_view.el.getBoundingClientRect(), view.frame.bbox]
        const [x0, y0, x1, y1] = [canvas.left + left, canvas.top + top, canvas.left + right, canvas.top + bottom]
        const covers = box => Math.min(box.right, x1) > Math.max(box.left, x0) + 1
            && Math.min(box.bottom, y1) > Math.max(box.top, y0) + 1
        const strips = [...Bokeh.index.all_views()].find(each => each.model.css_classes?.includes("strips"))
        const parts = [view, strips].flatMap(each => [...each.shadow_el.querySelectorAll("h2, .enlarge, .foot, .axis-name")])
        return parts.filter(part => covers(part.getBoundingClientRect())).map(part => part.className || part.tagName)
    })
}"""


@pytest.mark.parametrize(("page", "count"), [("wide", 4), ("middling", 4), ("phone", 1)])
def test_titles_legends_and_names_cover_no_picture(page: str, count: int, request: pytest.FixtureRequest) -> None:
    assert request.getfixturevalue(page).page.evaluate(_COVERED) == [[]] * count


def test_the_maps_do_not_move_when_an_orbit_is_clicked(wide: ExplorerPage) -> None:
    before = boxes(wide)
    wide.click("basins", 0.1, 0.05)
    expect(wide.text("Escapes through exit 1")).to_be_attached()
    wide.wait_for_data("paths", "data.xs.length == 1")
    assert boxes(wide) == before
    wide.return_home()
    wide.wait_for_data("starts", "data.x.length == 0")


def test_on_a_phone_the_map_comes_first_with_the_energy_below_it(phone: ExplorerPage) -> None:
    left, top, right, bottom = figures(phone)["basins"][:4]
    assert (left, right) == (0, 420)
    assert top < 112
    slider, play = phone.page.get_by_role("slider", name="Energy h").bounding_box(), phone.button("▶ Play").bounding_box()
    assert slider is not None
    assert play is not None
    assert bottom <= slider["y"] < bottom + 60
    assert slider["y"] + slider["height"] <= play["y"] <= slider["y"] + slider["height"] + 60


# Sum of the layout shifts since the page was opened.
_SHIFTS = """() => new Promise(done => {
    let sum = 0
    new PerformanceObserver(list => list.getEntries().forEach(entry => sum += entry.value)).observe({
        type: "layout-shift", buffered: true,
    })
    requestAnimationFrame(() => requestAnimationFrame(() => done(sum)))
})"""


@pytest.mark.parametrize(("width", "touch"), [(420, True), (1280, False)])
def test_the_parts_of_the_page_stay_in_their_places_while_it_opens(open_explorer: OpenExplorer, width: int, touch: bool) -> None:
    # Below this sum, browsers call the layout of a page stable.
    assert open_explorer(width, 900, QUICK, touch=touch).page.evaluate(_SHIFTS) < 0.1


def test_on_a_phone_the_rest_scrolls_over_the_map(phone: ExplorerPage) -> None:
    top = figures(phone)["basins"][1]
    phone.page.evaluate("window.scrollTo(0, 300)")
    assert figures(phone)["basins"][1] == top
    hint = phone.text("Click a map: the orbit").bounding_box()
    assert hint is not None
    above = phone.page.evaluate("([x, y]) => document.elementFromPoint(x, y).className", [hint["x"] + 5, hint["y"] + 5])
    assert "controls" not in above
    phone.page.evaluate("window.scrollTo(0, 0)")


def test_a_window_that_is_made_narrow_has_the_layout_of_a_phone(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(1280, 900, QUICK)
    explorer.page.set_viewport_size({"width": 420, "height": 900})
    explorer.pick(SHORT_TITLES["times"])
    explorer.page.wait_for_function(f"() => {{ const shown = ({_FIGURES})(); return shown.times && !shown.basins }}")


@pytest.fixture(params=[(932, 430), (860, 420), (640, 360)], ids=lambda size: f"{size[0]} × {size[1]}")
def turned(phone: ExplorerPage, request: pytest.FixtureRequest) -> Iterator[ExplorerPage]:
    """Yield the page on a phone that lies on its side, and turn the phone back."""
    width, height = request.param
    phone.page.set_viewport_size({"width": width, "height": height})
    phone.page.wait_for_function(f"() => ({_FIGURES})().basins[3] <= {height}")
    yield phone
    phone.page.set_viewport_size({"width": 420, "height": 900})
    phone.page.wait_for_function(f"() => ({_FIGURES})().basins[2] === 420")


def test_on_a_phone_on_its_side_the_picture_is_whole_and_stays_beside_the_other_parts(turned: ExplorerPage) -> None:
    before = figures(turned)["basins"]
    assert before[4] >= 0.5 * turned.page.evaluate("innerHeight")
    assert abs(before[4] - before[5]) <= 1
    expect(turned.page.locator(".foot[data-picture=basins]")).to_be_in_viewport(ratio=1)
    slider = turned.page.get_by_role("slider", name="Energy h").bounding_box()
    assert slider is not None
    assert slider["x"] >= before[2] - 8
    assert slider["y"] < before[1] + 60
    turned.page.evaluate("scrollTo(0, 300)")
    assert figures(turned)["basins"] == before
    turned.page.evaluate("scrollTo(0, 0)")


def test_on_a_phone_on_its_side_neither_messages_nor_drawers_cover_the_picture(turned: ExplorerPage) -> None:
    right = figures(turned)["basins"][2]
    assert turned.page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    turned.page.touchscreen.tap(*turned.point("basins", 0.1, 0.05))
    notice = turned.page.locator(".notice", has_text="Escapes through exit 1 at t")
    expect(notice).to_be_visible()
    turned.press("Share")
    drawer = turned.page.locator(".drawer")
    expect(drawer).to_be_visible()
    expect(turned.page.get_by_role("slider", name="Energy h")).to_be_in_viewport(ratio=1)
    for part in (notice, drawer):
        box = part.bounding_box()
        assert box is not None
        assert box["x"] >= right - 1
    turned.page.keyboard.press("Escape")
    notice.get_by_role("button", name="Close").click()
    turned.return_home()


@pytest.mark.parametrize("width", [420, 320])
def test_the_title_of_the_page_is_whole_on_a_phone(phone: ExplorerPage, width: int) -> None:
    phone.page.set_viewport_size({"width": width, "height": 900})
    for size in ("", "200%"):
        phone.page.evaluate("size => { document.documentElement.style.fontSize = size }", size)
        assert phone.page.locator("h1").evaluate("title => title.scrollWidth <= title.clientWidth + 1")
    phone.page.evaluate("document.documentElement.style.fontSize = ''")
    phone.page.set_viewport_size({"width": 420, "height": 900})


@pytest.mark.parametrize(("page", "width"), [("wide", 1600), ("middling", 1280), ("phone", 420)])
def test_pictures_are_square_and_nothing_is_wider_than_the_screen(page: str, width: int, request: pytest.FixtureRequest) -> None:
    explorer: ExplorerPage = request.getfixturevalue(page)
    shown = figures(explorer)
    assert all(abs(shown[name][4] - shown[name][5]) <= 1 for name in PICTURES if name in shown)
    assert explorer.page.evaluate("document.documentElement.scrollWidth") <= width
    x_low, x_high, low, high = explorer.ranges("basins")
    assert x_high - x_low == pytest.approx(high - low)


def test_nothing_is_wider_than_a_phone_at_twice_the_size_of_letters(phone: ExplorerPage) -> None:
    phone.page.evaluate("document.documentElement.style.fontSize = '200%'")
    expect(phone.button("▶ Play")).to_be_in_viewport(ratio=1)
    assert phone.page.evaluate("document.documentElement.scrollWidth") == 420
    assert phone.page.evaluate(_COVERED) == [[]]
    watch, enlarge = (phone.page.locator(f"{button}:visible").bounding_box() for button in (".watch", ".enlarge"))
    assert watch is not None
    assert enlarge is not None
    assert watch["x"] + watch["width"] <= enlarge["x"]
    phone.page.evaluate("document.documentElement.style.fontSize = ''")


def test_the_text_of_a_pixel_stands_beside_the_maps(wide: ExplorerPage) -> None:
    wide.hover("basins", 0.1, 0.05)
    tooltip = wide.page.locator(".bk-Tooltip").first
    expect(tooltip.get_by_text("escapes through exit 1")).to_be_visible()
    place = tooltip.bounding_box()
    assert place is not None
    assert place["x"] >= max(box[2] for box in boxes(wide))
    wide.page.mouse.move(5, 5)


def test_a_picture_has_a_frame_of_focus_for_keys_only(wide: ExplorerPage) -> None:
    width = """() => {
        let focused = document.activeElement
        while (focused.shadowRoot?.activeElement) focused = focused.shadowRoot.activeElement
        return getComputedStyle(focused).outlineWidth
    }"""
    wide.click("basins", 0.1, 0.05)
    assert wide.page.evaluate(width) == "0px"
    wide.page.keyboard.press("ArrowRight")
    assert wide.page.evaluate(width) == "1px"
    wide.wait_for_view("orbits=", "window=")
    wide.return_home()


def test_a_tap_on_a_phone_shows_where_and_when_the_orbit_ends_and_its_path(phone: ExplorerPage) -> None:
    phone.page.touchscreen.tap(*phone.point("basins", 0.1, 0.05))
    notice = phone.page.locator(".notice", has_text="Escapes through exit 1 at t")
    # The limiting curve, then the path.
    expect(notice.locator("polyline[stroke=currentColor]").first).to_be_attached()
    expect(notice.locator("polyline").last).not_to_have_attribute("stroke", "currentColor")
    notice.get_by_role("button", name="Close").click()
    expect(notice).to_be_hidden()
    phone.return_home()


@pytest.mark.slow
@pytest.mark.parametrize(("width", "touch"), [(1280, False), (420, True)])
def test_figures_do_not_overlap(open_explorer: OpenExplorer, width: int, touch: bool) -> None:
    explorer = open_explorer(width, 900, f"{QUICK}&orbits=0.1,0.05;0.2,0.1&origins=yes", touch=touch)
    explorer.wait_for_data("separation_source", "data.t.length > 1")
    assert_apart(explorer, {"sali", "r2", "exponent", "separation"}, width)
    explorer.pick("Statistics")
    expect(explorer.page.get_by_role("heading", name="Escapes after n crossings")).to_be_visible()
    assert_apart(explorer, set(), width)
    explorer.pick("Measures")
    explorer.wait_for_data("survival_lines", "data.xs.length && data.xs[0].length > 1")
    assert_apart(explorer, {"survival"}, width)


def assert_apart(explorer: ExplorerPage, names: set[str], width: int) -> None:
    """Check that figures are in view, do not overlap, and are not wider than the screen."""
    # On a phone the map stays while the sheet is scrolled over it.
    explorer.page.evaluate("scrollTo(0, 0)")
    shown = figures(explorer)
    assert names <= set(shown)
    assert not [pair for pair in itertools.combinations(shown, 2) if overlap(shown[pair[0]][:4], shown[pair[1]][:4])]
    assert explorer.page.evaluate("document.documentElement.scrollWidth") <= width


def legend(explorer: ExplorerPage, picture: str) -> dict[str, str]:
    """Return the colour of each item of the legend of a picture, by label."""
    return dict(explorer.page.locator(f".foot[data-picture={picture}]").evaluate(_LEGEND))


def test_the_legends_have_the_colours_of_the_palette(explorer: ExplorerPage) -> None:
    colours = PALETTES["paper"]
    explorer.choose("Colours", colours.name)
    explorer.wait_for_view("palette=paper")
    item = explorer.page.locator(".foot[data-picture=basins] .patch").first
    expect(item).to_have_attribute("style", f"--colour:{colours.channels[0]}")
    shown = legend(explorer, "basins")
    assert [shown[str(k)] for k in (1, 2)] == list(colours.channels[: CASES["I"].channels])
    assert shown["bounded"] == colours.bounded
    assert legend(explorer, "crossings") == {entry.short_label: entry.colour for entry in colours.crossing_entries}


def test_an_item_of_a_legend_lights_its_pixels(explorer: ExplorerPage) -> None:
    # The renderers of layers have other sources.
    renderers = "Bokeh.documents[0].get_model_by_name('basins').renderers"
    palette = f"() => {renderers}.find(each => each.data_source.name == 'maps').glyph.color_mapper.palette"
    explorer.start_engine()
    before = explorer.page.evaluate(palette)
    item = explorer.page.locator(".foot[data-picture=basins] .patch").first
    explorer.hover("basins", 0.0, 0.0)
    item.hover()
    lit = explorer.page.evaluate(palette)
    colour = DEFAULT_COLOURS.channels[0]
    assert [one for one in lit if len(one) == len(colour)] == [colour]
    explorer.page.mouse.move(5, 5)
    assert explorer.page.evaluate(palette) == before


def test_a_picture_fills_the_height_when_it_is_enlarged(middling: ExplorerPage) -> None:
    explorer = middling
    explorer.press(f"Enlarge, or show all: {TITLES['times']}")
    explorer.wait_for_view("focus=times")
    explorer.page.wait_for_function(f"() => ({_FIGURES})().times[4] > {0.65 * 720}")
    shown = figures(explorer)
    assert all(abs(frame[4] - frame[5]) <= 1 for frame in shown.values())
    assert max(frame[3] for frame in shown.values()) <= 720
    assert not [pair for pair in itertools.combinations(shown, 2) if overlap(shown[pair[0]][:4], shown[pair[1]][:4])]
    # A small picture is a button.
    explorer.press(f"Enlarge, or show all: {TITLE}")
    explorer.wait_for_view("focus=well")
    explorer.page.keyboard.press("2")
    explorer.wait_for_view("focus=basins")
    explorer.page.keyboard.press("Escape")
    explorer.page.wait_for_function(f"() => Math.max(...Object.values(({_FIGURES})()).map(frame => frame[4])) < {0.5 * 720}")
    assert "focus" not in explorer.page.url
    explorer.return_home()


def test_an_enlarged_picture_is_in_view_with_its_legend_below_the_lines_of_text(middling: ExplorerPage) -> None:
    explorer = middling
    explorer.page.set_viewport_size({"width": 1024, "height": 768})
    explorer.press(f"Enlarge, or show all: {TITLES['times']}")
    explorer.wait_for_view("focus=times")
    expect(explorer.page.locator(".foot.picked[data-picture=times]")).to_be_in_viewport(ratio=1)
    assert figures(explorer)["times"][4] > 0.5 * 768
    explorer.return_home()
    explorer.page.set_viewport_size({"width": 1280, "height": 720})


def help_text(explorer: ExplorerPage, name: str) -> Locator:
    return explorer.page.locator(f"#help-{name}")


def test_a_help_button_opens_its_text(explorer: ExplorerPage) -> None:
    for name in PICTURES:
        expect(help_text(explorer, name)).to_be_hidden()
        explorer.press(f"About: {TITLE if name == 'well' else PICTURE_ENTRIES[name].title_for(SPEC)}")
        expect(help_text(explorer, name)).to_be_visible()
        assert unescape(help_text(explorer, name).inner_html()) == unescape(typeset(escape(HELP_TEXTS[name])))
    # Opening one closes the others.
    expect(explorer.page.locator(".help-text:popover-open")).to_have_count(1)
    explorer.page.keyboard.press("Escape")
    expect(explorer.page.locator(".help-text:popover-open")).to_have_count(0)
