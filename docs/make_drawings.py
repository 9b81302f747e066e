"""Draw the pictures of the documents, docs/drawings/<name>.webp. Run: python docs/make_drawings.py [name …]"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[1]))

from engine import (
    CASES,
    Certificate,
    Coordinate,
    CurvesSpec,
    Fate,
    MapSpec,
    Orbit,
    ParameterAxis,
    Plane,
    Slice,
    System,
    Window,
    classify_orbits,
    compute_basin_entropy,
    compute_curves,
    compute_flux,
    compute_map,
    compute_origin_fates,
    compute_separation,
    compute_trust,
    compute_uncertainty_exponent,
    compute_wada_test,
    find_section_crossings,
    find_stable_manifolds,
    fit_decay_laws,
    integrate_orbit,
    sample_starts,
    start_states,
)
from engine.service import SECTION, SPACE
from plots.figure_axes import (
    add_figure_legend,
    add_panel_legend,
    label_axes,
    name_panel,
    new_figure,
    patches,
    save_figure,
    style_axes,
)
from plots.figure_style import FigureFormat, FigureStyle
from plots.manifold_strokes import select_image
from plots.map_figure import draw_curve, draw_limits, draw_manifolds, draw_map_figure, draw_picture, draw_pixels, show_window
from plots.orbit_curves import compute_orbit_curves, find_well_window
from plots.orbit_figure import draw_path, draw_sali
from plots.palette import LIGHT, MEASURED, PAPER, Entry, rgba
from plots.potential_figure import draw_well

FOLDER = Path(__file__).parent / "drawings"
# Letters of a document, where a figure is as wide as the text.
_STYLE = FigureStyle(width=24.0, dpi=100.0, font_size=12.0, titles=False)
_COLOURS = 64
_SIDE = 250

# The view with which the page opens.
_CASE, _ENERGY = CASES["I"], 0.19


def main(names: Sequence[str]) -> None:
    """Draw these pictures, or all."""
    FOLDER.mkdir(exist_ok=True)
    for draw in DRAWINGS:
        name = draw.__name__.replace("_", "-")
        if not names or name in names:
            picture = Image.open(BytesIO(save_figure(draw(), FigureFormat.PNG, {}))).convert("RGB")
            few = picture.quantize(_COLOURS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).convert("RGB")
            few.save(FOLDER / f"{name}.webp", lossless=True, quality=100, method=6)


def well() -> Figure:
    """Case I with its saddles; two orbits above the escape energy."""
    figure, (left, right) = _panels(2, 11.5)
    _CASE.plot(left)
    starts = start_states(_CASE, Plane.X_Y, _ENERGY, np.array([-0.2, -0.1]), np.array([-0.2, -0.1]))
    draw_path(right, _CASE, [compute_orbit_curves(_CASE, integrate_orbit(_CASE, start, 300.0)) for start in starts], PAPER)
    name_panel(right, f"Two orbits at h = {_ENERGY}")
    return figure


def maps() -> Figure:
    """The three maps of the page."""
    frame = compute_map(MapSpec(_CASE, Plane.X_PX, _ENERGY, (_SIDE, _SIDE), Window(-0.65, 0.65, -0.65, 0.65), t_max=1e4))
    return draw_map_figure(frame, ("basins", "times", "crossings"), PAPER, replace(_STYLE, titles=True))


def blob() -> Figure:
    """A disc of starts on a boundary of the basins, at three times."""
    times, count, radius = (0.0, 10.0, 20.0), 2000, 0.04
    figure, panels = _panels(len(times), 8.5)
    angle, distance = np.random.default_rng(1).random((2, count)) * [[2.0 * np.pi], [1.0]]
    x, y = radius * np.sqrt(distance) * [np.cos(angle), np.sin(angle)] + [[-0.2], [-0.2]]
    orbits = [integrate_orbit(_CASE, start, 200.0) for start in start_states(_CASE, Plane.X_Y, _ENERGY, x, y)]
    window = find_well_window(_CASE, _ENERGY)
    for axes, t in zip(panels, times, strict=True):
        draw_well(axes, _CASE, _ENERGY, window, PAPER)
        inside = [orbit for orbit in orbits if orbit.t[-1] >= t]
        places = np.array([[np.interp(t, orbit.t, orbit.x), np.interp(t, orbit.t, orbit.y)] for orbit in inside])
        colours = [PAPER.channels[orbit.fate - 1] if orbit.fate > 0 else PAPER.bounded for orbit in inside]
        axes.scatter(*_shares(places, window), s=1.5, c=colours, zorder=3, linewidths=0.0)
        show_window(axes, window, "x", "y", equal=True)
        name_panel(axes, f"t = {t:g}")
    return figure


def tubes() -> Figure:
    """The sections of the tubes around the Lyapunov orbits, and the basins that they bound."""
    figure, panels = _panels(3, 9.0)
    window = MapSpec(_CASE, SECTION.plane, _ENERGY).find_window()
    manifolds = find_stable_manifolds(_CASE, _ENERGY, images=3)
    for axes, image in zip(panels, (1, 2), strict=False):
        draw_limits(axes, _CASE, SECTION.plane, _ENERGY, window)
        draw_manifolds(axes, select_image(manifolds, image), window, PAPER)
        show_window(axes, window, "x", "px")
        name_panel(axes, f"Image {image} of the tubes")
    draw_picture(panels[2], compute_map(MapSpec(_CASE, SECTION.plane, _ENERGY, (_SIDE, _SIDE), t_max=1e4)), "basins", PAPER)
    return figure


def energies() -> Figure:
    """The basins at three energies."""
    figure, panels = _panels(3, 9.5)
    for axes, energy in zip(panels, (0.13, 0.19, 0.4), strict=True):
        frame = compute_map(MapSpec(_CASE, Plane.X_PX, energy, (_SIDE, _SIDE), t_max=1e4))
        draw_picture(axes, frame, "basins", PAPER)
        name_panel(axes, f"h = {energy}: {100.0 * frame.fractions()[Fate.BOUNDED]:.1f} % bounded")
    add_figure_legend(figure, patches([*PAPER.channel_entries(2), PAPER.outcomes[Fate.BOUNDED]]))
    return figure


def cases() -> Figure:
    """The wells of the three cases."""
    figure, panels = _panels(3, 8.5)
    for axes, case in zip(panels, CASES.values(), strict=True):
        case.plot(axes)
    return figure


def exits() -> Figure:
    """Three orbits that start close together, at an exit."""
    figure, (left, right) = _panels(2, 11.5)
    orbits = _orbits_at_the_exit()
    for axes, window in ((left, find_well_window(_CASE, _ENERGY)), (right, Window(0.2, 0.8, 0.45, 1.05))):
        for orbit, colour in zip(orbits, PAPER.orbits, strict=False):
            draw_curve(axes, [np.column_stack([orbit.x, orbit.y])], window, colors=colour, linewidths=1.4)
        draw_limits(axes, _CASE, SPACE, _ENERGY, window, PAPER.channels)
        show_window(axes, window, "x", "y", equal=True)
    name_panel(left, "Three orbits from almost the same start")
    name_panel(right, "At the Lyapunov orbit")
    return figure


def _orbits_at_the_exit() -> list[Orbit]:
    """One orbit inside the tube of exit 1, one on it to rounding, and one outside, which start side by side on y = 0."""

    def start(x: float) -> np.ndarray:
        return start_states(_CASE, Plane.X_PX, _ENERGY, np.array([x]), np.array([0.3]))

    def leaves_at_once(x: float) -> bool:
        outcome = classify_orbits(_CASE, _ENERGY, start(x), 100.0)
        return bool(outcome.fate[0] == 1 and outcome.crossings[0] == 0)

    inside, outside = 0.0, 0.5
    for _ in range(60):
        middle = 0.5 * (inside + outside)
        inside, outside = (middle, outside) if leaves_at_once(middle) else (inside, middle)
    return [integrate_orbit(_CASE, start(inside + aside)[0], 9.0) for aside in (-0.05, 0.0, 0.05)]


def sali() -> Figure:
    """The sections of a regular and a chaotic orbit, and their SALI."""
    figure, (left, right) = _panels(2, 11.0)
    case, energy = CASES["III"], 0.26
    window = MapSpec(case, SECTION.plane, energy).find_window()
    starts = start_states(case, SECTION.plane, energy, np.array([0.4, 0.58]), np.array([0.2, 0.0]))
    for start, colour in zip(starts, PAPER.orbits, strict=False):
        orbit = integrate_orbit(case, start, 2e4)
        _mark_section(left, orbit, window, colour)
        draw_sali(right, compute_orbit_curves(case, orbit), colour)
    draw_limits(left, case, SECTION.plane, energy, window)
    show_window(left, window, "x", "px")
    name_panel(left, "Two orbits where they cross y = 0 upward")
    return figure


def trust() -> Figure:
    """Two orbits that start 10⁻¹¹ apart, a map, and its doubtful pixels."""
    figure, (growth, basins, pixels) = _panels(3, 9.0)
    frame = compute_map(MapSpec(_CASE, Plane.X_PX, _ENERGY, (200, 200), t_max=1e4))
    first, second = start_states(_CASE, Plane.X_PX, _ENERGY, np.array([-0.3, -0.3 + 1e-11]), np.zeros(2))
    compute_separation(_CASE, first, second, 200.0).plot(growth)
    name_panel(growth, "Distance of two orbits")
    draw_picture(basins, frame, "basins", PAPER)
    compute_trust(frame).plot(pixels)
    return figure


def basin_entropy() -> Figure:
    """Boxes of 5 × 5 starts, and their entropies."""
    figure, (left, right) = _panels(2, 11.0)
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (60, 60), Window(0.0, 0.3, 0.0, 0.3), t_max=1e4))
    draw_picture(left, frame, "basins", PAPER)
    boxes = frame.fate.reshape(12, 5, 12, 5).swapaxes(1, 2)
    entropies = [[compute_basin_entropy(box).s_b for box in row] for row in boxes]
    image = right.imshow(entropies, origin="lower", extent=(0.0, 1.0, 0.0, 1.0), cmap="cividis")
    figure.colorbar(image, ax=right, label="entropy of the box")
    for axes in (left, right):
        axes.hlines(np.arange(13) / 12.0, 0.0, 1.0, color=LIGHT.halo, linewidth=0.4)
        axes.vlines(np.arange(13) / 12.0, 0.0, 1.0, color=LIGHT.halo, linewidth=0.4)
    show_window(right, frame.spec.find_window(), "x", "px")
    name_panel(right, "Entropies of the boxes")
    return figure


def wada() -> Figure:
    """Three basins with one boundary, and the test of it."""
    figure, (left, right) = _panels(2, 11.0)
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.25, (_SIDE, _SIDE), t_max=1e4))
    draw_picture(left, frame, "basins", PAPER)
    compute_wada_test(frame).plot(right)
    name_panel(right, "Share of the boundary that is close to all basins")
    return figure


def uncertainty_exponent() -> Figure:
    """The share of uncertain pairs against their separation at two energies."""
    figure, panels = _panels(2, 10.0, sharey=True)
    for axes, energy in zip(panels, (0.2, 0.3), strict=True):
        found = compute_uncertainty_exponent(MapSpec(CASES["II"], Plane.X_PX, energy), work=3e7)
        found.plot(axes)
        name_panel(axes, f"h = {energy}: α = {found.exponent:.2f}")
    return figure


def escape_laws() -> Figure:
    """The share of starts inside against time, with both laws."""
    figure, (axes,) = _panels(1, 10.0, width=18.0)
    fit_decay_laws(compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (224, 224), t_max=1e4))).plot(axes)
    return figure


def slices() -> Figure:
    """Launch angle and energy, and a parameter as an axis."""
    figure, panels = _panels(2, 11.5)
    throws = MapSpec(CASES["III"], Slice(Coordinate.THETA, Coordinate.H), (0.2, 0.8), (_SIDE, _SIDE), t_max=1e3)
    stronger = MapSpec(
        _CASE, Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("I"))), 0.2, (_SIDE, _SIDE), t_max=1e3
    )
    for axes, spec in zip(panels, (throws, stronger), strict=True):
        draw_picture(axes, compute_map(spec), "basins", PAPER)
        name_panel(axes, f"Basins on {spec.plane.title}")
    return figure


def curves() -> Figure:
    """Shares of the outcomes against energy."""
    figure, (axes,) = _panels(1, 9.5, width=18.0)
    values = tuple(float(h) for h in np.linspace(0.25, 0.45, 41))
    compute_curves(CurvesSpec(CASES["III"], Plane.X_PX, values, (80, 80), t_max=1e4, exponent=False)).plot(axes)
    return figure


def flux() -> Figure:
    """The share of random starts inside against time, and the decay at the rate of the flux."""
    figure, (axes,) = _panels(1, 9.5, width=18.0)
    case, energy, count = CASES["II"], 0.2, 20_000
    rate = compute_flux(case, energy).decay_rate
    times = np.sort(classify_orbits(case, energy, sample_starts(case, energy, count), t_max=1e3).escape_time)
    t = np.linspace(0.0, 100.0, 400)
    axes.semilogy(t, 1.0 - np.searchsorted(times, t) / count, color=MEASURED, label="random starts")
    axes.semilogy(t, np.exp(-rate * t), "--", color=LIGHT.text, label=f"exp(−{rate:.3g} t)")
    style_axes(axes, grid=True)
    label_axes(axes, "t", "share inside")
    add_panel_legend(axes, "upper right")
    return figure


def certificates() -> Figure:
    """The certificates of a map, and the sections of a certified orbit and of one that leaves."""
    figure, (left, right) = _panels(2, 12.0)
    case, energy = CASES["III"], 0.30
    frame = compute_map(MapSpec(case, Plane.X_PX, energy, (_SIDE, _SIDE), t_max=1e4))
    window = frame.spec.find_window()
    draw_pixels(left, rgba(list(_CERTIFIED.values()))[frame.certificate][::-1], window, window)
    name_panel(left, "Why an orbit is called bounded")
    starts = start_states(case, SECTION.plane, energy, np.array([0.3, 0.6]), np.zeros(2))
    for start, colour in zip(starts, PAPER.orbits, strict=False):
        orbit = integrate_orbit(case, start, 1e4)
        _mark_section(right, orbit, window, colour)
    name_panel(right, "Two orbits on the section y = 0")
    for axes in (left, right):
        draw_limits(axes, case, SECTION.plane, energy, window)
        show_window(axes, window, "x", "px")
    names = {code: code.name.lower().replace("_", "-") for code in _CERTIFIED if (frame.certificate == code).any()}
    add_figure_legend(figure, patches(Entry(name, _CERTIFIED[code]) for code, name in names.items() if code))
    return figure


# Of the codes of `Certificate`.
_CERTIFIED = dict(zip(Certificate, ("#f2f2f2", "#d1495b", "#7f7f7f", "#4c8dc4", "#8fd0b5", "#b9a2d8"), strict=True))


def origins() -> Figure:
    """Origin and exit of each orbit."""
    figure, panels = _panels(2, 11.0)
    spec = MapSpec(_CASE, Plane.X_PX, 0.3, (_SIDE, _SIDE), t_max=1e3)
    draw_picture(panels[0], compute_map(spec), "basins", PAPER)
    compute_origin_fates(spec).plot(panels[1])
    return figure


def _panels(count: int, height: float, *, width: float = _STYLE.width, sharey: bool = False) -> tuple[Figure, list[Axes]]:
    """A figure, `width` × `height` cm, with panels side by side."""
    figure = new_figure(replace(_STYLE, width=width), height, "")
    return figure, list(figure.subplots(1, count, squeeze=False, sharey=sharey)[0])


def _mark_section(axes: Axes, orbit: Orbit, window: Window, colour: str) -> None:
    """Mark the upward crossings of y = 0."""
    assert orbit.potential is not None
    axes.scatter(*_shares(find_section_crossings(orbit.potential, orbit), window), s=2.0, color=colour, linewidths=0.0)


def _shares(points: np.ndarray, window: Window) -> np.ndarray:
    """(2, n) of (n, 2) points, in shares of a window."""
    low = [window.x_low, window.ordinate_low]
    shares: np.ndarray = (points - low) / ([window.x_high - window.x_low, window.ordinate_high - window.ordinate_low])
    return shares.T


DRAWINGS: tuple[Callable[[], Figure], ...] = (
    well, maps, blob, tubes, energies, cases, exits, sali, trust, basin_entropy, wada, uncertainty_exponent, escape_laws,
    slices, curves, flux, certificates, origins,
)  # fmt: skip

if __name__ == "__main__":
    main(sys.argv[1:])
