"""Live figures of the built documentation: maps of the drawings, which a reader changes. The Markdown files show the drawings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from docs.pictures.panels import CASE, ENERGY
from engine import CASES, MapSpec, Plane, compute_map
from plots.live.live_figure import live_figure
from plots.live.live_view import LiveView
from reproduction.rotating.paper_maps import PAPER_MAPS

FOLDER = "_live"
"""Folder of the live figures in the site."""

_SIDE = 224


LIVE: Mapping[str, LiveView] = {
    "maps": LiveView(
        MapSpec(CASE, Plane.X_PX, ENERGY, t_max=1e4), starts=((-0.2, -0.1),), caption="Neighbours part: move over the map."
    ),
    "energies": LiveView(
        MapSpec(CASE, Plane.X_PX, 0.13, t_max=1e4), caption="Drag the energy from the saddles upward, or play it."
    ),
    "periodic": LiveView(
        MapSpec(CASES["III"], Plane.X_PX, 0.3, t_max=1e3),
        starts=((0.0, 0.0), (0.59611, 0.0)),
        caption="A stable and an unstable orbit.",
    ),
    "earth-moon": LiveView(PAPER_MAPS["Earth–Moon system"][2].spec),
    "copenhagen": LiveView(PAPER_MAPS["Copenhagen problem"][1].spec),
    "star-cluster": LiveView(PAPER_MAPS["Star cluster"][0].spec),
}
"""The live figures, by the names of drawings below which they stand."""


def write_live_figures(site: Path) -> None:
    """Write the live figures to their folder in a site."""
    folder = site / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    for name, view in LIVE.items():
        fine = replace(view, spec=replace(view.spec, resolution=(_SIDE, _SIDE)))
        (folder / f"{name}.html").write_text(live_figure(fine, compute_map(fine.spec)), encoding="utf-8")
