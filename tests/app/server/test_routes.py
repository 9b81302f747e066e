"""Mounted routes are documented and served."""

from __future__ import annotations

import re

import pytest
from bokeh.application import Application
from bokeh.server.tornado import BokehTornado

from app.server.routes import accepted_hosts, served_routes
from tests.app.server.login import server_with_login
from tests.app.server.mounted_routes import ROOT, mounted_routes


@pytest.fixture(scope="module")
def mounted() -> list[str]:
    """Return the patterns of the routes of the real application, in order."""
    return mounted_routes()


@pytest.fixture
def application() -> BokehTornado:
    """Return an application at /app below the prefix /maps."""
    return BokehTornado({"/app": Application()}, prefix="/maps")


def documented() -> list[str]:
    table = (ROOT / "docs" / "operation.md").read_text()
    return re.findall(r"^\| `(/[^`]*)` \|", table, re.MULTILINE)


def test_all_mounted_routes_are_documented(mounted: list[str]) -> None:
    # The addresses of modules contain a hash. The first two patterns refuse hosts and other routes.
    routes = [re.sub(r"/browser/[0-9a-f]+/", "/browser/…/", route) for route in mounted[2:]]
    assert list(dict.fromkeys(routes)) == documented()


def accepts(application: BokehTornado, host: str) -> bool:
    return re.fullmatch(accepted_hosts(application), host) is not None


@pytest.mark.parametrize(
    ("origin", "accepted", "refused"),
    [
        ("maps.example.org:443", "maps.example.org", "mapsxexample.org"),
        ("Maps.example.org", "maps.example.org", "example.org"),
        ("*.example.org:*", "maps.example.org", "old.maps.example.org"),
        ("*", "elsewhere.example", None),
    ],
)
def test_hosts_whose_pages_may_open_a_websocket_are_accepted(origin: str, accepted: str, refused: str | None) -> None:
    application = BokehTornado({"/app": Application()}, extra_websocket_origins=[origin])
    assert accepts(application, accepted)
    assert refused is None or not accepts(application, refused)


def test_served_routes_have_the_prefix_of_the_server(application: BokehTornado) -> None:
    routes = served_routes(application)
    assert {"/maps/app", "/maps/app/ws", "/maps/metrics"} <= set(routes)
    assert "/app" not in routes


def test_routes_of_a_login_are_served() -> None:
    assert "/maps/login" in served_routes(server_with_login("/maps"))
