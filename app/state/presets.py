"""Preset views: the kinds of figures in Zotos (2014), details of the maps, and explanations."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import parse_qsl

from app.state.permalink import linked_view, read_link
from app.state.view import View

GROUPS = ("The paper", "Places", "Explanations", "Other slices", "Other systems")
"""Kinds of figures in the paper, details found by zooming, analyses that explain both; slices and systems not in the paper."""


@dataclass(frozen=True, kw_only=True)
class Preset:
    """A view with a title and a caption.

    Attributes
    ----------
    key
        Stem of the file name of its thumbnail.
    title, caption
        Texts on the page: a few words, and a few sentences.
    group
        One of `GROUPS`.
    picture
        Picture of its thumbnail, one of `plots.layers.table.TITLES`.
    link
        The view as a link, without its question mark.
    invitation
        One line of text if the view is offered before there is an orbit; empty for the other views.
    """

    key: str
    title: str
    caption: str
    group: str
    picture: str
    link: str
    invitation: str = ""

    @property
    def view(self) -> View:
        """Return the view; choices that the settings of the server do not allow have their defaults."""
        values, _ = read_link(dict(parse_qsl(self.link)))
        return linked_view(values)


def _read_presets() -> tuple[Preset, ...]:
    tables = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
    return tuple(Preset(key=key, **table) for key, table in tables.items())


PRESETS = _read_presets()
"""All presets in the order of the page."""
