"""The results that the page shows. Its statistics, tables, files and figures use them."""

from __future__ import annotations

from types import MappingProxyType

import param

from engine import EscapeMap
from plots.layers.layer import NO_ANALYSES


class ShownResults(param.Parameterized):
    """The results for the view of one session. Each is None or empty until it is computed."""

    frame = param.Parameter(default=None, doc="the `engine.EscapeMap` in view, complete or not; None before its first frame")
    sharper_map = param.Parameter(default=None, doc="the complete map in view with more pixels; None until it is computed")
    analyses = param.Parameter(default=NO_ANALYSES, doc="complete results of the layers of the map, by name")
    orbits = param.Parameter(default=(), doc="a `StartOrbit` for each start")
    studies = param.Parameter(default=MappingProxyType({}), doc="results of the studies so far, by name")
    calls = param.Parameter(default=MappingProxyType({}), doc="calls that compute these results, see `Study.call`, by name")

    @property
    def whole_map(self) -> EscapeMap | None:
        """The map in view; None while it is computed."""
        frame: EscapeMap | None = self.frame
        return frame if frame is not None and frame.complete else None

    @property
    def drawn_map(self) -> EscapeMap | None:
        """The map with the most pixels; None while it is computed. With layers, which have no more pixels, the map in view."""
        return self.whole_map if self.analyses or self.sharper_map is None else self.sharper_map
