"""What follows from a change of a widget comes together, after it."""

from __future__ import annotations

from typing import Any

import panel as pn
import pytest
from bokeh.document import Document
from panel.reactive import Syncable

from app.bokeh_patches.held_changes import hold_changes


@pytest.mark.parametrize("held", [False, True])
def test_changes_that_follow_are_held_until_the_change_is_over(held: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Syncable, "_change_event", Syncable._change_event)
    if held:
        hold_changes()
    document, widget, seen = Document(), pn.widgets.FloatSlider(start=0.0, end=1.0), list[Any]()
    widget.param.watch(lambda event: seen.append((event.new, document.callbacks.hold_value)), "value")
    widget._events = {"value": 0.5}
    widget._change_event(document)
    assert seen == [(0.5, "combine" if held else None)]
    assert document.callbacks.hold_value is None
