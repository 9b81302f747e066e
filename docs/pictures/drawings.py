"""Make the drawings of the documents, docs/drawings/<name>.webp. Functions without parameters draw one figure each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from docs.pictures.introduction import blob, energies, exits, maps, tubes, well
from docs.pictures.panels import CASE, ENERGY, SIDE, STYLE, mark_section, new_panels, show
from docs.pictures.rotating import copenhagen, earth_moon, four_hills, necks, star_cluster
from engine import (
    CASES,
    POTENTIALS,
    Coordinate,
    Evidence,
    MapSpec,
    ParameterAxis,
    Plane,
    Slice,
    SweepSpec,
    System,
    Window,
    classify_orbits,
    compute_basin_entropy,
    compute_flux,
    compute_map,
    compute_origin_fates,
    compute_separation,
    compute_statistics,
    compute_sweep,
    compute_trust,
    compute_uncertainty_exponent,
    compute_wada_test,
    continue_family,
    find_periodic_orbit,
    find_periodic_orbits,
    find_symmetric_families,
    fit_decay_laws,
    integrate_orbit,
    sample_starts,
    start_states,
)
from engine.slices.planes import SECTION
from plots.layers.periodic_orbits import periodic_strokes
from plots.pictures.orbit_curves import compute_orbit_curves
from plots.pictures.orbit_quantities import ORBIT_QUANTITIES
from plots.pictures.palette import DEFAULT_COLOURS, LIGHT, MEASURED, Entry, rgba
from plots.printed.curve_figures import draw_chart, draw_statistics_figure
from plots.printed.figure_axes import (
    add_figure_legend,
    add_panel_legend,
    label_axes,
    legend_handles,
    save_figure,
    set_title,
    style_axes,
)
from plots.printed.figure_style import FigureFormat
from plots.printed.map_figure import draw_picture
from plots.printed.orbit_figure import draw_quantity
from plots.printed.window_axes import draw_limits, draw_pixels, draw_strokes, show_window
from plots.studies.family import family_charts

DOCS = Path(__file__).parents[1]
# Number of colours of a file.
_COLOURS = 64


def make(names: Sequence[str]) -> None:
    """Draw and write the figures with these names."""
    for name in names:
        draw = PICTURES[name]
        picture = Image.open(BytesIO(save_figure(draw(), FigureFormat.PNG, {}))).convert("RGB")
        few = picture.quantize(_COLOURS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).convert("RGB")
        few.save(DOCS / f"{name}.webp", lossless=True, quality=100, method=6)


def cases() -> Figure:
    """Draw the wells of the three cases."""
    figure, panels = new_panels(3, 8.5)
    for axes, case in zip(panels, CASES.values(), strict=True):
        show(axes, case, f"{case.name}: escape energy {case.escape_energy:.6g}")
    return figure


def potentials() -> Figure:
    """Draw some wells of the catalogue."""
    figure, panels = new_panels(3, 8.5)
    for axes, name in zip(panels, ("C5", "C8", "One exit"), strict=True):
        show(axes, POTENTIALS[name], f"{name}: escape energy {POTENTIALS[name].escape_energy:.6g}")
    return figure


def sali() -> Figure:
    """Draw the sections of a regular and a chaotic orbit, and their SALI."""
    figure, (left, right) = new_panels(2, 11.0)
    case, energy = CASES["III"], 0.26
    window = MapSpec(case, SECTION, energy).find_window()
    starts = start_states(case, SECTION, energy, np.array([0.4, 0.58]), np.array([0.2, 0.0]))
    orbits = [integrate_orbit(case, start, 2e4) for start in starts]
    for orbit, colour in zip(orbits, DEFAULT_COLOURS.orbits, strict=False):
        mark_section(left, orbit, colour)
    (quantity,) = (one for one in ORBIT_QUANTITIES if one.name == "sali")
    draw_quantity(right, quantity, [compute_orbit_curves(case, orbit) for orbit in orbits], DEFAULT_COLOURS)
    draw_limits(left, case, SECTION, energy, window)
    show_window(left, window, "x", "px")
    set_title(left, "Two orbits where they cross y = 0 upward")
    return figure


def trust() -> Figure:
    """Draw two orbits that start 10⁻¹¹ apart, a map, and its doubtful pixels."""
    figure, (growth, basins, pixels) = new_panels(3, 9.0)
    frame = compute_map(MapSpec(CASE, Plane.X_PX, ENERGY, (200, 200), t_max=1e4))
    first, second = start_states(CASE, Plane.X_PX, ENERGY, np.array([-0.3, -0.3 + 1e-11]), np.zeros(2))
    show(growth, compute_separation(CASE, first, second, 200.0), "Distance of two orbits")
    draw_picture(basins, frame, "basins", DEFAULT_COLOURS)
    show(pixels, compute_trust(frame), "Pixels to trust")
    return figure


def basin_entropy() -> Figure:
    """Draw boxes of 5 × 5 starts, and the entropies of the boxes."""
    figure, (left, right) = new_panels(2, 11.0)
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (60, 60), Window(0.0, 0.3, 0.0, 0.3), t_max=1e4))
    draw_picture(left, frame, "basins", DEFAULT_COLOURS)
    boxes = frame.fate.reshape(12, 5, 12, 5).swapaxes(1, 2)
    entropies = [[compute_basin_entropy(box).s_b for box in row] for row in boxes]
    window = frame.spec.find_window()
    image = right.imshow(entropies, origin="lower", extent=window.edges, cmap="cividis")
    figure.colorbar(image, ax=right, label="entropy of the box")
    for axes in (left, right):
        axes.hlines(np.linspace(*window.ranges[1], 13), *window.ranges[0], color=LIGHT.halo, linewidth=0.4)
        axes.vlines(np.linspace(*window.ranges[0], 13), *window.ranges[1], color=LIGHT.halo, linewidth=0.4)
    show_window(right, window, "x", "px")
    set_title(right, "Entropies of the boxes")
    return figure


def wada() -> Figure:
    """Draw three basins with a common boundary, and the Wada test of this boundary."""
    figure, (left, right) = new_panels(2, 11.0)
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.25, (SIDE, SIDE), t_max=1e4))
    draw_picture(left, frame, "basins", DEFAULT_COLOURS)
    show(right, compute_wada_test(frame), "Share of the boundary that is close to all basins")
    return figure


def uncertainty_exponent() -> Figure:
    """Draw the share of uncertain pairs against their separation at two energies."""
    figure, panels = new_panels(2, 10.0, sharey=True)
    for axes, energy in zip(panels, (0.2, 0.3), strict=True):
        found = compute_uncertainty_exponent(MapSpec(CASES["II"], Plane.X_PX, energy), work=3e7, rng=0)
        show(axes, found, f"h = {energy}: α = {found.exponent:.2f}")
    return figure


def escape_laws() -> Figure:
    """Draw the share of starts inside against time, with the exponential law and the power law."""
    figure, (axes,) = new_panels(1, 10.0, width=18.0)
    show(axes, fit_decay_laws(compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (224, 224), t_max=1e4))))
    return figure


def periodic() -> Figure:
    """Draw periodic orbits over the basins of case III, and the stability index of a family."""
    figure, (basins, index) = new_panels(2, 8.5)
    escape_map = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.3, (SIDE, SIDE), t_max=1e3))
    window = escape_map.spec.find_window()
    draw_picture(basins, escape_map, "basins", DEFAULT_COLOURS)
    found = find_periodic_orbits(MapSpec(CASES["III"], Plane.X_PX, 0.3, (60, 60), t_max=1e3), 2)
    draw_strokes(basins, periodic_strokes(found), window, DEFAULT_COLOURS)
    straight = find_periodic_orbit(CASES["III"], [0.0, 0.0, 0.0, np.sqrt(0.4)], 1)
    chart = family_charts(continue_family(straight, (0.05, 0.7)), DEFAULT_COLOURS)[1]
    draw_chart(index, chart, STYLE, None)
    set_title(index, chart.frame.title, STYLE)
    return figure


def families() -> Figure:
    """Draw families of periodic orbits of case III and of Hénon and Heiles on slices along the energy."""
    figure, panels = new_panels(2, 8.5)
    y_h = Slice(Coordinate.Y, Coordinate.H, Coordinate.PX)
    paper = MapSpec(CASES["III"], Plane.X_H, (0.05, 0.6), (SIDE, SIDE), t_max=1e3)
    henon_heiles = MapSpec(POTENTIALS["HH"], y_h, (0.03, 0.25), (SIDE, SIDE), t_max=1e3, section="x = 0")
    for axes, spec in zip(panels, (paper, henon_heiles), strict=True):
        window = spec.find_window()
        draw_limits(axes, spec.potential, spec.plane, spec.energy, window)
        draw_strokes(axes, periodic_strokes(find_symmetric_families(spec, 3)), window, DEFAULT_COLOURS)
        show_window(axes, window, *spec.plane.axis_symbols)
        set_title(axes, f"{spec.potential.name} on {spec.plane.title}")
    return figure


def slices() -> Figure:
    """Draw basins on a slice of launch angle and energy, and on a slice with a parameter as an axis."""
    figure, panels = new_panels(2, 11.5)
    throws = MapSpec(CASES["III"], Slice(Coordinate.THETA, Coordinate.H), (0.2, 0.8), (SIDE, SIDE), t_max=1e3)
    stronger = MapSpec(CASE, Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("I"))), 0.2, (SIDE, SIDE), t_max=1e3)
    for axes, spec in zip(panels, (throws, stronger), strict=True):
        draw_picture(axes, compute_map(spec), "basins", DEFAULT_COLOURS)
        set_title(axes, f"Basins on {spec.plane.title}")
    return figure


def statistics() -> Figure:
    """Draw a histogram of escape times, and the probability of an escape after each number of crossings."""
    frame = compute_map(MapSpec(CASES["II"], SECTION, 0.2, (SIDE, SIDE), t_max=1e4))
    return draw_statistics_figure(compute_statistics(frame), replace(STYLE, titles=True))


def curves() -> Figure:
    """Draw shares of the outcomes against energy."""
    figure, (axes,) = new_panels(1, 9.5, width=18.0)
    values = tuple(float(h) for h in np.linspace(0.25, 0.45, 41))
    show(axes, compute_sweep(SweepSpec(CASES["III"], Plane.X_PX, values, (80, 80), t_max=1e4, measures="shares")))
    return figure


def flux() -> Figure:
    """Draw the share of random starts inside against time, and the decay at the rate of the flux."""
    figure, (axes,) = new_panels(1, 9.5, width=18.0)
    case, energy, count = CASES["II"], 0.2, 20_000
    rate = compute_flux(case, energy).decay_rate
    times = np.sort(classify_orbits(case, energy, sample_starts(case, energy, count, rng=0), t_max=1e3).escape_time)
    t = np.linspace(0.0, 100.0, 400)
    axes.semilogy(t, 1.0 - np.searchsorted(times, t) / count, color=MEASURED, label="random starts")
    axes.semilogy(t, np.exp(-rate * t), "--", color=LIGHT.text, label=f"exp(−{rate:.3g} t)")
    style_axes(axes, grid=True)
    label_axes(axes, "t", "share inside")
    add_panel_legend(axes, "upper right")
    return figure


def evidence() -> Figure:
    """Draw the evidence of a map, and the sections of a regular orbit and of an orbit that leaves."""
    figure, (left, right) = new_panels(2, 12.0)
    case, energy = CASES["III"], 0.30
    frame = compute_map(MapSpec(case, Plane.X_PX, energy, (SIDE, SIDE), t_max=1e4))
    window = frame.spec.find_window()
    draw_pixels(left, rgba(list(_EVIDENCE_COLOURS.values()))[frame.evidence][::-1], window)
    set_title(left, "Why an orbit is called bounded")
    starts = start_states(case, SECTION, energy, np.array([0.3, 0.6]), np.zeros(2))
    for start, colour in zip(starts, DEFAULT_COLOURS.orbits, strict=False):
        orbit = integrate_orbit(case, start, 1e4)
        mark_section(right, orbit, colour)
    set_title(right, "Two orbits on the section y = 0")
    for axes in (left, right):
        draw_limits(axes, case, SECTION, energy, window)
        show_window(axes, window, "x", "px")
    names = {code: code.name.lower().replace("_", "-") for code in _EVIDENCE_COLOURS if (frame.evidence == code).any()}
    add_figure_legend(figure, legend_handles(Entry(name, _EVIDENCE_COLOURS[code]) for code, name in names.items() if code))
    return figure


# Colours by code of `Evidence`.
_EVIDENCE_COLOURS = dict(zip(Evidence, ("#f2f2f2", "#d1495b", "#7f7f7f", "#4c8dc4", "#8fd0b5", "#b9a2d8"), strict=True))


def origins() -> Figure:
    """Draw origin and exit of each orbit."""
    figure, panels = new_panels(2, 11.0)
    spec = MapSpec(CASE, Plane.X_PX, 0.3, (SIDE, SIDE), t_max=1e3)
    draw_picture(panels[0], compute_map(spec), "basins", DEFAULT_COLOURS)
    show(panels[1], compute_origin_fates(spec), "Origin and exit")
    return figure


DRAWINGS: tuple[Callable[[], Figure], ...] = (
    well, maps, blob, tubes, energies, cases, potentials, exits, sali, trust, basin_entropy, wada, uncertainty_exponent,
    escape_laws, slices, statistics, curves, flux, evidence, periodic, families, origins, earth_moon, copenhagen, star_cluster,
    four_hills, necks,
)  # fmt: skip

PICTURES = {f"drawings/{draw.__name__.replace('_', '-')}": draw for draw in DRAWINGS}
