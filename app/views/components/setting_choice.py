"""Radio buttons for a setting of a layer or a study."""

from __future__ import annotations

from typing import Any

import panel as pn

from app.state.view_state import ViewState
from app.views.components.widgets import SegmentedControl
from plots.pictures.setting import Setting


def setting_choice(state: ViewState, setting: Setting) -> SegmentedControl:
    """Return radio buttons that write a setting to the view state and follow it."""

    def write(value: Any) -> None:
        # Without a chosen option, the widget only follows the state.
        if value in setting.choices.values():
            with pn.io.hold():
                state.param.update(settings={**state.settings, setting.name: value})

    # The first label also has the word of the setting.
    (first_label, first_value), *other_options = (
        (name.replace("_", " ").capitalize(), value) for name, value in setting.choices.items()
    )
    labels = {f"{setting.word} {first_label}": first_value, **dict(other_options)}
    choice = SegmentedControl(label=setting.title, options=labels, margin=(6, 10))
    state.follow(lambda settings: choice.param.update(value=settings[setting.name]), "settings")
    choice.param.watch(lambda event: write(event.new), "value")
    return choice
