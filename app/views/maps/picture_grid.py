"""The arrangement of the pictures: side by side, or one picture enlarged above a row of the other pictures."""

from __future__ import annotations

from collections.abc import Sequence

import panel as pn
from bokeh.plotting import figure

from app.state.view_state import ViewState
from app.views.components.plots import FigurePane, PictureTexts, set_borders
from app.views.components.texts import TextPane
from app.views.components.widgets import FULL_HEIGHT, SegmentedControl
from app.views.maps.well import SHORT_TITLE as WELL_TITLE
from plots.layers.table import LAYERS_BY_PICTURE, PICTURES

SHORT_TITLES = {"well": WELL_TITLE} | {name: picture.short_title for name, picture in PICTURES.items() if name != "curves"}
"""Short titles of all pictures, in order."""

FIRST_PICTURE = "basins"
"""The picture that is largest, or on narrow screens the only picture, until another is chosen."""

# Largest number of pictures of the same size. Among more pictures, one is twice as large as the others.
_MOST_EQUAL = 4
# Largest number of pictures of which one is twice as large; of more pictures, one is three times as large as the others.
_MOST_HALF = 6
# Kinds of pictures with axes, and a strip below them.
_WITH_STRIP = ("picked", "equal")
# Numbers of pictures that leave the last cell empty.
_WITH_GAP = (5, 7)


class PictureGrid:
    """Puts the pictures on the page and sets their CSS classes, by which the stylesheet places them.

    Parameters
    ----------
    state
        View state, whose `focus` names the picture that is shown large.
    alone
        Whether only the picture shown large is visible.
    """

    def __init__(self, state: ViewState, *, alone: bool = False) -> None:
        self._state = state
        self._panes: dict[str, FigurePane] = {}
        # Pictures that show nothing.
        self._empty_pictures: frozenset[str] = frozenset()
        # Before the first map, the pictures do not belong to the system.
        which = ["alone"] if alone else []
        classes = ["maps", "stale", *which]
        # Texts around pictures, and the kind of each picture on the page.
        self._texts: dict[str, PictureTexts] = {}
        self._kinds: dict[str, str] = {}
        self.strips = TextPane(css_classes=["strips", *which])
        self._column = pn.Column(sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT, css_classes=classes)
        self.picker = SegmentedControl(label="Map", css_classes=["segmented", "map-picker"])
        self.picker.param.watch(lambda event: self._choose(event.new), "value")
        state.param.watch(lambda *events: self._place(), ["focus", "narrow"])

    def layout(self) -> pn.viewable.Viewable:
        """Return the grid."""
        return self._column

    @property
    def shown(self) -> Sequence[str]:
        """Names of the pictures on the page."""
        return tuple(self._panes)

    def show(self, panes: dict[str, FigurePane]) -> None:
        """Put pictures on the page in this order, and remove other pictures: hidden pictures would be painted with each frame."""
        self._panes = panes
        self._place()

    def write(self, name: str, texts: PictureTexts) -> None:
        """Write around a picture. A compact or small picture has only its title, in short."""
        self._texts[name] = texts
        self._write_title(name)
        self._write_strips()

    def mark_empty(self, name: str, empty: bool) -> None:
        """Set whether a picture shows nothing. An empty picture of a layer does not become the largest picture."""
        empty_pictures = self._empty_pictures | {name} if empty else self._empty_pictures - {name}
        if empty_pictures != self._empty_pictures:
            self._empty_pictures = empty_pictures
            self._place()

    def mark_stale(self, stale: bool) -> None:
        """Grey out pictures that do not belong to the controls, or show them normally."""
        self._set_class("stale", stale)

    def _choose(self, name: str | None) -> None:
        # With None, or with the largest picture, the picker only follows the page.
        if name is not None and name != self._largest_picture:
            with pn.io.hold():
                self._state.focus = name

    @property
    def _largest_picture(self) -> str:
        """The largest picture: the enlarged picture, or else the picture of the last layer that shows something."""
        layers = [name for name in self._panes if name in LAYERS_BY_PICTURE and name not in self._empty_pictures]
        return self._state.focus if self._is_enlarged else [FIRST_PICTURE, *layers][-1]

    @property
    def _is_enlarged(self) -> bool:
        """Whether the chosen picture is on the page."""
        return self._state.focus in self._panes

    def _place(self) -> None:
        # A Bokeh pane on the page cannot change its CSS classes, but its figure can.
        largest = self._largest_picture
        is_enlarged = self._is_enlarged
        count = len(self._panes)
        is_many = count > _MOST_EQUAL
        other_kind = "small" if is_enlarged else "compact" if is_many else "equal"
        with pn.io.hold():
            self._set_class("enlarged", is_enlarged)
            self._set_class("many", is_many and not is_enlarged)
            self._set_class("crowded", count > _MOST_HALF and not is_enlarged)
            self._set_class("gap", count in _WITH_GAP and not is_enlarged)
            self._kinds = {name: "picked" if name == largest else other_kind for name in self._panes}
            for name, pane in self._panes.items():
                plot: figure = pane.object
                classes = ["well" if name == "well" else "map", self._kinds[name]]
                if plot.css_classes != classes:
                    plot.css_classes = classes
                    set_borders(plot, classes[1])
                    self._write_title(name)
            self._write_strips()
            self.picker.param.update(options={SHORT_TITLES[name]: name for name in self._panes}, value=largest)
            # A narrow page shows only one picture, and offers a choice.
            parts = [*([self.picker] if self._state.narrow else []), *self._panes.values(), self.strips]
            if parts != self._column.objects:
                self._column.objects = parts

    def _write_title(self, name: str) -> None:
        if name in self._kinds and name in self._texts:
            self._texts[name].write_above(self._panes[name].object, short=self._kinds[name] not in _WITH_STRIP)

    def _write_strips(self) -> None:
        kinds = {name: kind for name, kind in self._kinds.items() if name in self._texts}
        arrangements = " ".join({"many", "crowded", "enlarged"}.intersection(self._column.css_classes))
        strips = (
            f"<div class='foot legend {kind} {arrangements}' data-picture='{name}'>"
            f"{self._texts[name].below(is_largest=kind == 'picked')}</div>"
            for name, kind in kinds.items()
        )
        self.strips.object = "".join(strips)

    def _set_class(self, name: str, on: bool) -> None:
        """Set or remove a CSS class of the grid."""
        other_classes = [each for each in self._column.css_classes if each != name]
        classes = [*other_classes, name] if on else other_classes
        if classes != self._column.css_classes:
            self._column.css_classes = classes
