"""The data of a live figure, in the form that its script takes."""

from __future__ import annotations

import base64
import math
from io import BytesIO
from typing import Any

import numpy as np
from PIL import Image

from engine import EscapeMap
from engine.foundations.execution import Execution
from engine.foundations.wording import format_number
from plots.browser.browser_system import describe_slice, make_browser_system, slice_name, window_in_browser
from plots.layers.map_images import picture_pixels
from plots.layers.table import PICTURES
from plots.live.live_view import LiveView
from plots.pictures.image_columns import pixel_coding
from plots.pictures.palette import Palette
from plots.pictures.time_scale import fitted_scale

# Longest times of the orbits that a reader chooses, and of previews, in units of the well.
_LONGEST_TIME = 200.0
_LONGEST_PREVIEW = 1600.0
# Largest number of colours in the table of a PNG file.
_MOST_COLOURS = 256
# Decimals of an energy beyond the size of the range of energies.
_DIGITS = 3


def figure_data(view: LiveView, found: EscapeMap, execution: Execution) -> dict[str, Any]:
    """Return the data of a figure in the form of `FigureData` in plots/browser/modules/figure/data.js.

    Parameters
    ----------
    view
        The request.
    found
        The map of the request.
    execution
        How the tables of the exits are computed.
    """
    spec, outcomes, palette = view.spec, view.spec.outcomes, view.palette
    (low, high), (columns, rows) = view.find_energies(), spec.resolution
    system = _find_system(view, execution)
    if spec.backward and system["backward"]:
        system["table"] = system["backward"]
    return {
        "module": text_of_bytes(system.pop("module")),
        "system": system,
        "slice": describe_slice(spec.plane, spec.potential, spec.section, backward=spec.backward),
        "plane": slice_name(spec.plane),
        "axes": list(spec.plane.axis_symbols),
        "energy": spec.common_energy or 0.0,
        "low": low,
        "high": min(high, max(min(_tabulated_energies(system), default=high), view.map_energies[1])),
        "decimals": max(math.ceil(_DIGITS - math.log10(high - low)), 0),
        "window": window_in_browser(spec.find_window()),
        "home": spec.given_window is None,
        "starts": [list(start) for start in view.starts],
        "longest": min(spec.t_max, _LONGEST_TIME * spec.potential.units.time),
        "horizon": min(spec.t_max, _LONGEST_PREVIEW * spec.potential.units.time),
        "exact": f"Exact map, computed before: {columns} × {rows} pixels, up to t = {format_number(spec.t_max)}.",
        "colours": [entry.colour for entry in palette.end_entries(outcomes)],
        "labels": [outcome.label for outcome in outcomes],
        "orbits": list(palette.orbits),
        "coding": {**pixel_coding(outcomes, spec.section), "layers": []},
        "pictures": [_picture(name, found, palette) for name in view.pictures],
    }


def _find_system(view: LiveView, execution: Execution) -> dict[str, Any]:
    """Return the system with exits up to the highest energy of the figure, or, if those end below the map, up to that of the map.

    Near a maximum between two exits, where exits change fast, tables up to a lower energy can reach farther.
    """
    low, high = view.find_energies()
    for highest in (high, view.map_energies[1]):
        system = make_browser_system(view.spec.potential, low, highest, view.spec.section, execution=execution).to_dict()
        if min(_tabulated_energies(system), default=highest) >= view.map_energies[1]:
            break
    return system


def _tabulated_energies(system: dict[str, Any]) -> list[float]:
    """Return the energies up to which the exits of a system are tabulated, in the units of its potential."""
    return [system["units"]["energy"] * table["highest"] for table in system["exits"] if "highest" in table]


def text_of_bytes(content: bytes) -> str:
    """Return bytes in base64."""
    return base64.b64encode(content).decode()


def png_address(content: bytes) -> str:
    """Return a PNG file as a data address."""
    return f"data:image/png;base64,{text_of_bytes(content)}"


def _picture(name: str, found: EscapeMap, palette: Palette) -> dict[str, Any]:
    """Return a picture in the form of `PictureData` in plots/browser/modules/figure/data.js."""
    picture, scale = PICTURES[name], fitted_scale(found)
    times = {"colours": list(palette.escape_time), "low": scale.low, "high": scale.high}
    return {
        "name": name,
        "column": picture.column,
        "colours": list(picture.colours(palette)),
        "times": times if picture.has_times else None,
        "image": png_address(_png(picture_pixels(found, name, palette))),
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
