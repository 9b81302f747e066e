"""Without a connection the page cannot be used, and it returns with its view when the server answers."""

from __future__ import annotations

from collections.abc import Callable
from threading import Event

from playwright.sync_api import Route, WebSocketRoute, expect

from app.views.components.notice import CONNECTION_LOST
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage


def test_a_page_without_a_connection_is_inert_and_returns_when_the_server_answers(
    open_explorer: Callable[..., ExplorerPage],
) -> None:
    explorer, connections, is_back = open_explorer(link=QUICK), [], Event()
    page = explorer.page

    def connect(connection: WebSocketRoute) -> None:
        connection.connect_to_server()
        connections.append(connection)

    def answer(route: Route) -> None:
        route.continue_() if route.request.method != "HEAD" or is_back.is_set() else route.fulfill(status=503)

    page.route_web_socket("**/ws*", connect)
    page.route("**/*.js*", answer)
    page.reload()
    explorer.wait_until_complete()
    connections[0].close()
    # Everything outside a modal dialog is inert.
    dialog = page.locator("dialog:modal", has_text=CONNECTION_LOST)
    expect(dialog).to_be_visible()
    page.keyboard.press("Escape")
    expect(dialog).to_be_visible()
    is_back.set()
    explorer.page.wait_for_function("document.querySelector('dialog') === null")
    explorer.wait_until_complete()
    assert len(connections) > 1
    explorer.take_problems()
