"""Each action is an entry of the browser's history, which the page's own buttons and keys use, too."""

from __future__ import annotations

from playwright.sync_api import expect

from tests.browser.explorer_page import ExplorerPage

HOME = "h=0.19&t_max=100&resolution=112"


def zoom(explorer: ExplorerPage) -> float:
    """Zoom in with the keyboard; the width of the window."""
    width = explorer.column("dw")
    explorer.page.keyboard.press("+")
    explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] < 0.6 * {width}")
    return explorer.column("dw")


def expect_buttons(explorer: ExplorerPage, *shown: str) -> None:
    for label in ("← Back", "Forward →", "Whole plane"):
        expect(explorer.button(label)).to_be_visible(visible=label in shown)


def test_buttons_are_shown_while_they_lead_somewhere(explorer: ExplorerPage) -> None:
    width = explorer.column("dw")
    expect_buttons(explorer)
    zoom(explorer)
    expect_buttons(explorer, "← Back", "Whole plane")
    explorer.press("← Back")
    expect_buttons(explorer, "Forward →")
    explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] == {width}")
    explorer.press("Forward →")
    expect_buttons(explorer, "← Back", "Whole plane")
    explorer.press("Whole plane")
    expect_buttons(explorer, "← Back")
    explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] == {width}")


def test_keys_go_back_forward_and_home(explorer: ExplorerPage) -> None:
    width = explorer.column("dw")
    once = zoom(explorer)
    twice = zoom(explorer)
    for key, expected in (("b", once), ("f", twice), ("h", width)):
        explorer.page.keyboard.press(key)
        explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] == {expected}")


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


def test_an_action_can_be_repeated_after_it_was_undone(explorer: ExplorerPage) -> None:
    for _ in range(2):
        explorer.pick("II")
        explorer.wait_for_view("case=II&")
        explorer.press("← Back")
        explorer.wait_for_view("case=I&")
        expect(explorer.button("← Back")).to_be_hidden()


def test_all_steps_of_the_wheel_are_one_entry(explorer: ExplorerPage) -> None:
    explorer.turn_wheel("basins", 0.1, 0.1, -100)
    for _ in range(2):
        explorer.page.mouse.wheel(0, -100)
    explorer.wait_for_view("window=")
    explorer.press("← Back")
    expect_buttons(explorer, "Forward →")
