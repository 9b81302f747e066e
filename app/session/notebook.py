"""The page in a notebook, served by this process to a frame in the cell."""

from __future__ import annotations

import asyncio
import html
import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import panel as pn

from app.session.explorer import Explorer as SessionExplorer
from app.session.page import TITLE, explorer_page
from app.state.permalink import write_link
from app.state.view_state import ViewState
from engine import POTENTIALS, EscapeMap, MapSpec, Orbit, System, compute_map, write_formula
from engine.systems.system import TYPED

# Longest time until the server has started, in seconds.
_START_SECONDS = 60.0

# Resolution and largest t_max of the map that is shown where the page cannot be reached.
_PICTURE_RESOLUTION, _PICTURE_T_MAX = (112, 112), 1e3


class Explorer:
    """The live page in a notebook cell; show it as the last line of a cell.

    The page runs in this process and uses the same threads and cache as later calls in the notebook. The browser must reach this
    machine, as with a local JupyterLab. Elsewhere, and in a saved notebook, the cell shows a coarse map instead.

    Parameters
    ----------
    spec
        The map to open: its potential, plane, energy and window, and the nearest choices of t_max and of columns; None for the
        first view of the page.
    height
        Height of the frame in the cell, in pixels.
    """

    def __init__(self, spec: MapSpec | None = None, *, height: int = 900) -> None:
        self.height = height
        view = ViewState() if spec is None else _view_of(spec)
        self._link = "" if spec is None else write_link(view)
        self._picture_spec = replace(view.map_spec(), resolution=_PICTURE_RESOLUTION, t_max=min(view.t_max, _PICTURE_T_MAX))
        self._session: SessionExplorer | None = None
        self._port = 0
        self._started = threading.Event()
        threading.Thread(target=self._serve, name="explorer", daemon=True).start()
        if not self._started.wait(_START_SECONDS):
            raise RuntimeError("the server of the page did not start")

    @property
    def address(self) -> str:
        """Address of the page, for a browser on this machine."""
        return f"http://localhost:{self._port}/app{self._link}"

    @property
    def map(self) -> EscapeMap | None:
        """The map in view; None until the map is complete."""
        return self._session.results.whole_map if self._session is not None else None

    @property
    def orbits(self) -> tuple[Orbit, ...]:
        """The clicked orbits that are computed."""
        chosen_orbits = self._session.results.orbits if self._session is not None else ()
        return tuple(chosen.orbit for chosen in chosen_orbits if chosen.orbit is not None)

    def close(self) -> None:
        """Stop serving the page."""
        self._loop.call_soon_threadsafe(self._server.stop)
        self._loop.call_soon_threadsafe(self._loop.stop)

    def _repr_html_(self) -> str:
        # A browser shows the content of an `object` element if it cannot reach the page, as in a saved notebook.
        picture = compute_map(self._picture_spec)._repr_html_()
        style = f"width:100%;height:{self.height}px"
        return f"<object type='text/html' data='{html.escape(self.address)}' style='{style}'>{picture}</object>"

    def _serve(self) -> None:
        self._loop = asyncio.new_event_loop()
        asyncio.set_event_loop(self._loop)
        static = Path(__file__).parents[1] / "static"
        self._server: Any = pn.io.server.get_server(
            {"app": self._open}, port=0, start=False, show=False, title=TITLE, static_dirs={"app/static": static}
        )
        self._server.start()
        self._port = self._server.port
        self._started.set()
        self._loop.run_forever()

    def _open(self) -> Any:
        """Build the page of a session."""
        pn.extension()
        self._session = SessionExplorer(self._loop)
        return explorer_page(self._session)


def _view_of(spec: MapSpec) -> ViewState:
    """Return the view that shows a map, with the nearest of the page's choices of t_max and of the number of columns."""
    case = next((name for name, potential in POTENTIALS.items() if potential == spec.potential), TYPED)
    view = ViewState(system=System(case, write_formula(spec.potential) if case == TYPED else ""))
    energy = {} if spec.common_energy is None else {"energy": spec.common_energy}
    nearest = {
        "t_max": min(view.param.t_max.objects, key=lambda choice: abs(choice - spec.t_max)),
        "resolution": min(view.param.resolution.objects, key=lambda choice: abs(choice - spec.resolution[0])),
    }
    view.param.update(plane=spec.plane, section=spec.section, window=spec.window, **energy, **nearest)
    return view
