"""All that follows from a change of a widget is held back until it is over, and then sent.

Panel calls back without the session's lock, and Bokeh refuses changes of its models without it, unless they are held: a click
while the time of an orbit plays would be lost with an error.
"""

from __future__ import annotations

from typing import Any

from bokeh.document import Document
from panel.io.document import hold
from panel.io.state import set_curdoc
from panel.reactive import Syncable

from app.bokeh_patches.own_ways import put_in_place

_their_change: Any = getattr(Syncable, "_change_event", None)


def hold_changes() -> None:
    """From now on, in this process."""
    put_in_place(Syncable, "_change_event", change)


def change(widget: Any, document: Document) -> None:
    """Take what a visitor has changed on a widget, with all that follows from it."""
    with set_curdoc(document), hold(document):
        _their_change(widget, document)
