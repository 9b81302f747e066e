"""Write a live figure: one HTML file with a map that the browser computes again while a reader changes energy and window."""

from __future__ import annotations

import base64
import hashlib
import json
import math
from collections.abc import Sequence
from html import escape
from io import BytesIO
from pathlib import Path
from string import Template
from typing import Any

import numpy as np
from PIL import Image

from engine import CASES, EscapeMap, Fate, MapSpec
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.foundations.validation import checked_number
from engine.foundations.wording import format_number
from engine.systems.review.potential_review import review_potential
from plots.browser.browser_system import describe_slice, make_browser_system, slice_name, window_in_browser
from plots.browser.compiled_files import browser_kernels
from plots.browser.javascript import script_code
from plots.layers.map_images import picture_pixels
from plots.layers.picture import ShownMap
from plots.layers.table import PICTURES, map_legend
from plots.pictures.image_columns import pixel_coding
from plots.pictures.palette import DEFAULT_COLOURS, Palette
from plots.pictures.provenance import program_version, provenance_line
from plots.pictures.time_scale import fitted_scale
from plots.printed.figure_files import map_figure_bytes
from plots.printed.figure_style import FigureFormat, FigureStyle
from plots.texts.legends import figure_legend, legend_items

LIVE_PICTURES = ("basins", "times", "crossings")
"""Names of the pictures of a live figure."""

_FOLDER = Path(__file__).parents[1] / "browser"
_MODULES = _FOLDER / "modules"
_CITATION = "Computed with Escape Explorer, which implements the system of Zotos (2014), Nonlinear Dynamics 78, 1389."
# Longest time of the orbits that a reader chooses, in units of the well.
_LONGEST_TIME = 200.0
# Largest number of colours in the table of a PNG file.
_MOST_COLOURS = 256
# Decimals of an energy beyond the size of the range of energies.
_DIGITS = 3
# The picture for readers without scripts.
_STILL = FigureStyle(width=14.0, dpi=80.0, font_size=10.0)


def live_figure(
    found: EscapeMap,
    *,
    energies: tuple[float, float] | None = None,
    starts: Sequence[tuple[float, float]] = (),
    caption: str = "",
    link: str = "",
    palette: Palette = DEFAULT_COLOURS,
    execution: Execution = DEFAULT_EXECUTION,
) -> str:
    """Return the HTML of a live figure, which needs no server and makes no request.

    Parameters
    ----------
    found
        The map, complete, for which there is no `live_refusal`.
    energies
        Lowest and highest energy that a reader can choose, dimensionless, with the energy of the map between them; None for the
        range that a review of the potential suggests.
    starts
        (x, ordinate) of chosen orbits, at most five.
    caption
        A text below the figure.
    link
        Address of the view in an explorer, which begins with http:// or https://; empty for none.
    palette
        Colours of the map.
    execution
        How the tables of the exits are computed.

    Raises
    ------
    ValueError
        If the map is not complete, there is no live figure of it, there are too many starts, or a number is not legal.
    """
    _check(found, starts, link, palette)
    data = _data(found, _checked_energies(found.spec, energies), starts, palette, execution)
    script, worker = (script_code(_MODULES / name) for name in ("figure/live.js", "workers/worker.js"))
    shown = ShownMap.of(found, palette, {})
    lines = [escape(caption), f'<a href="{escape(link)}">Open in the explorer</a>' if link else ""]
    return Template((_FOLDER / "live_figure.html").read_text(encoding="utf-8")).substitute(
        policy=_policy(script), generator=program_version(), title=_title(found.spec), still=_still(found, starts, palette),
        choices="".join(f'<option value="{name}">{escape(PICTURES[name].title)}</option>' for name in LIVE_PICTURES),
        no_energy=" hidden" if found.spec.common_energy is None else "", low=data["low"], high=data["high"],
        energy=data["energy"], shown_energy=f"{data['energy']:.{data['decimals']}f}",
        legends="".join(_legend(name, shown) for name in LIVE_PICTURES),
        caption=" ".join(filter(None, lines)), provenance=escape(provenance_line(found)), citation=_CITATION,
        data=_inline(json.dumps(data, separators=(",", ":"))), worker=_inline(worker), script=script,
    )  # fmt: skip


def _check(found: EscapeMap, starts: Sequence[tuple[float, float]], link: str, palette: Palette) -> None:
    """Check the arguments of `live_figure`."""
    found.check_complete("found")
    if refusal := live_refusal(found.spec):
        raise ValueError(f"found: {refusal}")
    if len(starts) > len(palette.orbits):
        raise ValueError(f"starts: there are {len(starts)}; must be at most {len(palette.orbits)}")
    for start in starts:
        for number in start:
            checked_number("starts", number)
    if link and not link.startswith(("http://", "https://")):
        raise ValueError(f"link={link!r}: must begin with http:// or https://")


def _title(spec: MapSpec) -> str:
    """Return the title of a figure, as HTML."""
    name = spec.potential.name
    return escape(f"{'Case ' if name in CASES else ''}{name}, {spec.plane.title}")


def live_refusal(spec: MapSpec) -> str:
    """Return why there is no live figure of a map; empty if there is one."""
    if spec.plane.parameter is not None:
        return f"an axis of its slice is {spec.plane.parameter.symbol}, so each of its orbits belongs to another system"
    return "its orbits run backward in time" if spec.backward else ""


def _checked_energies(spec: MapSpec, energies: tuple[float, float] | None) -> tuple[float, float]:
    """Return the lowest and the highest energy of a figure."""
    if energies is None:
        suggested = review_potential(spec.potential).energies
        present = [] if spec.common_energy is None else [spec.common_energy]
        return min([suggested.low, *present]), max([suggested.high, *present])
    low, high = (checked_number("energies", energy) for energy in energies)
    if not low < high or (spec.common_energy is not None and not low <= spec.common_energy <= high):
        raise ValueError(f"energies={energies}: must rise, with the energy of the map between them")
    return low, high


def _data(
    found: EscapeMap,
    energies: tuple[float, float],
    starts: Sequence[tuple[float, float]],
    palette: Palette,
    execution: Execution,
) -> dict[str, Any]:
    """Return the data of a figure in the form of `FigureData` in plots/browser/modules/figure/data.js."""
    spec, outcomes = found.spec, found.spec.outcomes
    (low, high), (columns, rows) = energies, spec.resolution
    system = make_browser_system(spec.potential, low, high, spec.section, execution=execution).to_dict()
    return {
        "module": _base64(system.pop("module")),
        "kernels": _base64(browser_kernels()),
        "system": system,
        "slice": describe_slice(spec.plane, spec.potential, spec.section),
        "plane": slice_name(spec.plane),
        "axes": list(spec.plane.axis_symbols),
        "energy": spec.common_energy or 0.0,
        "low": low,
        "high": high,
        "decimals": max(math.ceil(_DIGITS - math.log10(high - low)), 0),
        "window": window_in_browser(spec.find_window()),
        "home": spec.given_window is None,
        "starts": [list(start) for start in starts],
        "longest": min(spec.t_max, _LONGEST_TIME * spec.potential.units.time),
        "exact": f"Exact map, computed before: {columns} × {rows} pixels, up to t = {format_number(spec.t_max)}.",
        "colours": [entry.colour for entry in palette.end_entries(outcomes)],
        "labels": [outcome.label for outcome in outcomes],
        "orbits": list(palette.orbits),
        "coding": {**pixel_coding(outcomes, spec.section), "layers": []},
        "pictures": [_picture(name, found, palette) for name in LIVE_PICTURES],
    }


def _picture(name: str, found: EscapeMap, palette: Palette) -> dict[str, Any]:
    """Return a picture in the form of `PictureData` in plots/browser/modules/figure/data.js."""
    picture, scale = PICTURES[name], fitted_scale(found)
    times = {"colours": list(palette.escape_time), "low": scale.low, "high": scale.high}
    return {
        "name": name,
        "column": picture.column,
        "colours": list(picture.colours(palette)),
        "times": times if picture.has_times else None,
        "image": f"data:image/png;base64,{_base64(_png(picture_pixels(found, name, palette)))}",
    }


def _png(pixels: np.ndarray) -> bytes:
    """Return RGBA pixels (rows, columns, 4) as a PNG file, with a table of the colours if there are few enough for one."""
    # A pixel is one number, and its bytes are a colour.
    colours, codes = np.unique(pixels.view(np.uint32)[..., 0], return_inverse=True)
    image, transparency = Image.fromarray(pixels), {}
    if len(colours) <= _MOST_COLOURS:
        table = colours[:, None].view(np.uint8)
        image = Image.fromarray(codes.reshape(pixels.shape[:2]).astype(np.uint8))
        image.putpalette(table[:, :3].tobytes())
        transparency = {"transparency": table[:, 3].tobytes()}
    file = BytesIO()
    image.save(file, "png", optimize=True, **transparency)
    return file.getvalue()


def _legend(name: str, shown: ShownMap) -> str:
    hidden = "" if name == LIVE_PICTURES[0] else " hidden"
    legend = map_legend(name, shown)
    undecided = shown.palette.outcomes[Fate.NOT_COMPUTED]
    return f'<p class="foot" data-picture="{name}"{hidden}>{figure_legend(legend)}{legend_items([undecided])}</p>\n'


def _still(found: EscapeMap, starts: Sequence[tuple[float, float]], palette: Palette) -> str:
    """Return the picture for readers without scripts, as a data address."""
    content = map_figure_bytes(found, LIVE_PICTURES[:1], palette, FigureFormat.PNG, _STILL, starts=starts)
    return f"data:image/png;base64,{_base64(content)}"


def _policy(script: str) -> str:
    """Return the content-security policy of a page with one script: no request, no other script."""
    digest = _base64(hashlib.sha256(script.encode()).digest())
    return (
        f"default-src 'none'; script-src 'sha256-{digest}' 'wasm-unsafe-eval'; worker-src blob:; img-src data:; "
        "style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
    )


def _inline(text: str) -> str:
    """Return the text of an element ``script`` that is not run, without anything that would end the element."""
    return text.replace("</", "<\\/").replace("<!--", "<\\!--")


def _base64(content: bytes) -> str:
    return base64.b64encode(content).decode()
