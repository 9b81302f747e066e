"""What second looks have found out about a whole map."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import xarray as xr

from engine import Fate, OriginFateMap, Regularity, RegularityMap, StableManifolds, Trust, TrustMap, describe_codes


@dataclass(frozen=True)
class MapAnalyses:
    """The answers that are here; None for what was not asked, or is on its way."""

    regularity: RegularityMap | None = None
    origins: OriginFateMap | None = None
    trust: TrustMap | None = None
    manifolds: StableManifolds | None = None

    def add_to(self, dataset: xr.Dataset) -> xr.Dataset:
        """The dataset of the map with ``character``, ``trust`` and ``origin``, as far as they are here."""
        found: dict[str, tuple[np.ndarray, type[IntEnum]]] = {}
        if self.regularity is not None:
            found["character"] = self.regularity.character, Regularity
        if self.trust is not None:
            found["trust"] = self.trust.trust, Trust
        if self.origins is not None:
            found["origin"] = self.origins.origin, Fate
        dims = dataset["fate"].dims
        return dataset.assign({name: (dims, image, describe_codes(codes)) for name, (image, codes) in found.items()})


NO_ANALYSES = MapAnalyses()
"""Of a map that nobody has looked at again."""
