"""Each action is an entry of the browser's history. The browser and keys of the page move through the entries."""

from __future__ import annotations

from playwright.sync_api import expect

from tests.browser.explorer_page import ExplorerPage

HOME = "h=0.19&t_max=100&resolution=112"


def zoom(explorer: ExplorerPage) -> float:
    """Zoom in with the keyboard, and return the new width of the window."""
    width = explorer.column("dw")
    explorer.page.keyboard.press("+")
    explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] < 0.6 * {width}")
    return explorer.column("dw")


def test_keys_go_back_and_forward_and_the_whole_plane_is_offered_in_a_part_of_it(explorer: ExplorerPage) -> None:
    width, whole = explorer.column("dw"), explorer.button("Whole plane")
    expect(whole).to_be_hidden()
    once, twice = zoom(explorer), zoom(explorer)
    for key, expected in (("b", once), ("f", twice), ("h", width)):
        expect(whole).to_be_visible()
        explorer.page.keyboard.press(key)
        explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] == {expected}")
    expect(whole).to_be_hidden()


def test_the_browser_goes_back_over_each_kind_of_action(explorer: ExplorerPage) -> None:
    explorer.type_number("Exact h", "0.21")
    explorer.wait_for_view("h=0.21&")
    explorer.click("basins", 0.1, 0.05)
    explorer.wait_for_view("orbits=")
    explorer.pick("Statistics")
    explorer.wait_for_view("analysis=statistics")
    explorer.page.go_back()
    expect(explorer.radio("Orbit")).to_be_checked()
    explorer.page.go_back()
    explorer.wait_for_data("starts", "data.x.length == 0")
    explorer.page.go_back()
    expect(explorer.page.get_by_label("Exact h", exact=True)).to_have_value("0.19")
    explorer.wait_for_view(HOME)


def test_an_undone_action_can_be_repeated(explorer: ExplorerPage) -> None:
    for _ in range(2):
        explorer.pick("II")
        explorer.wait_for_view("case=II&")
        explorer.page.go_back()
        expect(explorer.radio("I")).to_be_checked()
        explorer.wait_for_view("case=I&")


def test_all_steps_of_the_wheel_are_one_entry(explorer: ExplorerPage) -> None:
    explorer.turn_wheel("basins", 0.1, 0.1, -100)
    for _ in range(2):
        explorer.page.mouse.wheel(0, -100)
    explorer.wait_for_address_of("basins")
    explorer.page.go_back()
    explorer.wait_for_view(HOME)
    expect(explorer.button("Whole plane")).to_be_hidden()


def test_a_move_at_the_moment_of_going_back_does_not_part_the_pictures_from_their_map(explorer: ExplorerPage) -> None:
    home, width = explorer.ranges("basins"), explorer.column("dw")
    zoom(explorer)
    # This handler moves the picture after the page's own handler has told the server, and before the server can answer.
    explorer.page.evaluate("""() => addEventListener("popstate", () => {
        const range = Bokeh.documents[0].get_model_by_name("basins").x_range
        range.setv({start: 0.1 * range.start, end: 0.1 * range.end})
    }, {once: true})""")
    explorer.page.go_back()
    explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] == {width}")
    expect(explorer.button("Whole plane")).to_be_hidden()
    assert explorer.ranges("basins") == home
