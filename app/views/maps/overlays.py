"""Results of follow-up analyses over the pictures: doubtful pixels and stable manifolds."""

from __future__ import annotations

from typing import Any

import numpy as np
from bokeh.models import ColumnDataSource, Image, LinearColorMapper, MultiLine
from bokeh.plotting import figure

from app.views.components.plots import batched_additions
from engine import MapSpec, StableManifolds, TrustMap
from plots.pictures.image_columns import doubt_tones
from plots.pictures.manifold_strokes import manifold_strokes
from plots.pictures.palette import DOUBT, LIGHT, PAPER, Entry, Palette

_CLEAR = "#00000000"
# The tones as a CSS background.
_CHESSBOARD = f"repeating-conic-gradient({DOUBT[0]} 0 25%, {DOUBT[1]} 0 50%) 0 0/6px 6px"


class Overlays:
    """Sources of the overlays of one map; each is added to the figures when it is first shown."""

    def __init__(self) -> None:
        # Figures that an overlay is still to be added to.
        self._without_doubts: list[figure] = []
        self._without_manifolds: list[figure] = []
        self.doubts = ColumnDataSource(_no_doubts(), name="doubts")
        self.manifolds = ColumnDataSource(_no_curves(), name="manifolds")
        self._mapper = LinearColorMapper(palette=[_CLEAR, *DOUBT], low=-0.5, high=2.5)
        self._palette = PAPER
        self._manifolds_shown: StableManifolds | None = None
        self._spec: MapSpec | None = None

    def draw(self, plot: figure, *, doubts: bool, manifolds: bool) -> None:
        """Draw some of the overlays into a figure."""
        self._without_doubts += [plot] if doubts else []
        self._without_manifolds += [plot] if manifolds else []

    def _draw_doubts(self) -> None:
        plots, self._without_doubts = self._without_doubts, []
        with batched_additions(plots):
            for plot in plots:
                plot.add_glyph(self.doubts, Image(image="doubt", dw="dw", dh="dh", color_mapper=self._mapper))

    def _draw_manifolds(self) -> None:
        plots, self._without_manifolds = self._without_manifolds, []
        halo = {"line_color": LIGHT.halo, "line_width": "halo_width", "line_alpha": "halo_alpha"}
        stroke = {"line_color": "colour", "line_width": "width", "line_alpha": "alpha"}
        with batched_additions(plots):
            for plot in plots:
                for style in (halo, stroke):
                    plot.add_glyph(self.manifolds, MultiLine(**style))

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
            window = trust.spec.find_window()
            self.doubts.data = {
                "doubt": [doubt_tones(trust)], "trust": [trust.trust.astype(np.uint8)],
                "x": [window.x_low], "y": [window.ordinate_low],
                "dw": [window.x_high - window.x_low], "dh": [window.ordinate_high - window.ordinate_low],
            }  # fmt: skip
        elif self.doubts.data["x"]:
            self.doubts.data = _no_doubts()

    def show_manifolds(self, manifolds: StableManifolds | None) -> None:
        """Draw the manifolds in the colours of their channels; None removes them."""
        self._manifolds_shown = manifolds
        if manifolds is not None:
            self._draw_manifolds()
            strokes = [(arc, stroke) for stroke in manifold_strokes(manifolds) for arc in stroke.arcs]
            self.manifolds.data = {
                "xs": [arc.x for arc, _ in strokes],
                "ys": [arc.px for arc, _ in strokes],
                "colour": [self._palette.channels[arc.channel - 1] for arc, _ in strokes],
                "width": [stroke.width for _, stroke in strokes],
                "alpha": [stroke.alpha for _, stroke in strokes],
                "halo_width": [stroke.halo_width for _, stroke in strokes],
                # The browser also draws lines of width 0.
                "halo_alpha": [float(stroke.halo_width > 0.0) for _, stroke in strokes],
            }
        elif self.manifolds.data["xs"]:
            self.manifolds.data = _no_curves()

    def set_palette(self, palette: Palette) -> None:
        """Set the colours of the channels."""
        self._palette = palette
        self.show_manifolds(self._manifolds_shown)

    def entries(self) -> list[Entry]:
        """Legend entries of the overlays in view."""
        doubtful = [Entry("doubtful pixels", _CHESSBOARD)] if self.doubts.data["x"] else []
        return doubtful + (self._palette.manifold_entries(self._manifolds_shown) if self._manifolds_shown is not None else [])


def _no_doubts() -> dict[str, list[Any]]:
    return {name: [] for name in ("doubt", "trust", "x", "y", "dw", "dh")}


def _no_curves() -> dict[str, list[Any]]:
    return {name: [] for name in ("xs", "ys", "colour", "width", "alpha", "halo_width", "halo_alpha")}
