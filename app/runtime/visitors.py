"""Identification of visitors for limits, by the networks of their addresses."""

from __future__ import annotations

import ipaddress

from bokeh.document import Document


def network_of(address: str) -> str:
    """Return the network of an address: an IPv4 address itself, or the network of the first 64 bits of an IPv6 address."""
    try:
        parsed = ipaddress.ip_address(address)
    except ValueError:
        return address
    return address if parsed.version == 4 or parsed.is_loopback else str(ipaddress.ip_network((parsed, 64), strict=False))


def is_local(network: str) -> bool:
    """Whether a network is this machine, or is no network, as in a notebook."""
    try:
        return ipaddress.ip_network(network).is_loopback
    except ValueError:
        return True


def visitor_of(document: Document) -> str:
    """Return the network of the visitor of a page; empty in a notebook."""
    return network_of(str(getattr(getattr(document.session_context, "request", None), "remote_ip", "")))


def account_of(document: Document) -> str | None:
    """Return the visitor to whose limit of compiled code a page counts; None for this machine, which has no limit."""
    visitor = visitor_of(document)
    return None if is_local(visitor) else visitor
