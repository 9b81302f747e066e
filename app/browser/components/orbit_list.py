"""The list of orbits, by number.

Bokeh's radio buttons fail if the chosen button changes while their view is being built, as when a click opens the tab.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import param
from panel.custom import JSComponent


class OrbitList(JSComponent):
    """Radio buttons in a line, in the colours of the orbits. The CSS variables --orbit-1, --orbit-2, … define these colours.

    Parameters
    ----------
    on_choose
        Takes the place of the chosen orbit, without the session's lock.
    **options
        Parameters of the component.
    """

    label = param.String(default="Orbits")
    rows = param.List(item_type=str, doc="text that describes each orbit, as a tooltip and for screen readers")
    chosen = param.Integer(default=0, bounds=(0, None), doc="place of the chosen orbit")

    _esm = Path(__file__).with_suffix(".js")

    def __init__(self, on_choose: Callable[[int], None], **options: Any) -> None:
        super().__init__(margin=0, css_classes=["orbit-list"], **options)
        self._on_choose = on_choose
        self.on_msg(lambda event: self._receive(event.data))

    def _receive(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"chosen": int(place)} if not isinstance(place, bool) and 0 <= place < len(self.rows):
                self._on_choose(place)
