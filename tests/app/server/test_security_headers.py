"""What browsers are told not to do with the page."""

from __future__ import annotations

import re

from tornado.httputil import HTTPHeaders, HTTPServerRequest, RequestStartLine

from app.server.security_headers import SecurityTransform, content_policy, mark_scripts, security_headers


def directives(policy: str) -> dict[str, list[str]]:
    return {name: sources for name, *sources in (directive.split() for directive in policy.split("; "))}


def transform(kind: str, body: bytes) -> tuple[HTTPHeaders, bytes]:
    headers = HTTPHeaders({"Content-Type": kind, "Content-Length": str(len(body)), "Server": "Someone/1.0"})
    request = HTTPServerRequest(start_line=RequestStartLine("GET", "/", "HTTP/1.1"), headers=HTTPHeaders({"Host": "here"}))
    _, headers, body = SecurityTransform(request).transform_first_chunk(200, headers, body, finishing=True)
    return headers, body


def test_only_scripts_of_the_served_page_run() -> None:
    headers, body = transform("text/html; charset=UTF-8", b"<p></p><script>1</script><SCRIPT src='a'></script>")
    marks = set(re.findall(rb'<script nonce="([^"]+)"', body))
    assert len(marks) == 1
    scripts = directives(headers["Content-Security-Policy"])["script-src"]
    assert f"'nonce-{marks.pop().decode()}'" in scripts
    assert "'unsafe-inline'" not in scripts
    assert headers["Content-Length"] == str(len(body))


def test_a_nonce_is_used_once() -> None:
    assert transform("text/html", b"<script>")[1] != transform("text/html", b"<script>")[1]


def test_what_is_no_page_stays_as_it_is() -> None:
    body = b'{"a": "<script>"}'
    headers, sent = transform("application/json", body)
    assert sent == body
    assert "nonce" not in headers["Content-Security-Policy"]
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert "Server" not in headers


def test_a_word_that_begins_like_script_is_not_marked() -> None:
    assert mark_scripts(b"<scripture>", "n") == b"<scripture>"


def test_nobody_frames_the_page_unless_named() -> None:
    assert security_headers(())["X-Frame-Options"] == "DENY"
    assert directives(content_policy(()))["frame-ancestors"] == ["'none'"]
    named = security_headers(("https://a.example",))
    assert "X-Frame-Options" not in named
    assert directives(named["Content-Security-Policy"])["frame-ancestors"] == ["https://a.example"]
