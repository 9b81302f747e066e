"""The routes that are mounted, documented and served."""

from __future__ import annotations

import re

import pytest
from bokeh.application import Application
from bokeh.server.tornado import BokehTornado

from app.server.routes import LOOPBACK, accepted_hosts, served_routes
from tests.app.server.mounted_routes import ROOT, mounted_routes


@pytest.fixture(scope="module")
def mounted() -> list[str]:
    """Patterns of the routes of the real application, in order."""
    return mounted_routes()


@pytest.fixture
def application() -> BokehTornado:
    """An application at /app below the prefix /maps."""
    return BokehTornado({"/app": Application()}, prefix="/maps")


def documented() -> list[str]:
    table = (ROOT / "docs" / "routes.md").read_text()
    return re.findall(r"^\| `(/[^`]*)` \|", table, re.MULTILINE)


def test_all_mounted_routes_are_documented(mounted: list[str]) -> None:
    # The addresses of modules contain a hash.
    assert [re.sub(r"/browser/[0-9a-f]+/", "/browser/…/", route) for route in mounted[2:]] == documented()


def test_other_routes_are_refused_first(mounted: list[str]) -> None:
    refused = re.compile(mounted[0])
    paths = {
        "/components/unittest.__main__/x/_css/x",
        "/app/autoload.js",
        "/app/metadata",
        "/app/",
        "/nothing",
        "*",
        "//app",
        "/static/%00",
    }
    assert {path for path in paths if refused.fullmatch(path)} == paths


@pytest.mark.parametrize("path", ["/app", "/app/ws", "/", "/static/js/bokeh.min.js", "/app/static/theme.css", "/metrics"])
def test_routes_of_the_page_and_the_operator_are_served(mounted: list[str], path: str) -> None:
    assert not re.fullmatch(mounted[0], path)


def accepts(application: BokehTornado, host: str) -> bool:
    return re.fullmatch(accepted_hosts(application), host) is not None


@pytest.mark.parametrize("host", LOOPBACK)
def test_the_hosts_of_this_machine_are_accepted(host: str, application: BokehTornado) -> None:
    assert accepts(application, host)
    assert not accepts(application, "elsewhere.example")


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


def test_routes_of_a_login_are_served(application: BokehTornado, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(type(application.auth_provider), "endpoints", [("/login", object)])
    assert "/maps/login" in served_routes(application)
