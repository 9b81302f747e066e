"""The absolute address of a page, for programs and pages elsewhere."""

from __future__ import annotations

from typing import Any


def page_address(request: Any) -> str:
    """The address of the page that a request asks for, without parameters.

    Host and scheme are those of the request, or with ``--use-xheaders`` those that the proxy states.
    """
    return f"{request.protocol}://{request.host}{request.path}"
