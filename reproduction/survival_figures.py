"""Share S(t) of starts that have not escaped, with an exponential law and a power law."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import DecayLaws, LawFit, Plane, compute_statistics, fit_decay_laws
from plots.figure_axes import add_panel_legend, label_axes, name_panels, new_figure, style_axes
from plots.palette import LAW_COLOURS, MEASURED
from reproduction.map_shelf import MapShelf
from reproduction.notation import PLANES
from reproduction.paper_ranges import three_energies

_SAMPLES = 300
# If more than this share remains, the curve is in the upper half of its panel.
_MOST_STAY = 0.4
_SYMBOLS = {"exponential": r"\kappa", "power law": r"\gamma"}
_DASHES = {"exponential": "--", "power law": "-."}


def draw_survival(case: str, shelf: MapShelf) -> Figure:
    """One panel per energy, on (x, px)."""
    energies = three_energies(case)
    figure = new_figure(12.6, 4.6, f"Case {case}, {PLANES[Plane.X_PX]} plane: share of the starts not yet escaped")
    panels = list(figure.subplots(1, len(energies), sharex=True))
    for axes, energy in zip(panels, energies, strict=True):
        statistics = compute_statistics(shelf.map(case, Plane.X_PX, energy))
        _draw_laws(axes, fit_decay_laws(statistics, shelf.quality.t_max, cancel=shelf.cancel), shelf.quality.t_max)
        label_axes(axes, "$t$", "$S(t)$" if axes is panels[0] else "")
    name_panels(panels, [f"$h = {energy:.2f}$" for energy in energies])
    return figure


def _draw_laws(axes: Axes, laws: DecayLaws, t_max: float) -> None:
    times = np.concatenate([[1.0], laws.times[laws.times > 1.0], [t_max]])
    steps = np.concatenate([[1.0], laws.survival[laws.times > 1.0], laws.survival[-1:] if laws.times.size else [1.0]])
    positive = steps > 0.0
    axes.step(times[positive], steps[positive], where="post", color=MEASURED, linewidth=1.8, label="starts")
    for fit in (laws.exponential, laws.power_law):
        if fit is not None:
            _draw_law(axes, fit, preferred=laws.preferred is fit.law)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(1.0, t_max)
    # At least a decade, so that the axis has labels.
    axes.set_ylim(10.0 ** np.floor(np.log10(0.99 * steps[positive].min())), 1.4)
    style_axes(axes, grid=True)
    add_panel_legend(axes, "lower left" if steps[-1] > _MOST_STAY else "upper right")


def _draw_law(axes: Axes, fit: LawFit, *, preferred: bool) -> None:
    name = str(fit.law)
    label = f"{name}, ${_SYMBOLS[name]} = {_mathtext(fit.rate)}$" + (" (preferred)" if preferred else "")
    t = np.geomspace(fit.t_low, fit.t_high, _SAMPLES)
    curve = fit.curve(t)
    axes.plot(
        t, np.where(curve > 0.0, curve, np.nan), color=LAW_COLOURS[name], linewidth=1.8, linestyle=_DASHES[name], label=label
    )


def _mathtext(number: float) -> str:
    """Number to three digits, with a power of ten if it is small or large."""
    digits, _, power = f"{number:.2e}".partition("e")
    return f"{number:.3g}" if abs(int(power)) < 3 else rf"{digits} \times 10^{{{int(power)}}}"
