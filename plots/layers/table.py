"""All layers and all pictures of a map."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from engine.foundations.plug_ins import Entries, Group
from plots.layers.descriptors import DESCRIPTORS
from plots.layers.escapes import BASINS, COMPARED, CROSSINGS, CURVES, DIFFERENCES, TIMES
from plots.layers.layer import Layer
from plots.layers.manifolds import MANIFOLDS
from plots.layers.origins import ORIGINS
from plots.layers.periodic_orbits import PERIODIC_ORBITS
from plots.layers.picture import Legend, Picture, ShownMap
from plots.layers.regularity import REGULARITY
from plots.layers.trust import TRUST
from plots.pictures.palette import Entry

_LAYERS: tuple[Layer[Any], ...] = (REGULARITY, TRUST, PERIODIC_ORBITS, MANIFOLDS, ORIGINS, DESCRIPTORS)
# The pictures of a map before and after those of the layers.
_FIRST_PICTURES, _LAST_PICTURES = (CURVES, BASINS, TIMES, CROSSINGS), (COMPARED, DIFFERENCES)


def _names_of(layer: Layer[Any]) -> set[str]:
    """Return the names of a layer and of its picture."""
    return {layer.name, *([] if layer.picture is None else [layer.picture.name])}


LAYERS: Mapping[str, Layer[Any]] = Entries(
    Group.LAYERS, Layer, _LAYERS, names=_names_of, reserved=[picture.name for picture in (*_FIRST_PICTURES, *_LAST_PICTURES)]
)
"""The layers by name, in the order of their switches, with those of other packages."""

LAYERS_BY_PICTURE = MappingProxyType({layer.picture.name: layer for layer in LAYERS.values() if layer.picture is not None})
"""The layers that have a picture, by the name of the picture."""

_PICTURES = (*_FIRST_PICTURES, *(layer.picture for layer in LAYERS.values() if layer.picture is not None), *_LAST_PICTURES)

PICTURES: Mapping[str, Picture] = MappingProxyType({picture.name: picture for picture in _PICTURES})
"""The pictures by name."""

TITLES = MappingProxyType({name: picture.title for name, picture in PICTURES.items() if not picture.compares})
"""Titles of the pictures that figures can show: all except comparisons."""


def map_legend(picture: str, shown: ShownMap) -> Legend:
    """Return the legend of a picture of a map, with the entries of the layers that are drawn over it."""
    over: list[Entry] = []
    for name, result in shown.results.items():
        marks = LAYERS[name].over_picture(picture)
        if marks is not None:
            over += marks.legend(result, shown.palette)
    return replace(PICTURES[picture].legend(shown), over=over)
