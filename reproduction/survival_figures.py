"""Share S(t) of starts that have not escaped, with an exponential law and a power law."""

from __future__ import annotations

from matplotlib.figure import Figure

from engine import Plane, compute_statistics, fit_decay_laws
from plots.curve_figures import draw_decay_laws
from plots.figure_axes import label_axes, name_panels, new_figure
from reproduction.map_shelf import MapShelf
from reproduction.notation import PLANES
from reproduction.paper_ranges import three_energies


def draw_survival(case: str, shelf: MapShelf) -> Figure:
    """One panel per energy, on (x, px)."""
    energies = three_energies(case)
    figure = new_figure(12.6, 4.6, f"Case {case}, {PLANES[Plane.X_PX]} plane: share of the starts not yet escaped")
    panels = list(figure.subplots(1, len(energies), sharex=True))
    for axes, energy in zip(panels, energies, strict=True):
        statistics = compute_statistics(shelf.map(case, Plane.X_PX, energy))
        draw_decay_laws(axes, fit_decay_laws(statistics, shelf.quality.t_max, cancel=shelf.cancel), shelf.quality.t_max)
        label_axes(axes, "$t$", "$S(t)$" if axes is panels[0] else "")
    name_panels(panels, [f"$h = {energy:.2f}$" for energy in energies])
    return figure
