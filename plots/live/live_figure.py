"""Write a live figure: an HTML file with a map that the browser computes again while a reader changes energy and window."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import fields
from html import escape
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image

from engine import EscapeMap, Fate, MapSpec, compute_map
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from plots.browser.compiled_files import browser_kernels
from plots.browser.javascript import script_code
from plots.layers.picture import ShownMap
from plots.layers.table import PICTURES, map_legend
from plots.live.html_pages import fill_page
from plots.live.live_data import figure_data, png_address, text_of_bytes
from plots.live.live_view import LiveView
from plots.pictures.palette import DEFAULT_PALETTE, find_palette
from plots.pictures.provenance import provenance_line
from plots.printed.figure_files import map_figure_bytes
from plots.printed.figure_style import FigureFormat, FigureStyle
from plots.texts.legends import figure_legend, legend_items

STILL = FigureStyle(width=14.0, dpi=80.0, font_size=10.0)
"""Style of the picture for readers without scripts."""

_MODULES = Path(__file__).parents[1] / "browser" / "modules"


def live_figure(view: LiveView, found: EscapeMap) -> str:
    """Return the HTML of a live figure in one file, which needs no server and makes no request.

    Parameters
    ----------
    view
        The request.
    found
        The map of the request, complete.

    Raises
    ------
    ValueError
        If the map is not complete.
    """
    script = live_script()
    digest = text_of_bytes(hashlib.sha256(script.encode()).digest())
    place = {
        "policy": _policy(f"'sha256-{digest}'", "data:"),
        "script": f"<script>{script}</script>",
        "still": png_address(still_picture(view, found)),
        "back": "",
    }
    return _page(view, found, place, DEFAULT_EXECUTION)


def linked_live_figure(view: LiveView, found: EscapeMap, links: Mapping[str, str], execution: Execution) -> str:
    """Return the HTML of a live figure beside other files of its folder.

    Parameters
    ----------
    view, found
        As in `live_figure`.
    links
        Names of the files ``script``, with the `live_script`, and ``still``, with the `still_picture`, and the element ``back``
        above the figure.
    execution
        How the tables of the exits are computed.
    """
    script = f'<script src="{links["script"]}"></script>'
    place = {**links, "policy": _policy("'self'", "data: 'self'"), "script": script}
    return _page(view, found, place, execution)


def live_script() -> str:
    """Return the script of live figures, with the kernels, which are the same for all figures."""
    code = {
        "kernels": text_of_bytes(browser_kernels()),
        "worker": script_code(_MODULES / "workers" / "worker.js"),
    }
    return f'{script_code(_MODULES / "figure" / "live.js")}\nvoid modules["figure/live"].start({_inline(code)})\n'


def still_picture(view: LiveView, found: EscapeMap) -> bytes:
    """Return the picture for readers without scripts, as a PNG file with a table of colours; ValueError for an incomplete map."""
    found.check_complete("found")
    picture = map_figure_bytes(found, [view.picture], view.palette, FigureFormat.PNG, STILL, starts=view.starts)
    file = BytesIO()
    Image.open(BytesIO(picture)).convert("RGB").quantize(dither=Image.Dither.NONE).save(file, "png", optimize=True)
    return file.getvalue()


def to_live_html(shown: EscapeMap | MapSpec, *, palette: str = DEFAULT_PALETTE, **options: Any) -> str:
    """Return the HTML of a live figure, as described in `engine.maps.result.EscapeMap.to_html`."""
    legal = ("palette", *(each.name for each in fields(LiveView) if each.name not in {"spec", "palette"}))
    if unknown := [name for name in options if name not in legal]:
        raise TypeError(f"{unknown[0]}: no such option; a live figure has {', '.join(legal)}")
    spec = shown if isinstance(shown, MapSpec) else shown.spec
    view = LiveView(spec, palette=find_palette(palette), **options)
    return live_figure(view, compute_map(shown) if isinstance(shown, MapSpec) else shown)


def _policy(scripts: str, images: str) -> str:
    """Return the content-security policy of a page with the sources of its script and its images, and no other request."""
    return (
        f"default-src 'none'; script-src {scripts} 'wasm-unsafe-eval'; worker-src blob:; img-src {images}; "
        "style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
    )


def _page(view: LiveView, found: EscapeMap, place: Mapping[str, str], execution: Execution) -> str:
    """Return the HTML of a figure. `place` has the policy, the script, the address of the still picture and the way back."""
    data = figure_data(view, found, execution)
    spec, shown = view.spec, ShownMap.of(found, view.palette, {})
    lines = [escape(view.caption), f'<a href="{escape(view.link)}">Open in the explorer</a>' if view.link else ""]
    return fill_page(
        "live_figure", place, title=escape(view.heading),
        choices="".join(f'<option value="{name}">{escape(PICTURES[name].title)}</option>' for name in view.pictures),
        no_energy=" hidden" if spec.common_energy is None else "", low=data["low"], high=data["high"],
        energy=data["energy"], shown_energy=f"{data['energy']:.{data['decimals']}f}".replace("-", "−"),
        legends="".join(_legend(name, shown, hidden=name != view.picture) for name in view.pictures),
        caption=" ".join(filter(None, lines)), provenance=escape(provenance_line(found)), data=_inline(data),
    )  # fmt: skip


def _legend(name: str, shown: ShownMap, *, hidden: bool) -> str:
    legend = map_legend(name, shown)
    undecided = shown.palette.outcomes[Fate.NOT_COMPUTED]
    state = " hidden" if hidden else ""
    return f'<p class="foot" data-picture="{name}"{state}>{figure_legend(legend)}{legend_items([undecided])}</p>\n'


def _inline(data: Mapping[str, Any]) -> str:
    """Return data as JSON that is also JavaScript, without a sign that could end an element ``script``."""
    return json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")
