"""The table of the fields of the view state in links: their names, their texts, and whether they belong to a system."""

from __future__ import annotations

from dataclasses import dataclass

from app.state.link_formats import (
    STARTS,
    SWITCH,
    TIMES,
    WATCHED,
    WINDOW,
    Format,
    choice_format,
    name_format,
    number_choice_format,
)
from app.state.view import Analysis
from app.state.view_state import IMAGE_CHOICES, LAYERS, PICTURES, ViewState, allowed_resolutions, allowed_t_max
from plots.pictures.palette import MOST_ORBITS, PALETTES


@dataclass(frozen=True)
class LinkField:
    """A field of the view state in a link.

    Attributes
    ----------
    attribute
        Of the view state; its default value is left out of links.
    name
        Of the parameter of the link.
    format
        Its text.
    of_system
        Whether its value has no meaning for another system.
    always
        Whether its default value is written, too.
    """

    attribute: str
    name: str
    format: Format
    of_system: bool = False
    always: bool = False

    @property
    def default(self) -> object:
        """The value of the first view."""
        return ViewState.param[self.attribute].default


def _sides() -> dict[str, int]:
    return {str(side): side for side in allowed_resolutions().values()}


# In the order of links; system, plane and energy precede them, and the view to compare with follows.
LINK_FIELDS = (
    LinkField("t_max", "t_max", number_choice_format(allowed_t_max), always=True),
    LinkField("resolution", "resolution", number_choice_format(_sides), always=True),
    LinkField("window", "window", WINDOW, of_system=True),
    LinkField("box", "box", WINDOW, of_system=True),
    *(LinkField(name, name, SWITCH) for name in LAYERS),
    LinkField("images", "images", choice_format(IMAGE_CHOICES)),
    LinkField("analysis", "analysis", choice_format({analysis.value: analysis for analysis in Analysis})),
    LinkField("watched", "watch", WATCHED),
    LinkField("focus", "focus", name_format(PICTURES)),
    LinkField("palette", "palette", name_format(PALETTES)),
    LinkField("lock_times", "lock_times", TIMES),
    LinkField("starts", "orbits", STARTS, of_system=True),
    LinkField("chosen", "look", choice_format({str(place + 1): place for place in range(MOST_ORBITS)}), of_system=True),
)
