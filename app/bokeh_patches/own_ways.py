"""Places of Bokeh's, and of Panel's above it, where this server has a way of its own, and they no public place for one."""

from __future__ import annotations

import logging
from typing import Any

log = logging.getLogger(__name__)


def put_in_place(owner: Any, name: str, ours: Any) -> None:
    """Put ours in the place of Bokeh's; in a version without that place everything works as Bokeh has it, and the log says so.

    Parameters
    ----------
    owner
        The module or class that has it.
    name
        What it is called there.
    ours
        What takes its place.
    """
    if hasattr(owner, name):
        setattr(owner, name, ours)
    else:
        log.warning("this version of Bokeh has no %s.%s: what it did better here it does in Bokeh's way", owner.__name__, name)
