"""Make options of a command from the layers of a map."""

from __future__ import annotations

import inspect
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Any

import typer

from engine import MapSpec
from plots.layers.layer import Layer, Setting
from plots.layers.table import LAYERS, LAYERS_BY_PICTURE


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


def _list_options(layers: Iterable[Layer[Any]]) -> list[inspect.Parameter]:
    """Return the options of the layers and of their settings, as parameters."""
    options = []
    for layer in layers:
        options.append(_option(layer.name, *_layer_option(layer)))
        options += [_option(setting.name, *_setting_option(setting)) for setting in layer.settings if setting.help]
    return options


def _option(name: str, kind: Any, default: Any) -> inspect.Parameter:
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kind)


def _layer_option(layer: Layer[Any]) -> tuple[Any, Any]:
    """Return the type and the default of the option that switches a layer on."""
    if layer.count is None:
        return Annotated[bool, typer.Option(help=layer.help)], False
    return Annotated[int, typer.Option(help=layer.help, metavar=layer.count.metavar, min=0, max=layer.count.most)], 0


def _setting_option(setting: Setting) -> tuple[Any, Any]:
    return Annotated[type(setting.default), typer.Option(help=setting.help)], setting.default


# `cli.options` makes options from this signature.
read_layers.__signature__ = inspect.Signature(_list_options(LAYERS.values()))  # type: ignore[attr-defined]
