"""The gallery and the catalogue as a folder of live figures with a page that lists them, which needs no server."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from html import escape

from engine import EscapeMap, MapSpec, Plane, compute_map
from engine.foundations.execution import Execution
from engine.jobs.job import run_job
from engine.maps.map_jobs import map_job
from engine.systems.catalogue.table import CATALOGUE
from engine.systems.review.potential_review import review_system
from engine.systems.system import System
from plots.layers.escapes import CURVES
from plots.layers.layer import Analyses
from plots.layers.table import LAYERS, TITLES
from plots.links.map_view import default_settings
from plots.links.presets import GROUPS, PRESETS, Preset
from plots.live.html_pages import QUIET_POLICY, fill_page
from plots.live.live_figure import STILL, linked_live_figure, live_script, still_picture
from plots.live.live_view import LIVE_PICTURES, LiveView, live_refusal, view_title
from plots.pictures.palette import Palette
from plots.pictures.provenance import provenance_line
from plots.pictures.setting import Settings
from plots.printed.figure_files import map_figure_bytes
from plots.printed.figure_style import FigureFormat

SYSTEMS = "Catalogue of systems"
"""Topic of the catalogue."""

_TOPICS = (*GROUPS, SYSTEMS)
_TITLE = "Escapes in open Hamiltonian systems"
_INTRODUCTION = (
    "Each picture is a map of starts, whose colours say how their orbits leave. In a live figure your browser computes the map "
    "again while you drag the energy, move over the map, or zoom. The page of a still picture says why it is not live."
)
# Names of the files that all figures share.
_SCRIPT, _INDEX = "live.js", "index.html"


@dataclass(frozen=True)
class GalleryEntry:
    """A view of the gallery.

    Attributes
    ----------
    key
        Stem of the names of its files.
    topic, title, caption
        Where it stands in the gallery, its heading, and the text below its picture.
    spec
        The map.
    picture
        The picture of the preset, one of `TITLES`.
    starts
        (x, ordinate) of chosen orbits.
    layers, settings
        The layers over the map, and their settings.
    """

    key: str
    topic: str
    title: str
    caption: str
    spec: MapSpec
    picture: str = LIVE_PICTURES[0]
    starts: tuple[tuple[float, float], ...] = ()
    layers: frozenset[str] = frozenset()
    settings: Settings = field(default_factory=default_settings, hash=False)

    @property
    def refusal(self) -> str:
        """Why the view is a still picture; empty for a live figure."""
        layers = ", ".join(LAYERS[name].title for name in sorted(self.layers))
        return live_refusal(self.spec) or (f"a live figure has no layers, and the picture shows one: {layers}" if layers else "")

    @property
    def first_picture(self) -> str:
        """The picture that is shown first. Each live figure has the curves beside the map."""
        return LIVE_PICTURES[0] if self.picture == CURVES.name and not self.refusal else self.picture

    @property
    def live_view(self) -> LiveView:
        """The live figure without its palette; ValueError if the view is a still picture."""
        return LiveView(self.spec, None, self.starts, self.first_picture, self.caption, title=self.title)


def preset_entry(preset: Preset) -> GalleryEntry:
    """Return a preset as an entry."""
    view = preset.map_view
    spec = view.map_spec(review_system(view.system))
    texts = preset.key, preset.group, preset.title, preset.caption
    return GalleryEntry(*texts, spec, preset.picture, view.starts, view.layers, view.settings)


def system_entry(name: str) -> GalleryEntry:
    """Return a system of the catalogue as an entry, at the energy that is shown first."""
    row, review = CATALOGUE[name], review_system(System(name))
    caption = f"V = {row.formula}. {row.description} {row.reference}."
    key = f"system-{name.lower().replace(' ', '-')}"
    return GalleryEntry(key, SYSTEMS, row.title, caption, MapSpec(review.potential, Plane.X_PX, review.energies.first))


def gallery_entries() -> Iterator[GalleryEntry]:
    """Yield all presets, then all systems of the catalogue."""
    yield from map(preset_entry, PRESETS)
    yield from map(system_entry, CATALOGUE)


def shared_files(entries: Sequence[GalleryEntry]) -> dict[str, str]:
    """Return the page that lists the entries, and the script of their figures, by the names of the files."""
    present = [topic for topic in _TOPICS if any(entry.topic == topic for entry in entries)]
    sections = (
        f'<section aria-labelledby="topic-{number}"><h2 id="topic-{number}">{escape(topic)}</h2>\n<ul class="cards">\n'
        f"{''.join(_card(entry) for entry in entries if entry.topic == topic)}</ul></section>\n"
        for number, topic in enumerate(present)
    )
    topics = (f'<li><a href="#topic-{number}">{escape(topic)}</a></li>' for number, topic in enumerate(present))
    parts = {"policy": QUIET_POLICY, "title": _TITLE, "introduction": _INTRODUCTION}
    return {_INDEX: fill_page("gallery", parts, topics="".join(topics), sections="".join(sections)), _SCRIPT: live_script()}


def entry_files(entry: GalleryEntry, palette: Palette, execution: Execution) -> dict[str, str | bytes]:
    """Compute an entry and return its page and its picture, by the names of the files."""
    found = compute_map(entry.spec, execution=execution)
    execution.raise_if_cancelled()
    links = {"script": _SCRIPT, "still": f"{entry.key}.png", "back": f'<p class="quiet"><a href="{_INDEX}">All figures</a></p>'}
    if entry.refusal:
        picture = _still(entry, found, palette, execution)
        page = fill_page(
            "still_figure", links, policy=QUIET_POLICY, title=escape(entry.title), alt=escape(_description(entry)),
            caption=escape(entry.caption), refusal=escape(f"A still picture: {entry.refusal}."),
            provenance=escape(provenance_line(found)),
        )  # fmt: skip
    else:
        view = replace(entry.live_view, palette=palette)
        picture, page = still_picture(view, found), linked_live_figure(view, found, links, execution)
    return {links["still"]: picture, f"{entry.key}.html": page}


def analyse(found: EscapeMap, layers: frozenset[str], settings: Settings, execution: Execution) -> Analyses:
    """Return the results of layers on a map."""
    known = {map_job(found.spec): found}
    chosen = (layer for name, layer in LAYERS.items() if name in layers)
    return {layer.name: run_job(layer.job(found.spec, settings), execution, known) for layer in chosen}


def _still(entry: GalleryEntry, found: EscapeMap, palette: Palette, execution: Execution) -> bytes:
    """Return the still picture of an entry as a PNG file, with its layers."""
    analyses = analyse(found, entry.layers, entry.settings, execution)
    return map_figure_bytes(found, [entry.picture], palette, FigureFormat.PNG, STILL, analyses=analyses, starts=entry.starts)


def _description(entry: GalleryEntry) -> str:
    return f"{TITLES[entry.first_picture]}, {view_title(entry.spec)}"


def _card(entry: GalleryEntry) -> str:
    """Return the element of the list for an entry."""
    still = " (still picture)" if entry.refusal else ""
    return (
        f'<li><a href="{entry.key}.html"><img src="{entry.key}.png" alt="" loading="lazy">{escape(entry.title)}'
        f"<small>{escape(_description(entry))}{still}</small></a></li>\n"
    )
