"""Who a visitor is for the limits: an address, or a network."""

from __future__ import annotations

import ipaddress

from bokeh.document import Document


def network_of(address: str) -> str:
    """Return what is limited together: an IPv4 address, or the 64 bits of an IPv6 address that belong to a network."""
    try:
        parsed = ipaddress.ip_address(address)
    except ValueError:
        return address
    return address if parsed.version == 4 or parsed.is_loopback else str(ipaddress.ip_network((parsed, 64), strict=False))


def is_near(network: str) -> bool:
    """Whether it is this machine, which has one visitor."""
    try:
        return ipaddress.ip_network(network).is_loopback
    except ValueError:
        return True


def visitor_of(document: Document) -> str:
    """The network of a page; empty in a notebook."""
    return network_of(str(getattr(getattr(document.session_context, "request", None), "remote_ip", "")))


def account_of(document: Document) -> str | None:
    """Whose share of compiled code a page takes: that of its visitor; no one's on this machine."""
    visitor = visitor_of(document)
    return None if is_near(visitor) else visitor
