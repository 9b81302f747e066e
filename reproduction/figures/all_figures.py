"""List the figures of the paper by name, with captions and drawing functions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType

from matplotlib.figure import Figure

from engine import CASES, Plane
from plots.printed.figure_axes import save_figure
from plots.printed.figure_style import FigureFormat
from reproduction.figures.map_figures import draw_energy_plane, draw_nine_maps
from reproduction.figures.potential_figures import draw_potential
from reproduction.figures.statistics_figures import draw_percentages, draw_statistics, draw_survival
from reproduction.figures.sticky_figures import draw_characters, draw_super_sticky
from reproduction.map_cache import MapCache
from reproduction.paper_ranges import CHANNEL_ENERGIES, STICKY_ENERGY, plane_energies


@dataclass(frozen=True)
class FigureEntry:
    """A figure of the paper.

    Attributes
    ----------
    name
        Name of the figure, and stem of the names of its files.
    caption
        What the figure shows, in a line.
    draw
        Draws the figure with maps of a cache. This may take minutes.
    """

    name: str
    caption: str
    draw: Callable[[MapCache], Figure]

    def files(self, cache: MapCache) -> dict[str, bytes]:
        """Draw the figure. Return the content of its files, with caption and quality in the metadata, by file name."""
        figure = self.draw(cache)
        quality = cache.quality
        comment = f"{quality.name} quality, {quality.resolution} x {quality.resolution} starts, t_max {quality.t_max:g}"
        facts = {"Title": self.name, "Description": self.caption, "Comment": comment}
        return {f"{self.name}.{format}": save_figure(figure, format, facts) for format in (FigureFormat.PNG, FigureFormat.PDF)}


def _case_figures(case: str) -> Sequence[FigureEntry]:
    low, high = plane_energies(case)
    channel_colours = ("green", "red", "blue", "orange")[: CASES[case].channels]
    colours = ", ".join(["bounded grey", *(f"channel {k} {colour}" for k, colour in enumerate(channel_colours, 1))])
    times = "darker is later; bounded grey"
    rows: tuple[tuple[str, str, Callable[[str, MapCache], Figure]], ...] = (
        (
            "potential",
            f"equipotentials with the escape energy in red, the Lyapunov orbits of the open channels at "
            f"h = {CHANNEL_ENERGIES[case]}, and an orbit through each",
            draw_potential,
        ),
        ("basins-xy", f"basins of escape on (x, y) at nine energies: {colours}", _nine_maps(Plane.X_Y, "basins")),
        ("times-xy", f"escape times on (x, y) at nine energies: {times}", _nine_maps(Plane.X_Y, "times")),
        ("basins-xpx", f"basins of escape on (x, px) at nine energies: {colours}", _nine_maps(Plane.X_PX, "basins")),
        ("times-xpx", f"escape times on (x, px) at nine energies: {times}", _nine_maps(Plane.X_PX, "times")),
        (
            "crossings-xpx",
            "upward crossings of y = 0 before the escape, on (x, px) at nine energies: 0, 1, 2, 3 to 10 and more from light to "
            "dark blue, bounded grey",
            _nine_maps(Plane.X_PX, "crossings"),
        ),
        ("percentages", "shares of bounded starts and of each channel against h, on (x, y) and (x, px)", draw_percentages),
        ("xh", f"basins of escape on (x, h), h from {low:.4g} to {high:g}: {colours}", draw_energy_plane),
        (
            "statistics",
            "escaping and direct starts against h with the paper's fits and new ones; escapes after n crossings, and p_n",
            draw_statistics,
        ),
        ("survival", "share of the starts that have not escaped, at three energies, with fitted laws", draw_survival),
    )
    return [FigureEntry(f"{case}-{name}", f"Case {case}: {caption}", partial(draw, case)) for name, caption, draw in rows]


def _nine_maps(plane: Plane, picture: str) -> Callable[[str, MapCache], Figure]:
    return partial(draw_nine_maps, plane=plane, picture=picture)


_STICKY = (
    FigureEntry(
        "III-regular-chaotic",
        f"Case III, h = {STICKY_ENERGY}, on (x, px): regular bounded orbits cyan, chaotic ones magenta, escaping ones white",
        draw_characters,
    ),
    FigureEntry(
        "III-super-sticky",
        f"Case III, h = {STICKY_ENERGY}: R² = x² + y² against time of a chaotic orbit that escapes long after t = 1e5",
        draw_super_sticky,
    ),
)

FIGURES: Mapping[str, FigureEntry] = MappingProxyType(
    {entry.name: entry for entry in (*(entry for case in CASES for entry in _case_figures(case)), *_STICKY)}
)
"""All figures by name, in an order that reuses maps."""
