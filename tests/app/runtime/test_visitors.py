"""Visitors of one IPv6 network share a limit, and this machine has none."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from bokeh.document import Document

from app.runtime.visitors import account_of, network_of


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("192.0.2.1", "192.0.2.2", False),
        ("2001:db8::1", "2001:db8::ffff:1", True),
        ("2001:db8::1", "2001:db8:0:1::1", False),
        ("socket", "socket", True),
    ],
)
def test_addresses_of_an_ipv6_network_are_one(one: str, other: str, same: bool) -> None:
    assert (network_of(one) == network_of(other)) is same


@pytest.mark.parametrize(
    ("address", "account"),
    [("192.0.2.1", "192.0.2.1"), ("2001:db8::1", "2001:db8::/64"), ("127.0.0.1", None), ("::1", None), ("socket", None)],
)
def test_pages_of_this_machine_have_no_account(address: str, account: str | None) -> None:
    context = SimpleNamespace(request=SimpleNamespace(remote_ip=address))
    assert account_of(SimpleNamespace(session_context=context)) == account  # type: ignore[arg-type]


def test_a_document_without_a_session_has_no_account() -> None:
    assert account_of(Document()) is None
