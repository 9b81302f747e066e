"""Draw systems in rotating frames, and with bodies, from the maps that are compared with papers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from matplotlib.figure import Figure

from docs.pictures.panels import SIDE, new_panels
from engine import POTENTIALS, Fate, MapSpec, compute_map, find_stable_manifolds, read_section
from plots.layers.manifolds import manifold_strokes
from plots.pictures.palette import DEFAULT_COLOURS
from plots.printed.figure_axes import add_figure_legend, legend_handles, set_title
from plots.printed.map_figure import draw_picture
from plots.printed.window_axes import draw_strokes
from reproduction.rotating.paper_maps import PAPER_MAPS, PaperMap

# Number of pixels along a side. Fractal maps compress badly, so files grow with it.
_SIDE = 120
# System and energy of the drawn tubes, and sections with titles.
_EARTH_MOON, _ENERGY = POTENTIALS["Earth-Moon"], -1.09
_NECKS = {"x = -0.1, px < 0": "Starts near L1", "x = 0.1, px > 0": "Starts near L2"}


def earth_moon() -> Figure:
    """Draw basins around the Moon with no, one and two open necks."""
    closed, _, one_open, _, both_open = PAPER_MAPS["Earth–Moon system"]
    return _draw((closed, one_open, both_open), {"exit 1": "L2", "exit 2": "L1"})


def copenhagen() -> Figure:
    """Draw basins of the Copenhagen problem with small and large bodies."""
    return _draw(PAPER_MAPS["Copenhagen problem"][1:])


def star_cluster() -> Figure:
    """Draw basins of a star cluster at three energies."""
    return _draw(PAPER_MAPS["Star cluster"])


def four_hills() -> Figure:
    """Draw directions in which orbits leave four hills, at energies below and above their tops."""
    first, _, second, third = PAPER_MAPS["Four hills"]
    return _draw((first, second, third), {"collision with the ": "to the "})


def necks() -> Figure:
    """Draw the first images of the tubes of L1 and L2 of Earth-Moon, on sections across their necks, over the basins."""
    figure, panels = new_panels(2, 9.0)
    for axes, (text, title) in zip(panels, _NECKS.items(), strict=True):
        section = read_section(text)
        frame = compute_map(MapSpec(_EARTH_MOON, section.plane, _ENERGY, (SIDE, SIDE), t_max=20.0, section=section))
        manifolds = find_stable_manifolds(_EARTH_MOON, _ENERGY, images=1, section=section)
        draw_picture(axes, frame, "basins", DEFAULT_COLOURS)
        draw_strokes(axes, manifold_strokes(manifolds), frame.spec.find_window(), DEFAULT_COLOURS)
        set_title(axes, title)
    add_figure_legend(figure, legend_handles(DEFAULT_COLOURS.end_entries(_EARTH_MOON.outcomes)))
    return figure


def _draw(paper_maps: tuple[PaperMap, ...], renamed: Mapping[str, str] = MappingProxyType({})) -> Figure:
    figure, panels = new_panels(len(paper_maps), 9.5)
    frames = [compute_map(replace(paper_map.spec, resolution=(_SIDE, _SIDE))) for paper_map in paper_maps]
    for axes, frame, paper_map in zip(panels, frames, paper_maps, strict=True):
        draw_picture(axes, frame, "basins", DEFAULT_COLOURS)
        set_title(axes, paper_map.name)
    ends = np.unique([frame.fate for frame in frames])
    entries = [DEFAULT_COLOURS.entry(int(fate), paper_maps[0].spec.outcomes) for fate in ends if fate >= Fate.BOUNDED]
    for old, new in renamed.items():
        entries = [replace(entry, label=entry.label.replace(old, new)) for entry in entries]
    add_figure_legend(figure, legend_handles(entries))
    return figure
