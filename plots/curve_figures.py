"""Curves against energy and time drawn with Matplotlib: shares, decay laws, and single lines."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from engine import DecayLaws, Fate, Potential
from engine.service import LawFit
from plots.figure_axes import add_panel_legend, label_axes, style_axes
from plots.palette import LAW_COLOURS, MEASURED, PAPER

# Curves of channels that are equal by symmetry coincide: the second is dashed.
_DASHED = (0, (4.0, 3.0))
_SAMPLES = 300
# If more than this share remains, the curve is in the upper half of its panel.
_MOST_STAY = 0.4
_SYMBOLS = {"exponential": r"\kappa", "power law": r"\gamma"}
# Longer curves have no markers.
_MOST_MARKERS = 60
_DASHES = {"exponential": "--", "power law": "-."}


def draw_shares(axes: Axes, energies: np.ndarray, shares: np.ndarray, potential: Potential) -> None:
    """Draw percentages (m, channels + 1), of bounded starts and of each channel, against energy (m,)."""
    for code, share in enumerate(shares.T):
        if code == Fate.BOUNDED:
            style: dict[str, Any] = {"color": PAPER.bounded, "linewidth": 2.2, "label": PAPER.outcomes[Fate.BOUNDED].label}
        else:
            dashed = potential.mirror_in_x and potential.mirror_channels[code] < code
            style = {"color": PAPER.channels[code - 1], "linewidth": 1.7, "label": f"channel {code}"}
            style |= {"linestyle": _DASHED, "zorder": 3} if dashed else {}
        axes.plot(energies, 100.0 * share, marker="o", markersize=2.2, **style)
    axes.set_ylim(0.0, 100.0)
    axes.set_xlim(float(energies[0]), float(energies[-1]))
    style_axes(axes, grid=True)


def draw_decay_laws(axes: Axes, laws: DecayLaws, t_max: float) -> None:
    """Draw the share of starts that have not escaped against time until t_max, and its fits."""
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


def draw_line(axes: Axes, x: np.ndarray, y: np.ndarray, across: str, up: str, *, logarithmic: str = "") -> None:
    """Draw one measured curve; `logarithmic` has the letters of the axes with a logarithmic scale."""
    axes.plot(x, y, color=MEASURED, linewidth=1.4, marker="o" if x.size <= _MOST_MARKERS else "", markersize=3.0)
    if "x" in logarithmic:
        axes.set_xscale("log")
    if "y" in logarithmic:
        axes.set_yscale("log")
    style_axes(axes, grid=True)
    label_axes(axes, across, up)
