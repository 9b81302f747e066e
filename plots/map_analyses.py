"""Results of the follow-up analyses of a map."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np

from engine import Fate, OriginFateMap, Regularity, RegularityMap, StableManifolds, Trust, TrustMap, describe_codes

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
        images: dict[str, tuple[np.ndarray, type[IntEnum]]] = {}
        if self.regularity is not None:
            images["character"] = self.regularity.character, Regularity
        if self.trust is not None:
            images["trust"] = self.trust.trust, Trust
        if self.origins is not None:
            images["origin"] = self.origins.origin, Fate
        dims = dataset["fate"].dims
        return dataset.assign({name: (dims, image, describe_codes(codes)) for name, (image, codes) in images.items()})


NO_ANALYSES = MapAnalyses()
"""No results."""
