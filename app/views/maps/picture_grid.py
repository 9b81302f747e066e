"""The arrangement of the pictures: two large pictures above a row of the others, or one enlarged picture above all others."""

from __future__ import annotations

from collections.abc import Sequence

import panel as pn
from bokeh.plotting import figure

from app.state.view import Analysis
from app.state.view_state import ViewState
from app.state.watched_starts import WATCH_KEY
from app.views.components.plots import FigurePane, PictureTexts, set_borders
from app.views.components.texts import TextPane
from app.views.components.widgets import FULL_HEIGHT, SegmentedControl
from app.views.maps.well import SHORT_TITLE as WELL_TITLE
from engine.foundations.wording import format_whole
from plots.layers.table import LAYERS_BY_PICTURE, PICTURES
from plots.texts.typeset import typeset

SHORT_TITLES = {"well": WELL_TITLE} | {name: picture.short_title for name, picture in PICTURES.items() if name != "curves"}
"""Short titles of all pictures, in order."""

FIRST_PICTURE = "basins"
"""The only picture of a narrow page, until another is chosen."""

# Number of pictures of the first row, which are the well and the basins, or the maps of two views.
_LARGE = 2
# Arrangement and kind of the other pictures, by their number: with whole titles, with short titles, without axes.
_OTHERS = {1: ("two", "half"), 2: ("two", "half"), 3: ("three", "third"), 4: ("four", "compact")}
# The same for more pictures, which have no legends.
_MORE = ("many", "compact")
_ARRANGEMENTS = {"enlarged", _MORE[0], *(arrangement for arrangement, _ in _OTHERS.values())}
# Number of characters above the frame, of the title and of what is being computed, by the kind of the picture. Pictures of other
# kinds have short titles.
_ROOM_FOR_TITLE = {"picked": 60, "equal": 60, "half": 22}
# The pictures that show many orbits.
_WITH_ORBITS = ("well", FIRST_PICTURE)


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
        self._is_single = alone
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
        state.param.watch(lambda event: self._follow_analysis(), "analysis")

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
        """Write around a picture. A compact picture has a short title and no axes, and a small picture has only its title."""
        self._texts[name] = texts
        self._write_title(name)
        self._write_strips()

    def mark_empty(self, name: str, empty: bool) -> None:
        """Set whether a picture shows nothing. The picture of a layer is not picked while it is empty."""
        empty_pictures = self._empty_pictures | {name} if empty else self._empty_pictures - {name}
        if empty_pictures != self._empty_pictures:
            self._empty_pictures = empty_pictures
            self._place()

    def mark_stale(self, stale: bool) -> None:
        """Grey out pictures that do not belong to the controls, or show them normally."""
        self._set_classes({"stale"}, *["stale"] * stale)

    def _choose(self, name: str | None) -> None:
        # With None, or with the picked picture, the picker only follows the page.
        if name is not None and name != self._picked_picture:
            with pn.io.hold():
                self._state.focus = name

    def _follow_analysis(self) -> None:
        self._place()
        for name in self._panes:
            self._write_title(name)

    @property
    def _picked_picture(self) -> str:
        """The enlarged picture. On a page with a single picture, else the well if orbits leave it, or that of the last layer."""
        if self._is_enlarged:
            return self._state.focus
        if self._state.narrow and self._state.analysis == Analysis.WATCH:
            return "well"
        layers = [name for name in self._panes if name in LAYERS_BY_PICTURE and name not in self._empty_pictures]
        return [FIRST_PICTURE, *(layers if self._is_single or self._state.narrow else [])][-1]

    @property
    def _is_enlarged(self) -> bool:
        """Whether the chosen picture is on the page."""
        return self._state.focus in self._panes

    def _place(self) -> None:
        # A Bokeh pane on the page cannot change its CSS classes, but its figure can.
        arrangement, other_kind = _OTHERS.get(len(self._panes) - _LARGE, _MORE)
        if self._is_enlarged:
            arrangement, other_kind = "enlarged", "small"
        large = () if self._is_enlarged else tuple(self._panes)[:_LARGE]
        kinds = {name: "equal" if name in large else other_kind for name in self._panes}
        self._kinds = kinds | {name: "picked" for name in kinds if name == self._picked_picture}
        with pn.io.hold():
            # Bokeh computes the layout when figures change, so the places of the figures and the strips must be final before.
            self._set_classes(_ARRANGEMENTS, arrangement)
            self._write_strips()
            for name, pane in self._panes.items():
                plot: figure = pane.object
                classes = ["well" if name == "well" else "map", self._kinds[name]]
                if plot.css_classes != classes:
                    plot.css_classes = classes
                    set_borders(plot, classes[1])
                    self._write_title(name)
            self.picker.param.update(options={SHORT_TITLES[name]: name for name in self._panes}, value=self._picked_picture)
            # A narrow page shows only one picture, and offers a choice.
            parts = [*([self.picker] if self._state.narrow else []), *self._panes.values(), self.strips]
            if parts != self._column.objects:
                self._column.objects = parts

    def _write_title(self, name: str) -> None:
        if name in self._kinds and name in self._texts:
            kind = self._kinds[name]
            button = self._watch_button() if kind == "picked" and name in _WITH_ORBITS else ""
            self._texts[name].write_above(self._panes[name].object, room=_ROOM_FOR_TITLE.get(kind, 0), button=button)

    def _watch_button(self) -> str:
        """Return the HTML of the button that plays many orbits of one energy; empty on other slices, or beside their player."""
        state = self._state
        if state.analysis == Analysis.WATCH or state.plane.energy_axis is not None or state.plane.parameter is not None:
            return ""
        leave = typeset(f" {format_whole(state.watched.count)} leave")
        attributes = f"type='button' class='watch' data-key='{WATCH_KEY}' title='Watch{leave}' aria-label='Watch{leave}'"
        return f"<button {attributes}>▶ Watch<span>{leave}</span></button>"

    def _write_strips(self) -> None:
        kinds = {name: kind for name, kind in self._kinds.items() if name in self._texts}
        [arrangement] = _ARRANGEMENTS.intersection(self._column.css_classes) or [""]
        strips = (
            f"<div class='foot legend {kind} {arrangement}' data-picture='{name}'>"
            f"{self._texts[name].below(is_picked=kind == 'picked')}</div>"
            for name, kind in kinds.items()
        )
        self.strips.object = "".join(strips)

    def _set_classes(self, old: set[str], *new: str) -> None:
        """Replace CSS classes of the grid."""
        classes = [*(each for each in self._column.css_classes if each not in old), *new]
        if classes != self._column.css_classes:
            self._column.css_classes = classes
