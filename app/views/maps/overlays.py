"""Results of follow-up analyses over the pictures: doubtful pixels and stable manifolds."""

from __future__ import annotations

from typing import Any

import numpy as np
from bokeh.models import ColumnDataSource, Image, LinearColorMapper, MultiLine
from bokeh.plotting import figure

from app.rendering.palette import DOUBT, LIGHT, MANIFOLD, PAPER, Entry, Palette
from engine import MapSpec, StableManifolds, Trust, TrustMap

_CLEAR = "#00000000"
# Of the first, the second and all later images of the manifolds, which lie ever closer together.
_WIDTHS, _ALPHAS = (1.6, 0.8, 0.5), (1.0, 0.55, 0.3)
_HALO_WIDTH = 3.2


class Overlays:
    """Sources of the overlays of one map; each is added to the figures when it is first shown."""

    def __init__(self) -> None:
        # Figures that an overlay is still to be added to; those of the manifolds with `coloured`.
        self._without_doubts: list[figure] = []
        self._without_manifolds: list[tuple[figure, bool]] = []
        self.doubts = ColumnDataSource(_no_doubts(), name="doubts")
        self.manifolds = ColumnDataSource(_no_curves(), name="manifolds")
        self._mapper = LinearColorMapper(palette=[_CLEAR, DOUBT], low=-0.5, high=1.5)
        self._palette = PAPER
        self._manifolds_shown: StableManifolds | None = None
        self._spec: MapSpec | None = None

    def draw(self, plot: figure, *, doubts: bool, coloured: bool) -> None:
        """Draw into a figure; `coloured` manifolds have the colour of their channel, others are dark with a halo."""
        if doubts:
            self._without_doubts.append(plot)
        self._without_manifolds.append((plot, coloured))

    def _draw_doubts(self) -> None:
        plots, self._without_doubts = self._without_doubts, []
        for plot in plots:
            plot.add_glyph(self.doubts, Image(image="doubt", dw="dw", dh="dh", color_mapper=self._mapper))

    def _draw_manifolds(self) -> None:
        plots, self._without_manifolds = self._without_manifolds, []
        style: dict[str, Any] = {"line_width": "width", "line_alpha": "alpha"}
        for plot, coloured in plots:
            if not coloured:
                plot.add_glyph(self.manifolds, MultiLine(line_color=LIGHT.halo, line_width="halo_width", line_alpha="alpha"))
            plot.add_glyph(self.manifolds, MultiLine(line_color="colour" if coloured else MANIFOLD, **style))

    def begin(self, spec: MapSpec) -> None:
        """Remove the overlays if the map is another one."""
        if spec == self._spec:
            return
        self._spec = spec
        self.show_trust(None)
        self.show_manifolds(None)

    def show_trust(self, trust: TrustMap | None) -> None:
        """Mark the doubtful pixels; None removes the marks."""
        if trust is not None:
            self._draw_doubts()
            window = trust.spec.window
            self.doubts.data = {
                "doubt": [(trust.trust == Trust.DOUBTFUL).astype(np.uint8)],
                "x": [window.x_low], "y": [window.ordinate_low],
                "dw": [window.x_high - window.x_low], "dh": [window.ordinate_high - window.ordinate_low],
            }  # fmt: skip
        elif self.doubts.data["x"]:
            self.doubts.data = _no_doubts()

    def show_manifolds(self, manifolds: StableManifolds | None) -> None:
        """Draw the manifolds; None removes them."""
        self._manifolds_shown = manifolds
        if manifolds is not None:
            self._draw_manifolds()
            # The first image is drawn last, over the others.
            arcs = sorted(manifolds.arcs, key=lambda arc: -arc.image)
            self.manifolds.data = {
                "xs": [arc.x for arc in arcs],
                "ys": [arc.px for arc in arcs],
                "colour": [self._palette.channels[arc.channel - 1] for arc in arcs],
                "width": [_WIDTHS[min(arc.image, len(_WIDTHS)) - 1] for arc in arcs],
                "alpha": [_ALPHAS[min(arc.image, len(_ALPHAS)) - 1] for arc in arcs],
                "halo_width": [_HALO_WIDTH if arc.image == 1 else 0.0 for arc in arcs],
            }
        elif self.manifolds.data["xs"]:
            self.manifolds.data = _no_curves()

    def set_palette(self, palette: Palette) -> None:
        """Set the colours of the channels."""
        self._palette = palette
        self.show_manifolds(self._manifolds_shown)

    def entries(self) -> list[Entry]:
        """Legend entries of the overlays in view."""
        entries = [Entry("doubtful", DOUBT)] if self.doubts.data["x"] else []
        return entries + ([Entry("stable manifolds", MANIFOLD)] if self._manifolds_shown is not None else [])


def _no_doubts() -> dict[str, list[Any]]:
    return {name: [] for name in ("doubt", "x", "y", "dw", "dh")}


def _no_curves() -> dict[str, list[Any]]:
    return {name: [] for name in ("xs", "ys", "colour", "width", "alpha", "halo_width")}
