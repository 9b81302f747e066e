"""Define a setting of a layer or a study: a choice among a few values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

Settings = Mapping[str, Any]
"""Values of settings, by name. Missing settings have their defaults."""

NO_SETTINGS: Settings = MappingProxyType({})
"""The defaults of all settings."""


@dataclass(frozen=True)
class Setting:
    """A setting of how a layer is computed or drawn, or of how a study is drawn.

    Attributes
    ----------
    name
        Name in links and on the command line.
    title
        Label of the setting on the page, for screen readers.
    word
        Text before the first choice.
    choices
        Values, by their names in links.
    default
        Default value, one of `choices`.
    help
        Help of the option on the command line; empty for a setting of the page only.
    """

    name: str
    title: str
    word: str
    choices: Mapping[str, Any]
    default: Any
    help: str = ""

    def value_in(self, settings: Settings) -> Any:
        """Return the value of this setting among those of all settings."""
        return settings.get(self.name, self.default)
