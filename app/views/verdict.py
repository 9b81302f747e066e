"""The start of an orbit in numbers, and the verdict on it in words."""

from __future__ import annotations

from collections.abc import Callable

import panel as pn
import panel_material_ui as pmui

from app.palette import QUIET_TEXT
from engine import Orbit, Plane

HINT = "Click a point of any map, or type a start, to see its orbit, its SALI and its R²."


class VerdictView:
    """Numeric boxes for a start, a button, and the verdict; `on_start(x, ordinate)` is what the button does."""

    def __init__(self, on_start: Callable[[float, float], None]) -> None:
        self._on_start = on_start
        number = "0.[0000000000000000]"
        self.x = pmui.FloatInput(label="x", value=0.0, step=0.01, format=number, width=300, size="small")
        self.ordinate = pmui.FloatInput(label="px", value=0.0, step=0.01, format=number, width=300, size="small")
        self.button = pmui.Button(label="Integrate this start", variant="contained", size="small", width=300)
        self.text = pn.pane.HTML(HINT, name="verdict", sizing_mode="stretch_width")
        self.button.on_click(lambda event: self._submit())

    def layout(self) -> pn.viewable.Viewable:
        """A column as wide as a picture."""
        title = pn.pane.HTML("<b>One orbit</b>", styles={"font-size": "15px"})
        return pn.Column(title, self.x, self.ordinate, self.button, self.text, width=340, margin=(0, 6))

    def follow_plane(self, plane: Plane) -> None:
        """Name the second box after the plane's ordinate and forget the last verdict."""
        self.ordinate.label = plane.ordinate
        self.text.object = HINT

    def expect(self, start: tuple[float, float]) -> None:
        """An orbit has been asked for."""
        self.x.value, self.ordinate.value = start
        self.text.object = "Integrating …"

    def say(self, sentence: str) -> None:
        """A sentence instead of a verdict."""
        self.text.object = f"<p><b>{sentence}</b></p>"

    def show(self, orbit: Orbit) -> None:
        """The verdict, and the numbers it rests on."""
        rows = {
            "energy h": f"{orbit.energy:.10g}",
            "start x, y": f"{orbit.x[0]:.6g}, {orbit.y[0]:.6g}",
            "start px, py": f"{orbit.px[0]:.6g}, {orbit.py[0]:.6g}",
            "upward crossings of y = 0": f"{orbit.crossings}",
            "last SALI": f"{orbit.sali[-1]:.3g}",
            "relative energy error": f"{orbit.energy_error:.1e}",
        }
        cells = "".join(
            f"<tr><td style='padding-right:12px;color:{QUIET_TEXT}'>{name}</td><td>{value}</td></tr>"
            for name, value in rows.items()
        )
        self.text.object = f"<p><b>{orbit.describe()}</b></p><table style='font-size:13px'>{cells}</table>"

    def _submit(self) -> None:
        if self.x.value is None or self.ordinate.value is None:
            self.say("Type a number into both boxes first.")
            return
        self._on_start(self.x.value, self.ordinate.value)
