"""Preset views: the kinds of figures in Zotos (2014), details of the maps, and explanations."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

from plots.links.map_link import read_map_view
from plots.links.map_view import MapView

GROUPS = ("The paper", "Places", "Explanations", "Other slices", "Other systems")
"""Groups of presets, in the order of the page."""


@dataclass(frozen=True, kw_only=True)
class Preset:
    """A view with a title and a caption.

    Attributes
    ----------
    key
        Stem of the file name of its thumbnail.
    title, caption
        A few words, and a few sentences that are true on the page and below a figure without it.
    group
        One of `GROUPS`.
    picture
        Picture of its thumbnail, one of `plots.layers.table.TITLES`.
    link
        The view as a link, without its question mark.
    invitation
        Line of text with which a page without orbits offers the preset; empty if it does not offer the preset.
    """

    key: str
    title: str
    caption: str
    group: str
    picture: str
    link: str
    invitation: str = ""

    @property
    def map_view(self) -> MapView:
        """The map of the view with its layers."""
        return read_map_view(self.link)


def _read_presets() -> tuple[Preset, ...]:
    tables = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
    return tuple(Preset(key=key, **table) for key, table in tables.items())


PRESETS = _read_presets()
"""All presets in the order of the page."""
