"""Bokeh's web application, which its hooks are not told of."""

from __future__ import annotations

import gc
from typing import Any

from bokeh.server.tornado import BokehTornado


def find_web_application(server_context: Any) -> BokehTornado:
    """The web application that serves what a `server_context` belongs to.

    Bokeh hands its hooks the context alone, which knows the application's sessions and no way up; so it is looked for among
    the objects of this process, once.

    Raises
    ------
    LookupError
        When nothing serves it.
    """
    context = server_context.application_context
    for candidate in gc.get_objects():
        # By its type, as a question to the object may wake what is loaded only when it is used.
        if type(candidate) is BokehTornado and context in candidate.applications.values():
            return candidate
    raise LookupError("no web application serves this context")
