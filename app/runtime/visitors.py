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
    return address if parsed.version == 4 else str(ipaddress.ip_network((parsed, 64), strict=False))


def account_of(document: Document) -> str | None:
    """Whose share of compiled code a page takes: that of its network; no one's on this machine, which has one visitor."""
    address = str(getattr(getattr(document.session_context, "request", None), "remote_ip", ""))
    try:
        is_near = ipaddress.ip_address(address).is_loopback
    except ValueError:
        is_near = True
    return None if is_near else network_of(address)
