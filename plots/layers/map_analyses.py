"""Results of the layers of a map."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from plots.layers.table import LAYERS

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class MapAnalyses(Mapping[str, Any]):
    """Complete results of layers, by name. Layers that were not requested or are not finished are missing."""

    results: Mapping[str, Any] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Any:
        return self.results[name]

    def __iter__(self) -> Iterator[str]:
        return (name for name in LAYERS if name in self.results)

    def __len__(self) -> int:
        return len(self.results)

    def with_result(self, name: str, result: Any) -> MapAnalyses:
        """Return a copy in which a layer has another result; None removes the result."""
        other_results = {other: each for other, each in self.results.items() if other != name}
        return MapAnalyses(other_results if result is None else {**other_results, name: result})

    def describe(self) -> list[str]:
        """Return a sentence for each result."""
        return [result.describe() for result in self.values()]

    def add_to(self, dataset: xr.Dataset) -> xr.Dataset:
        """Add the variables of the layers, such as ``character`` and ``origin``, to the dataset of a map."""
        variables = {
            name: result.to_xarray()[name].variable for layer, result in self.items() for name in LAYERS[layer].variables
        }
        return dataset.assign(variables)


NO_ANALYSES = MapAnalyses()
"""No results."""
