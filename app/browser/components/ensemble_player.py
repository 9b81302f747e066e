"""The player of many orbits. The visitor's browser draws the starts, integrates the orbits and paints them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import param
from panel.custom import JSComponent

from app.browser.module_files import WATCH_ADDRESS
from app.state.watched_starts import COUNTS, EXPLANATIONS, LARGEST_RADIUS, SMALLEST_RADIUS

_STYLE = """
:host { display: block; color: var(--ui-ink) }
.row { display: flex; flex-wrap: wrap; gap: 6px; align-items: center; margin: 6px 0 }
[hidden] { display: none !important }
button.play { min-width: 11.5rem; font-weight: 600 }
select.bk-input { appearance: none; padding-right: 28px; border: 1px solid var(--ui-edge); border-radius: var(--ui-radius);
  background-color: var(--ui-surface); background-repeat: no-repeat; color: inherit; font: inherit }
label { display: inline-flex; align-items: center; gap: 6px; color: inherit; font-size: inherit }
input[type=range] { flex: 1 1 8rem; min-width: 6rem }
output { min-width: 4.5rem; font-variant-numeric: tabular-nums }
.quiet { color: var(--ui-quiet); margin: 6px 0; min-height: 2lh }
table { border-spacing: 8px 2px; margin: 0 0 0 -8px; font-variant-numeric: tabular-nums }
tr { display: flex; flex-wrap: wrap; gap: 4px 14px }
td { padding-left: 1em; position: relative }
td::before { content: ""; position: absolute; left: 0; top: 0.3em; width: 0.7em; height: 0.7em; border-radius: 2px;
  background: var(--colour, var(--ui-quiet)) }
.survival { display: block; width: 100%; height: 170px; margin-top: 6px }
"""


class EnsemblePlayer(JSComponent):
    """Controls, counters and a chart. The browser sends {where, count, seed, radius} for each choice of starts.

    Parameters
    ----------
    on_choice
        Takes the choice in this form.
    """

    address = param.String(default=WATCH_ADDRESS, doc="address of the module")
    counts = param.List(default=list(COUNTS), doc="numbers of orbits to choose from")
    radii = param.List(default=[SMALLEST_RADIUS, LARGEST_RADIUS], doc="least and largest radius, as powers of ten")
    places = param.Dict(default={}, doc="phrase of each place of starts in the system")
    explanations = param.Dict(default={str(where): sentence for where, sentence in EXPLANATIONS.items()}, doc="of places")
    where = param.String(doc="see `WatchedStarts`")
    count = param.Integer()
    seed = param.Integer()
    radius = param.Number()
    point = param.List(default=[], doc="abscissa and ordinate of the chosen start; empty without one")
    box = param.List(default=[], doc="the four edges of the box; empty without one")
    rate = param.Number(default=0.0, doc="decay rate of mixed motion; 0 if it is not known")

    _esm = Path(__file__).with_suffix(".js")

    def __init__(self, on_choice: Callable[[Any], None], **options: Any) -> None:
        super().__init__(sizing_mode="stretch_width", margin=(0, 10), stylesheets=[_STYLE], **options)
        self.on_msg(lambda event: on_choice(event.data))
