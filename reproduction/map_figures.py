"""Nine maps of a case side by side, and its (x, h) plane."""

from __future__ import annotations

from matplotlib.artist import Artist
from matplotlib.figure import Figure

from app.rendering.palette import PAPER
from engine import CASES, Fate, Plane
from reproduction.map_panels import add_time_bar, common_longest, common_window, draw_limits, draw_map, show_window
from reproduction.map_shelf import MapShelf
from reproduction.paper_ranges import nine_energies, plane_energies
from reproduction.printing import PLANES, add_key, label_axes, limiting_lines, name_panel, new_figure, patches

TITLES = {"basins": "basins of escape", "times": "escape times", "crossings": "upward crossings of $y = 0$ before the escape"}
"""What stands over each kind of map."""

_SIDE = 3


def draw_nine_maps(case: str, shelf: MapShelf, *, plane: Plane, picture: str) -> Figure:
    """One picture of `TITLES` at the paper's nine energies, all in one window."""
    frames = [shelf.map(case, plane, energy) for energy in nine_energies(case)]
    shown, longest = common_window(frames), common_longest(frames)
    title = f"Case {case}, {PLANES[plane]} plane: {TITLES[picture]}"
    figure = new_figure(10.6 if picture == "times" else 9.6, 10.4, title, equal=True)
    panels = figure.subplots(_SIDE, _SIDE, sharex=True, sharey=True)
    for axes, frame in zip(panels.flat, frames, strict=True):
        draw_map(axes, frame, picture, longest)
        draw_limits(axes, frame, shown)
        show_window(axes, plane, shown)
        name_panel(axes, f"$h = {frame.spec.energy:.2f}$")
    for axes in panels.flat:
        place = axes.get_subplotspec()
        label_axes(axes, axes.get_xlabel() if place.is_last_row() else "", axes.get_ylabel() if place.is_first_col() else "")
    if picture == "times":
        add_time_bar(figure, panels.ravel().tolist(), longest)
    add_key(figure, [*_key_of(case, picture), *limiting_lines(plane)])
    return figure


def draw_energy_plane(case: str, shelf: MapShelf) -> Figure:
    """The basins on (x, h)."""
    frame = shelf.map(case, Plane.X_H, plane_energies(case))
    figure = new_figure(7.6, 6.6, f"Case {case}, {PLANES[Plane.X_H]} plane: basins of escape")
    axes = figure.subplots()
    draw_map(axes, frame, "basins")
    draw_limits(axes, frame, frame.spec.window)
    show_window(axes, Plane.X_H, frame.spec.window, square=False)
    add_key(figure, [*_key_of(case, "basins"), *limiting_lines(Plane.X_H)])
    return figure


def _key_of(case: str, picture: str) -> list[Artist]:
    bounded = PAPER.outcomes[Fate.BOUNDED]
    if picture == "times":
        return patches([bounded])
    return patches([bounded, *(PAPER.channel_entries(CASES[case].channels) if picture == "basins" else PAPER.crossing_entries)])
