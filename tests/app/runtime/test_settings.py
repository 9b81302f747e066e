"""Settings are read from environment variables, and invalid values refused."""

from __future__ import annotations

from dataclasses import fields

import pytest

from app.runtime.settings import LogFormat, Settings, read_settings, variable_name


def test_missing_and_empty_variables_keep_defaults() -> None:
    assert read_settings({"PATH": "/bin", "ESCAPE_EXPLORER_CACHE": "/tmp", "ESCAPE_EXPLORER_LOG": ""}) == Settings()


def test_variables_are_read() -> None:
    settings = read_settings(
        {
            "ESCAPE_EXPLORER_LONGEST_T_MAX": "1e5",
            "ESCAPE_EXPLORER_MOST_SESSIONS": "3",
            "ESCAPE_EXPLORER_LOG": "json",
            "ESCAPE_EXPLORER_BOKEH_PATCHES": "No",
            "ESCAPE_EXPLORER_FRAME_ANCESTORS": "https://a.example",
        }
    )
    assert (settings.longest_t_max, settings.most_sessions, settings.log) == (1e5, 3, LogFormat.JSON)
    assert settings.bokeh_patches is False
    assert settings.frame_ancestors == ("https://a.example",)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("largest_resolution", "15"),
        ("longest_t_max", "nan"),
        ("most_sessions", "0"),
        ("cache_bytes", "1e9"),
        ("threads", "two"),
        ("log", "xml"),
        ("frame_ancestors", "https://a.example; script-src *"),
        ("bokeh_patches", "maybe"),
    ],
)
def test_invalid_values_are_rejected_by_name(name: str, text: str) -> None:
    with pytest.raises(ValueError, match=f"^{variable_name(name)}=.*: must be "):
        read_settings({variable_name(name): text})


def test_every_setting_has_a_parser() -> None:
    assert all("parser" in setting.metadata for setting in fields(Settings))


@pytest.mark.parametrize(
    ("host", "may_embed"), [("127.0.0.1", True), ("localhost", True), ("explorer.example", False), ("", False)]
)
def test_pages_of_this_computer_may_embed_the_page_of_a_server_on_it(host: str, may_embed: bool) -> None:
    assert bool(Settings().ancestors_at(host)) == may_embed
    assert Settings(frame_ancestors=("https://a.example",)).ancestors_at(host) == ("https://a.example",)
