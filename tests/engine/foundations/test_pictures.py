"""Who draws results: the package whose entry point says so."""

from __future__ import annotations

import importlib.metadata
from collections.abc import Iterator

import pytest

from engine import CASES
from engine.foundations import pictures


@pytest.fixture(autouse=True)
def forgotten() -> Iterator[None]:
    pictures.load_pictures.cache_clear()
    yield
    pictures.load_pictures.cache_clear()


def test_the_installed_package_draws_results() -> None:
    assert "<img" in CASES["I"]._repr_html_()


def test_any_package_can_draw_results(monkeypatch: pytest.MonkeyPatch) -> None:
    entry = importlib.metadata.EntryPoint("mine", "types:SimpleNamespace.__name__", pictures.GROUP)
    monkeypatch.setattr(pictures, "entry_points", lambda group: [entry] if group == pictures.GROUP else [])
    assert pictures.load_pictures() == "SimpleNamespace"


def test_without_a_package_that_draws_the_error_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pictures, "entry_points", lambda group: [])
    with pytest.raises(RuntimeError, match="install escape-explorer"):
        CASES["I"].plot()
