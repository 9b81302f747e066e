"""Write a live figure: an HTML file with a map that the browser computes again while a reader changes energy and window."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from html import escape
from pathlib import Path
from string import Template
from typing import Any

from engine import CASES, EscapeMap, Fate, MapSpec, compute_map
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.integrator.portable_kernels import kernel_module
from plots.browser.javascript import script_code
from plots.layers.picture import ShownMap
from plots.layers.table import PICTURES, map_legend
from plots.live.live_data import figure_data, png_address, text_of_bytes
from plots.live.live_view import LiveView
from plots.pictures.palette import find_palette
from plots.pictures.provenance import program_version, provenance_line
from plots.printed.figure_files import map_figure_bytes
from plots.printed.figure_style import FigureFormat, FigureStyle
from plots.texts.legends import figure_legend, legend_items

_PAGE = Path(__file__).with_suffix(".html")
_MODULES = Path(__file__).parents[1] / "browser" / "modules"
_CITATION = "Computed with Escape Explorer, which implements the system of Zotos (2014), Nonlinear Dynamics 78, 1389."
# The picture for readers without scripts.
_STILL = FigureStyle(width=14.0, dpi=80.0, font_size=10.0)


def live_figure(view: LiveView, found: EscapeMap, execution: Execution = DEFAULT_EXECUTION) -> str:
    """Return the HTML of a live figure, which needs no server and makes no request.

    Parameters
    ----------
    view
        The request.
    found
        The map of the request, complete.
    execution
        How the tables of the exits are computed.

    Raises
    ------
    ValueError
        If the map is not complete.
    """
    found.check_complete("found")
    script = live_script()
    digest = text_of_bytes(hashlib.sha256(script.encode()).digest())
    parts = {
        "scripts": f"'sha256-{digest}'",
        "images": "",
        "script": f"<script>{script}</script>",
        "still": png_address(still_picture(view, found)),
    }
    return _page(view, found, parts, execution)


def live_script() -> str:
    """Return the script of live figures, with the kernels, which are the same for all figures."""
    code = {
        "kernels": text_of_bytes(kernel_module()),
        "worker": script_code(_MODULES / "workers" / "worker.js"),
    }
    return f'{script_code(_MODULES / "figure" / "live.js")}\nvoid modules["figure/live"].start({_inline(code)})\n'


def still_picture(view: LiveView, found: EscapeMap) -> bytes:
    """Return the picture for readers without scripts, as a PNG file."""
    return map_figure_bytes(found, [view.picture], view.palette, FigureFormat.PNG, _STILL, starts=view.starts)


def to_live_html(shown: EscapeMap | MapSpec, *, palette: str = "paper", **options: Any) -> str:
    """Return the HTML of a live figure, as described in `engine.maps.result.EscapeMap.to_html`."""
    spec = shown if isinstance(shown, MapSpec) else shown.spec
    view = LiveView(spec, palette=find_palette(palette), **options)
    return live_figure(view, compute_map(shown) if isinstance(shown, MapSpec) else shown)


def _page(view: LiveView, found: EscapeMap, parts: Mapping[str, str], execution: Execution) -> str:
    """Return the HTML of a figure.

    Parameters
    ----------
    view, found, execution
        As in `live_figure`.
    parts
        Where the page finds its parts: the element ``script``, the address ``still`` of the picture for readers without scripts,
        and the sources ``scripts`` and ``images`` that its policy allows besides data addresses.
    """
    data = figure_data(view, found, execution)
    spec, shown = view.spec, ShownMap.of(found, view.palette, {})
    lines = [escape(view.caption), f'<a href="{escape(view.link)}">Open in the explorer</a>' if view.link else ""]
    return Template(_PAGE.read_text(encoding="utf-8")).substitute(
        parts, generator=program_version(), title=escape(view_title(spec)),
        choices="".join(f'<option value="{name}">{escape(PICTURES[name].title)}</option>' for name in view.pictures),
        no_energy=" hidden" if spec.common_energy is None else "", low=data["low"], high=data["high"],
        energy=data["energy"], shown_energy=f"{data['energy']:.{data['decimals']}f}",
        legends="".join(_legend(name, shown, hidden=name != view.picture) for name in view.pictures),
        caption=" ".join(filter(None, lines)), provenance=escape(provenance_line(found)), citation=_CITATION, data=_inline(data),
    )  # fmt: skip


def view_title(spec: MapSpec) -> str:
    """Return the title of a figure."""
    name = spec.potential.name
    return f"{'Case ' if name in CASES else ''}{name}, {spec.plane.title}{', backward in time' if spec.backward else ''}"


def _legend(name: str, shown: ShownMap, *, hidden: bool) -> str:
    legend = map_legend(name, shown)
    undecided = shown.palette.outcomes[Fate.NOT_COMPUTED]
    state = " hidden" if hidden else ""
    return f'<p class="foot" data-picture="{name}"{state}>{figure_legend(legend)}{legend_items([undecided])}</p>\n'


def _inline(data: Mapping[str, Any]) -> str:
    """Return data as JSON that is also JavaScript, without a sign that could end an element ``script``."""
    return json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")
