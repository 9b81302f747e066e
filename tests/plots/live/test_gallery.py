"""The gallery as a folder has a page for each preset and each system, with one script, and refers only to its own files."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from engine.foundations.execution import DEFAULT_EXECUTION
from engine.systems.catalogue.table import CATALOGUE
from plots.links.presets import PRESETS
from plots.live.gallery import GalleryEntry, entry_files, gallery_entries, preset_entry, shared_files, system_entry
from plots.pictures.palette import PAPER

ENTRIES = list(gallery_entries())
EXAMPLES = ("crossings", "strength", "doubt")


def small(entry: GalleryEntry) -> GalleryEntry:
    return replace(entry, spec=replace(entry.spec, resolution=(12, 12), t_max=50.0))


@pytest.fixture(scope="module")
def files() -> dict[str, str | bytes]:
    entries = [small(preset_entry(preset)) for preset in PRESETS if preset.key in EXAMPLES] + [small(system_entry("One exit"))]
    made = {name: content for entry in entries for name, content in entry_files(entry, PAPER, DEFAULT_EXECUTION).items()}
    return {**shared_files(entries), **made}


class References(HTMLParser):
    """Collects the addresses to which a page refers, and its texts."""

    def __init__(self, page: str | bytes) -> None:
        super().__init__()
        self.addresses: set[str] = set()
        self.text = ""
        assert isinstance(page, str)
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.addresses |= {value or "" for name, value in attrs if name in ("src", "href")}

    def handle_data(self, data: str) -> None:
        self.text += data


def test_every_preset_and_every_system_has_an_entry() -> None:
    keys = [entry.key for entry in ENTRIES]
    assert len(set(keys)) == len(keys) == len(PRESETS) + len(CATALOGUE)
    assert [re.fullmatch(r"[a-z0-9-]+", key) is None for key in keys] == [False] * len(keys)


def test_views_along_a_parameter_and_views_with_layers_are_still_pictures_and_all_others_are_live() -> None:
    still = {entry.key for entry in ENTRIES if entry.refusal}
    layers = {preset.key for preset in PRESETS if preset.map_view.layers}
    assert still == layers | {"strength"}
    assert [entry.live_view.caption for entry in ENTRIES if not entry.refusal and not entry.caption] == []


def test_no_caption_speaks_of_controls_that_a_figure_lacks() -> None:
    controls = re.compile(r"\b(tabs?|buttons?|press|click|follow|analys[ie]s|the page)\b|\"", re.IGNORECASE)
    assert [entry.key for entry in ENTRIES if controls.search(entry.caption)] == []


def test_a_folder_refers_to_its_own_files_only(files: dict[str, str | bytes]) -> None:
    pages = [content for name, content in files.items() if name.endswith(".html")]
    addresses = {address for page in pages for address in References(page).addresses if not address.startswith("#")}
    assert addresses <= set(files)
    assert set(files) - addresses == set()
    for page in pages:
        (policy,) = re.findall(r'http-equiv="Content-Security-Policy" content="([^"]*)"', str(page))
        assert policy.startswith("default-src 'none';")
        assert set(re.findall(r"'self'|\w+:|'sha256[^']*'", policy)) <= {"'self'", "data:", "blob:"}


def test_the_page_lists_each_figure_below_its_topic_with_its_title(files: dict[str, str | bytes]) -> None:
    text = References(files["index.html"]).text
    headings = ["The paper", "Explanations", "Other slices", "Catalogue of systems"]
    titles = ["Counting crossings", "From order to escape", CATALOGUE["One exit"].title]
    assert [heading for heading in headings if text.count(heading) != 2] == []
    assert [title for title in titles if title not in text] == []
    assert text.count("(still picture)") == 2


def test_a_live_figure_of_the_folder_begins_with_the_picture_of_its_preset(files: dict[str, str | bytes]) -> None:
    page = str(files["crossings.html"])
    [text] = re.findall(r'<script id="data" type="application/json">(.*?)</script>', page, re.DOTALL)
    assert json.loads(text)["pictures"][0]["name"] == "crossings"
    assert "<h1>Counting crossings</h1>" in page
    assert "kernels" not in page


def test_a_still_picture_has_its_caption_and_the_reason(files: dict[str, str | bytes]) -> None:
    strength, doubt = (References(files[f"{key}.html"]).text for key in ("strength", "doubt"))
    assert "upward grows ε, the strength of the perturbation" in strength
    assert "A still picture: along ε each orbit belongs to another system" in strength
    assert "A still picture: a live figure has no layers, and the picture shows one: Pixels to trust." in doubt
