"""Pages have security headers and a nonce."""

from __future__ import annotations

from app.server.security_headers import add_nonce, content_policy, security_headers


def directives(policy: str) -> dict[str, list[str]]:
    return {name: sources for name, *sources in (directive.split() for directive in policy.split("; "))}


def test_inline_scripts_need_the_nonce() -> None:
    page = add_nonce("<p></p><script>1</script><SCRIPT src='a'></script>", "n")
    assert page == '<p></p><script nonce="n">1</script><script nonce="n" src=\'a\'></script>'
    scripts = directives(content_policy((), "n"))["script-src"]
    assert "'nonce-n'" in scripts
    assert "'unsafe-inline'" not in scripts


def test_responses_without_nonce_allow_no_inline_script() -> None:
    assert not any("nonce" in source for source in directives(content_policy(()))["script-src"])


def test_workers_are_files_of_this_server() -> None:
    assert directives(content_policy(()))["worker-src"] == ["'self'"]


def test_other_elements_get_no_nonce() -> None:
    assert add_nonce("<scripture>", "n") == "<scripture>"


def test_page_cannot_be_embedded_unless_allowed() -> None:
    assert security_headers(())["X-Frame-Options"] == "DENY"
    assert directives(content_policy(()))["frame-ancestors"] == ["'none'"]
    named = security_headers(("https://a.example",))
    assert "X-Frame-Options" not in named
    assert directives(named["Content-Security-Policy"])["frame-ancestors"] == ["https://a.example"]
