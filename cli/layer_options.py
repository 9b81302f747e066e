"""Make options of a command from the layers of a map, and from the settings of the studies."""

from __future__ import annotations

import inspect
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Annotated, Any

import typer

from engine import MapSpec
from plots.layers.layer import Layer
from plots.layers.table import LAYERS, LAYERS_BY_PICTURE
from plots.pictures.setting import Setting, Settings
from plots.studies.table import STUDIES


@dataclass(frozen=True)
class LayerOptions:
    """The requested layers and their settings, given by the options of the layers in `LAYERS`.

    Attributes
    ----------
    values
        Values of the options, by name.
    """

    values: Mapping[str, Any] = field(default_factory=dict)

    @property
    def layers(self) -> list[Layer[Any]]:
        """The layers that are switched on."""
        return [layer for name, layer in LAYERS.items() if self.values.get(name)]

    @property
    def pictures(self) -> list[str]:
        """The pictures of the layers that are switched on."""
        return [layer.picture.name for layer in self.layers if layer.picture is not None]

    def with_pictures(self, pictures: Collection[str]) -> LayerOptions:
        """Return a copy that also requests the layers of some pictures."""
        picture_layers = {LAYERS_BY_PICTURE[picture].name: True for picture in pictures if picture in LAYERS_BY_PICTURE}
        return replace(self, values={**self.values, **picture_layers})

    def check(self, spec: MapSpec) -> None:
        """Raise ValueError if a layer is not defined for the map, or a setting is out of range."""
        for layer in self.layers:
            if sentence := layer.refusal(spec):
                raise ValueError(f"{layer.name}: {sentence}")
            # This raises the ValueError of a setting.
            layer.job(spec, self.values)


def read_layers(**values: Any) -> LayerOptions:
    """Return the requested layers and their settings from the values of options."""
    return LayerOptions(values)


_STUDY_SETTINGS = {setting.name: setting for study in STUDIES.values() for setting in study.settings}


def read_study_settings(**values: Any) -> Settings:
    """Return the settings of the studies from the values of options."""
    return {name: setting.choices[values[name]] for name, setting in _STUDY_SETTINGS.items()}


def _options_of(layer: Layer[Any]) -> list[inspect.Parameter]:
    """Return the option that switches a layer on, and those of its settings."""
    if layer.count is None:
        switch = _option(layer.name, bool, False, help=layer.help)
    else:
        switch = _option(layer.name, int, 0, help=layer.help, metavar=layer.count.metavar, min=0, max=layer.count.most)
    settings = [setting for setting in layer.settings if setting.help]
    return [switch, *(_option(each.name, type(each.default), each.default, help=each.help) for each in settings)]


def _choice_option(setting: Setting) -> inspect.Parameter:
    """Return the option of a setting whose value is the name of a choice."""
    # Typer lists the members of an enumeration in the help.
    names = StrEnum("names", list(setting.choices))  # type: ignore[misc]
    (default,) = (name for name in names if setting.choices[name] == setting.default)
    return _option(setting.name, names, default, help=setting.help)


def _option(name: str, kind: Any, default: Any, **marks: Any) -> inspect.Parameter:
    """Return an option as a parameter, given its type, its default and the arguments of `typer.Option`."""
    annotation = Annotated[kind, typer.Option(**marks)]
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation)


# `cli.options` makes options from these signatures.
read_layers.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
    [option for layer in LAYERS.values() for option in _options_of(layer)]
)
read_study_settings.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
    [_choice_option(setting) for setting in _STUDY_SETTINGS.values()]
)
