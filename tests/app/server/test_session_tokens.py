"""Signed tokens contain the parameters of the link, and other tokens are refused without being inflated."""

from __future__ import annotations

import base64
import json
import random
import time
import tracemalloc
import zlib

import pytest
from bokeh.application import Application
from bokeh.server.tornado import BokehTornado
from bokeh.util.token import generate_jwt_token, generate_session_id, get_token_payload
from tornado.httputil import HTTPHeaders, HTTPServerRequest, RequestStartLine

from app.server.admission import LONGEST_LINK
from app.server.limited_http_server import LIMITS
from app.server.session_tokens import has_signed_token, issue_token, may_begin_session, use_token
from tests.app.server.login import server_with_login

OTHER_KEY = b"the key of another server, long enough"
INFLATED = 2**24


@pytest.fixture
def application() -> BokehTornado:
    return BokehTornado({"/app": Application()})


def request(uri: str = "/app", **headers: str) -> HTTPServerRequest:
    named = {name.replace("_", "-"): text for name, text in headers.items()}
    every = HTTPHeaders({"Host": "localhost", **named})
    return HTTPServerRequest(start_line=RequestStartLine("GET", uri, "HTTP/1.1"), headers=every)


def socket_request(token: str) -> HTTPServerRequest:
    return request("/app/ws", Sec_WebSocket_Protocol=f"bokeh, {token}")


def bomb(expires: int = 2**40) -> str:
    """Return a token that is not signed and needs much memory when it is inflated."""
    payload = {"session_id": "x" * 44, "session_expiry": expires, "__bk__zlib_": _encode(zlib.compress(b"0" * INFLATED))}
    return _encode(json.dumps(payload).encode())


def _encode(raw: bytes) -> str:
    return base64.urlsafe_b64encode(raw).decode().rstrip("=")


def test_token_is_signed_with_the_key_of_bokeh_if_there_is_one(application: BokehTornado) -> None:
    signed = BokehTornado({"/app": Application()}, secret_key=OTHER_KEY, sign_sessions=True)
    token = issue_token(signed, request(), {})
    assert has_signed_token(signed, socket_request(token))
    assert not has_signed_token(application, socket_request(token))


@pytest.mark.parametrize(
    "token",
    [
        bomb(),
        bomb(expires=0),
        bomb() + ".signature",
        bomb() + ".é",
        generate_jwt_token(generate_session_id(OTHER_KEY, signed=True), OTHER_KEY, signed=True),
        "",
        "x",
        "token.signature",
        _encode(b"[" * 12_000) + ".x",
        _encode(b"5") + ".x",
        _encode(b"{}") + ".x",
    ],
    ids=["bomb", "expired", "wrong signature", "not ASCII", "other key", "empty", "short", "no JSON", "deep", "number", "no id"],
)
def test_other_tokens_are_refused_and_not_inflated(token: str, application: BokehTornado) -> None:
    asked = socket_request(token)
    tracemalloc.start()
    try:
        assert not has_signed_token(application, asked)
        assert tracemalloc.get_traced_memory()[1] < INFLATED / 10
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("offered", [None, "bokeh", "{}", "{}, bokeh", "bokeh, {}, more"])
def test_tokens_in_other_places_are_refused(offered: str | None, application: BokehTornado) -> None:
    token = issue_token(application, request(), {})
    headers = {} if offered is None else {"Sec_WebSocket_Protocol": offered.format(token)}
    assert not has_signed_token(application, request("/app/ws", **headers))


def test_token_contains_the_parameters_of_the_link_and_the_names_of_few_others(application: BokehTornado) -> None:
    others = "theme=dark&bytes=1&c=2&d=3&bokeh-absolute-url=x"
    asked = request(f"/app?{'n' * 200}=1&h=0.2&h=0.3&{others}", Cookie="a=b", User_Agent="browser")
    payload = get_token_payload(issue_token(application, asked, {"app_path": "/app"}))
    del payload["session_expiry"], payload["issued"]
    arguments = {"h": [b"0.2"], "theme": [b""], "bytes": [b""], "c": [b""]}
    assert payload == {"headers": {}, "cookies": {}, "arguments": arguments, "app_path": "/app"}


@pytest.mark.parametrize(("age", "fresh"), [(0.0, True), (299.0, True), (300.0, False), (-1.0, False)])
def test_a_token_may_begin_a_session_for_a_limited_time_of_the_monotonic_clock(
    age: float, fresh: bool, application: BokehTornado, monkeypatch: pytest.MonkeyPatch
) -> None:
    token = issue_token(application, request(), {}, clock=lambda: 50.0)
    # The wall clock has no effect.
    monkeypatch.setattr(time, "time", lambda: 2.0**33)
    assert may_begin_session(application, token, clock=lambda: 50.0 + age) == fresh


def test_a_token_without_its_time_begins_no_session(application: BokehTornado) -> None:
    assert not may_begin_session(application, generate_jwt_token(generate_session_id()))


def test_cookies_are_in_the_token_if_there_is_a_login() -> None:
    assert get_token_payload(issue_token(server_with_login(), request(Cookie="user=me"), {}))["cookies"] == {"user": "me"}


def test_the_longest_link_fits_into_the_headers_of_the_websocket(application: BokehTornado) -> None:
    # Random digits compress badly.
    uri = ("/app?V=" + base64.urlsafe_b64encode(random.Random(1).randbytes(LONGEST_LINK)).decode())[:LONGEST_LINK]
    token = issue_token(application, request(uri), {})
    # The other headers of a browser, with cookies, have up to 8 kB.
    assert len(uri) + len(token) + 8192 < LIMITS["max_header_size"]
    # deploy/nginx.conf has a buffer of 16 kB for one header.
    assert len(token) < 16_000


def test_bokeh_takes_the_token_of_the_server_and_not_that_of_the_client(application: BokehTornado) -> None:
    asked = request("/app?bokeh-token=mine&bokeh-session-id=%ff")
    use_token(asked, "issued")
    assert asked.arguments == {"bokeh-token": [b"issued"]}
