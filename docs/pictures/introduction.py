"""Draw figures of case I that explain escapes: the well, the maps, the tubes and the exits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from docs.pictures.panels import CASE, ENERGY, SIDE, STYLE, new_panels, show
from engine import (
    CASES,
    Fate,
    MapSpec,
    Orbit,
    Plane,
    Window,
    classify_orbits,
    compute_map,
    find_stable_manifolds,
    integrate_orbit,
    start_states,
)
from engine.slices.planes import SECTION, SPACE
from plots.layers.manifolds import manifold_strokes, select_image
from plots.pictures.orbit_curves import compute_orbit_curves, find_well_window
from plots.pictures.palette import DEFAULT_COLOURS
from plots.printed.figure_axes import (
    add_figure_legend,
    legend_handles,
    set_title,
)
from plots.printed.map_figure import draw_map_figure, draw_picture
from plots.printed.orbit_figure import draw_path
from plots.printed.potential_figure import draw_well
from plots.printed.window_axes import draw_curve, draw_limits, draw_strokes, show_window


def well() -> Figure:
    """Draw case I with its saddles, and two orbits above the escape energy."""
    figure, (left, right) = new_panels(2, 11.5)
    show(left, CASE, f"{CASE.name}: escape energy {CASE.escape_energy:.6g}")
    starts = start_states(CASE, Plane.X_Y, ENERGY, np.array([-0.2, -0.1]), np.array([-0.2, -0.1]))
    draw_path(right, CASE, [compute_orbit_curves(CASE, integrate_orbit(CASE, start, 300.0)) for start in starts], DEFAULT_COLOURS)
    set_title(right, f"Two orbits at h = {ENERGY}")
    return figure


def maps() -> Figure:
    """Draw the three maps of the page."""
    frame = compute_map(MapSpec(CASE, Plane.X_PX, ENERGY, (SIDE, SIDE), Window(-0.65, 0.65, -0.65, 0.65), t_max=1e4))
    return draw_map_figure(frame, ("basins", "times", "crossings"), DEFAULT_COLOURS, replace(STYLE, titles=True))


def blob() -> Figure:
    """Draw a disc of starts on a boundary of the basins, at three times."""
    times, count, radius = (0.0, 10.0, 20.0), 2000, 0.04
    figure, panels = new_panels(len(times), 8.5)
    angle, distance = np.random.default_rng(1).random((2, count)) * [[2.0 * np.pi], [1.0]]
    x, y = radius * np.sqrt(distance) * [np.cos(angle), np.sin(angle)] + [[-0.2], [-0.2]]
    orbits = [integrate_orbit(CASE, start, 200.0) for start in start_states(CASE, Plane.X_Y, ENERGY, x, y)]
    window = find_well_window(CASE, ENERGY)
    for axes, t in zip(panels, times, strict=True):
        draw_well(axes, CASE, ENERGY, window, DEFAULT_COLOURS)
        inside = [orbit for orbit in orbits if orbit.t[-1] >= t]
        places = np.array([[np.interp(t, orbit.t, orbit.x), np.interp(t, orbit.t, orbit.y)] for orbit in inside])
        colours = [DEFAULT_COLOURS.channels[orbit.fate - 1] if orbit.fate > 0 else DEFAULT_COLOURS.bounded for orbit in inside]
        axes.scatter(*places.T, s=1.5, c=colours, zorder=3, linewidths=0.0)
        show_window(axes, window, "x", "y", equal=True)
        set_title(axes, f"t = {t:g}")
    return figure


def tubes() -> Figure:
    """Draw the sections of the tubes around the Lyapunov orbits, and the basins that they bound."""
    figure, panels = new_panels(3, 9.0)
    window = MapSpec(CASE, SECTION, ENERGY).find_window()
    manifolds = find_stable_manifolds(CASE, ENERGY, images=2)
    for axes, image in zip(panels, (1, 2), strict=False):
        draw_limits(axes, CASE, SECTION, ENERGY, window)
        draw_strokes(axes, manifold_strokes(select_image(manifolds, image)), window, DEFAULT_COLOURS)
        show_window(axes, window, "x", "px")
        set_title(axes, f"Image {image} of the tubes")
    draw_picture(panels[2], compute_map(MapSpec(CASE, SECTION, ENERGY, (SIDE, SIDE), t_max=1e4)), "basins", DEFAULT_COLOURS)
    return figure


def energies() -> Figure:
    """Draw the basins at three energies."""
    figure, panels = new_panels(3, 9.5)
    for axes, energy in zip(panels, (0.13, 0.19, 0.4), strict=True):
        frame = compute_map(MapSpec(CASE, Plane.X_PX, energy, (SIDE, SIDE), t_max=1e4))
        draw_picture(axes, frame, "basins", DEFAULT_COLOURS)
        set_title(axes, f"h = {energy}: {100.0 * frame.fractions()[Fate.BOUNDED]:.1f} % bounded")
    add_figure_legend(
        figure, legend_handles([*DEFAULT_COLOURS.end_entries(CASES["I"].outcomes), DEFAULT_COLOURS.outcomes[Fate.BOUNDED]])
    )
    return figure


def exits() -> Figure:
    """Draw three orbits that start close together, at an exit."""
    figure, (left, right) = new_panels(2, 11.5)
    orbits = _orbits_at_the_exit()
    for axes, window in ((left, find_well_window(CASE, ENERGY)), (right, Window(0.2, 0.8, 0.45, 1.05))):
        for orbit, colour in zip(orbits, DEFAULT_COLOURS.orbits, strict=False):
            draw_curve(axes, [np.column_stack([orbit.x, orbit.y])], window, colors=colour, linewidths=1.4)
        draw_limits(axes, CASE, SPACE, ENERGY, window, DEFAULT_COLOURS.channels)
        show_window(axes, window, "x", "y", equal=True)
    set_title(left, "Three orbits from almost the same start")
    set_title(right, "At the Lyapunov orbit")
    return figure


def _orbits_at_the_exit() -> list[Orbit]:
    """Return three orbits that start side by side on y = 0: inside the tube of exit 1, on the tube to rounding, and outside."""

    def start(x: float) -> np.ndarray:
        return start_states(CASE, Plane.X_PX, ENERGY, np.array([x]), np.array([0.3]))

    def leaves_at_once(x: float) -> bool:
        outcome = classify_orbits(CASE, ENERGY, start(x), 100.0)
        return bool(outcome.fate[0] == 1 and outcome.crossings[0] == 0)

    # Bisect x to the last digit.
    inside, outside = 0.0, 0.5
    for _ in range(60):
        middle = 0.5 * (inside + outside)
        inside, outside = (middle, outside) if leaves_at_once(middle) else (inside, middle)
    return [integrate_orbit(CASE, start(inside + aside)[0], 9.0) for aside in (-0.05, 0.0, 0.05)]
