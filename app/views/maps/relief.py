"""The potential of a well as a shaded relief, seen from above with light from the upper left."""

from __future__ import annotations

import functools

import numpy as np
from bokeh.models import ColumnDataSource, Image, LinearColorMapper
from bokeh.plotting import figure

from engine import MapSpec, Window
from plots.browser.browser_system import system_key

# Number of pixels along each side of the image.
_SIDE = 192
# Width of the image in units of the width of the picture, for previews that show a larger well.
_MARGIN = 1.5
# Without a well, the share of the places inside that are lower than the floor of the relief.
_BELOW_FLOOR = 0.02
# Height of the plateau around the well, in units of its depth at the energy h.
_PLATEAU = 1.3
# Depth of the well in units of the width of the picture.
_DEPTH = 0.15
# Direction towards the light: x, y, and up.
_LIGHT = np.array([-1.0, 1.0, 1.4]) / np.linalg.norm([-1.0, 1.0, 1.4])
# Shades from black to white over any page; most opaque black and white, as a byte.
_SHADES = 63
_BLACK, _WHITE = 0x58, 0x70
# Brightness, relative to that of a horizontal place, of the lightest and of the darkest shade.
_STRONGEST = 0.6
# Darkness of the bottom of the well, in units of the darkest shade.
_SHADOW = 0.35


@functools.lru_cache(maxsize=64)
def shade_relief(spec: MapSpec) -> tuple[np.ndarray, Window]:
    """Return the shades of the relief in a map in (x, y), uint8 of shape (n, n), and their window. The job of the map calls this.

    The effective potential of a rotating system is shaded. Heights begin at a floor and approach a plateau around the well.
    """
    window = _enlarged(spec.find_window())
    h = spec.common_energy
    assert h is not None
    x, y = (np.linspace(low, high, _SIDE) for low, high in window.ranges)
    with np.errstate(all="ignore"):
        energies = spec.plane.required_energy(spec.potential, *np.meshgrid(x, y))
    floor = _find_floor(spec.potential.well.bottom, energies[energies <= h], h)
    depth = h - floor or 1.0
    heights = _flattened(np.maximum(np.nan_to_num((energies - floor) / depth, nan=np.inf), 0.0))
    slope_y, slope_x = np.gradient(heights * _DEPTH * (_SIDE - 1) / _MARGIN)
    brightness = (_LIGHT[2] - _LIGHT[0] * slope_x - _LIGHT[1] * slope_y) / np.sqrt(1.0 + slope_x**2 + slope_y**2) - _LIGHT[2]
    middle = _SHADES // 2
    tone = brightness / _STRONGEST + _SHADOW * (np.minimum(heights, 1.0) - 1.0)
    return np.clip(np.rint(middle * (1.0 + tone)), 0, _SHADES - 1).astype(np.uint8), window


def _flattened(heights: np.ndarray) -> np.ndarray:
    """Return heights that approach the plateau smoothly above the energy h, so that its edge makes no step in the shades."""
    reach = _PLATEAU - 1.0
    return np.where(heights > 1.0, 1.0 + reach * np.tanh((heights - 1.0) / reach), heights)


def _find_floor(bottom: float, inside: np.ndarray, h: float) -> float:
    """Return the bottom of the well; if it is above h, as beside bodies, an energy above that of few places inside."""
    return bottom if bottom < h or not inside.size else float(np.quantile(inside, _BELOW_FLOOR))


def _enlarged(window: Window) -> Window:
    return Window(*(end for low, high in window.ranges for end in _spread(low, high)))


def _spread(low: float, high: float) -> tuple[float, float]:
    middle, half = (low + high) / 2, _MARGIN * (high - low) / 2
    return middle - half, middle + half


def _palette() -> list[str]:
    """Return the colours of the shades, black or white of rising opacity away from the middle."""
    middle = _SHADES // 2
    opacities = [abs(shade - middle) / middle for shade in range(_SHADES)]
    return [
        f"#000000{round(_BLACK * opacity):02x}" if shade < middle else f"#ffffff{round(_WHITE * opacity):02x}"
        for shade, opacity in enumerate(opacities)
    ]


class Relief:
    """Draws the relief of a well in a figure, below all curves."""

    def __init__(self, plot: figure) -> None:
        self._source = ColumnDataSource(dict.fromkeys(("image", "x", "y", "dw", "dh", "well"), ()), name="relief")
        mapper = LinearColorMapper(palette=_palette(), low=0, high=_SHADES)
        plot.add_glyph(self._source, Image(image="image", dw="dw", dh="dh", color_mapper=mapper), level="image")

    def show(self, spec: MapSpec) -> None:
        """Draw the relief of a map in (x, y)."""
        shades, window = shade_relief(spec)
        x, y = window.x_low, window.ordinate_low
        image = {"image": shades, "x": x, "y": y, "dw": window.width, "dh": window.height, "well": system_key(spec.potential)}
        self._source.data = {name: [value] for name, value in image.items()}
