"""Results of the follow-up analyses of a map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from engine import OriginFateMap, RegularityMap, StableManifolds, TrustMap

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class MapAnalyses:
    """Results of follow-up analyses; None for analyses that were not requested or are not finished."""

    regularity: RegularityMap | None = None
    origins: OriginFateMap | None = None
    trust: TrustMap | None = None
    manifolds: StableManifolds | None = None

    def add_to(self, dataset: xr.Dataset) -> xr.Dataset:
        """Add the variables ``character``, ``trust`` and ``origin`` to the dataset of a map, as far as they are known."""
        analyses = {"character": self.regularity, "trust": self.trust, "origin": self.origins}
        return dataset.assign({name: found.to_xarray()[name].variable for name, found in analyses.items() if found is not None})


NO_ANALYSES = MapAnalyses()
"""No results."""
