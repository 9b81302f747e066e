"""The page: where each view of an explorer stands."""

from __future__ import annotations

from html import escape

import panel as pn
import panel_material_ui as pmui
import param
from panel.util import edit_readonly

from app.bokeh_patches.echoes import echo_filter
from app.rendering.mathml import equations
from app.session.explorer import Explorer
from app.state.system import SYSTEM
from app.views.components.flex_row import flex_row
from app.views.panels.keyboard import key_legend

_ON_BLUE = {"textTransform": "none", "color": "#ffffff", "fontSize": "15px"}
# Maps are read along their axes, so figures keep them.
_THEME = {"chart_style": "standard"}


class _Idle(param.Parameterized):
    """A state of its own that is never busy."""

    busy = param.Boolean(default=False)


def explorer_page(explorer: Explorer) -> pmui.Page:
    """The whole page of one visitor."""
    gallery = explorer.gallery.layout()
    gallery.visible = False
    main = pn.Column(
        gallery,
        explorer.controls.layout(),
        explorer.potential.panel.layout(),
        explorer.why.switches.layout(),
        explorer.progress.layout(),
        explorer.zoom_buttons.layout(),
        explorer.why.notes,
        explorer.maps.layout(),
        _row(explorer.desk.layout(explorer.time_bar.layout()), explorer.orbit_row.layout()),
        _row(*explorer.numbers.layout()),
        explorer.why.measures.section.layout(),
        explorer.why.curves.section.layout(),
        explorer.take_along.layout(),
        _equations(explorer),
        pn.pane.HTML(f"<details><summary>Keys</summary>{key_legend()}</details>", margin=(4, 10)),
        explorer.words.layout(),
        explorer.keyboard.layout(),
        echo_filter(),
        explorer.tour.layout(),
        sizing_mode="stretch_width",
        margin=(0, 10),
    )
    page = pmui.Page(
        title="Escape Explorer", main=[main], header=[_header(explorer, gallery)], busy_indicator=None, theme_config=_THEME
    )
    # A page that shows how busy the server is looks through all its models at the begin and end of every callback, which
    # takes 50 ms each, and the server's state, which outlives every session, would hold on to the page for it.
    with edit_readonly(page):
        page.busy = _Idle().param.busy
    page.param.watch(lambda event: explorer.set_dark(event.new), "dark_theme")
    return page


def _row(*columns: pn.viewable.Viewable) -> pn.FlexBox:
    return flex_row(*columns, justify_content="center", gap="4px")


def _header(explorer: Explorer, gallery: pn.viewable.Viewable) -> pn.viewable.Viewable:
    """Buttons at the top: where beginners begin."""
    buttons = [pmui.Button(label=label, variant="text", size="small", sx=_ON_BLUE) for label in ("Gallery", "Tour")]
    buttons[0].on_click(lambda event: gallery.param.update(visible=not gallery.visible))
    buttons[1].on_click(lambda event: explorer.tour.start())
    return pn.Row(*buttons, margin=(0, 20))


def _equations(explorer: Explorer) -> pn.pane.HTML:
    """The equations of the chosen case, folded away until they are wanted."""
    state = explorer.state

    def written() -> str:
        return f"<details><summary>Equations: {escape(state.system.title)}</summary>{equations(state.potential)}</details>"

    pane = pn.pane.HTML(written(), margin=(4, 10), sizing_mode="stretch_width")
    state.param.watch(lambda *events: pane.param.update(object=written()), list(SYSTEM))
    return pane
