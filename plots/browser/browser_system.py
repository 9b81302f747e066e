"""Systems as data for the engine in the browser."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine import Execution, Plane, Potential, Section, Slice, Window
from engine.slices.default_window import default_window
from engine.slices.portable_system import make_portable_system
from engine.slices.slice_text import write_slice
from plots.browser.compiled_files import has_compiled, read_compiled

EXIT_NUMBER_DISTANCE = 0.86
"""Distance of the number of an exit from the origin, as a share of the distance of the middle of the exit."""

WINDOW_EDGES = ("xLow", "xHigh", "ordinateLow", "ordinateHigh")
"""Names of the edges of a window in the browser, in the order of `Window.edges`."""

# Number of energies with a tabulated window below the escape energy, where windows change slowly.
_ENERGIES_BELOW = 5
# Distance of the last of them from the escape energy, as a share of the range of energies.
_MARGIN = 1e-6
# Number of energies with a tabulated window above the escape energy.
_ENERGIES_ABOVE = 13


@dataclass(frozen=True)
class BrowserSystem:
    """A system for the browser: its data as a line of JSON, then its module, as in the files compiled in advance.

    Attributes
    ----------
    content
        The line and the module.
    """

    content: bytes

    @property
    def nbytes(self) -> int:
        """Size in bytes."""
        return len(self.content)

    def to_dict(self) -> dict[str, Any]:
        """Return the system in the form of `System` in modules/engine/system.js, with its module."""
        data, module = self.content.split(b"\n", 1)
        return {**json.loads(data), "module": module}


def slice_name(plane: Slice) -> str:
    """Return the name of a slice in the tables of windows."""
    return ";".join(filter(None, write_slice(plane)))


def describe_slice(plane: Slice, potential: Potential, section: Section, *, backward: bool = False) -> dict[str, object]:
    """Return a slice in the form of `Slice` in modules/engine/system.js.

    It has the columns of its axes in states if it is on the section. Pixels have no mirror images if these cross the section in
    another way. With `backward`, all starts have the opposite momenta.
    """
    described = plane.to_dict(potential.units, backward=backward)
    described["sectionColumns"] = section.columns_on(plane)
    return described if section.is_mirrored else described | {"mirrored": None}


def window_in_browser(window: Window) -> dict[str, float]:
    """Return a window in the form of `Window` in modules/engine/starts.js."""
    return dict(zip(WINDOW_EDGES, window.edges, strict=True))


def system_key(potential: Potential, section: Section = Section.Y_UP) -> str:
    """Return a hash of a potential and the section at which crossings are counted, as 16 hexadecimal digits."""
    definition = potential.form, potential.rotation, potential.ends, section
    return hashlib.sha256(repr(definition).encode()).hexdigest()[:16]


def file_name(potential: Potential, low: float, high: float, section: Section = Section.Y_UP) -> str:
    """Return the name of the file with the compiled system of `make_browser_system`."""
    energies = hashlib.sha256(repr((float(low), float(high))).encode()).hexdigest()
    return f"{system_key(potential, section)}-{energies[:8]}.system"


def is_system_compiled(potential: Potential, low: float, high: float, section: Section = Section.Y_UP) -> bool:
    """Whether `make_browser_system` reads a file, which takes milliseconds."""
    return has_compiled(file_name(potential, low, high, section))


def make_browser_system(
    potential: Potential, low: float, high: float, section: Section = Section.Y_UP, *, execution: Execution
) -> BrowserSystem:
    """Return the system of `compile_browser_system`, from a file if it is compiled in advance."""
    content = read_compiled(file_name(potential, low, high, section))
    if content is not None:
        return BrowserSystem(content)
    return compile_browser_system(potential, low, high, section, execution=execution)


def compile_browser_system(
    potential: Potential, low: float, high: float, section: Section = Section.Y_UP, *, execution: Execution
) -> BrowserSystem:
    """Compile the module of a system, and tabulate its exits and windows for energies from `low` to `high`, dimensionless.

    Crossings are counted at the section. The windows are the default windows by energy, for each plane without an axis of energy:
    {key of the plane: {"energies": […], "windows": [[x_low, x_high, ordinate_low, ordinate_high], …]}}. The energies rise.
    """
    planes: dict[str, Slice] = {slice_name(plane): plane for plane in Plane if plane.energy_axis is None}
    planes |= {slice_name(section.slice_of_starts): section.slice_of_starts}
    windows = {name: _tabulate_windows(potential, plane, (low, high), execution) for name, plane in planes.items()}
    portable = make_portable_system(potential, high, section)
    page_data = {"key": system_key(potential, section), "windows": windows, "numberDistance": EXIT_NUMBER_DISTANCE}
    return BrowserSystem(json.dumps(portable.to_dict() | page_data).encode() + b"\n" + portable.module)


def _tabulate_windows(potential: Potential, plane: Slice, energies: tuple[float, float], execution: Execution) -> dict[str, Any]:
    """Return the default windows of a plane for energies in a range, from the first energy with a window to the last."""
    windows: dict[float, list[float]] = {}
    for energy in _tabulated_energies(potential, *energies).tolist():
        execution.raise_if_cancelled()
        try:
            window = default_window(potential, plane, energy)
        except ValueError:
            if windows:
                break
            continue
        windows[energy] = list(window.edges)
    return {"energies": list(windows), "windows": list(windows.values())}


def _tabulated_energies(potential: Potential, low: float, high: float) -> np.ndarray:
    """Return the energies at which windows are tabulated, in ascending order."""
    if not potential.escapes_over_saddles:
        # A system with an escape circle has no escape energy.
        return np.linspace(low, high, _ENERGIES_BELOW + _ENERGIES_ABOVE)
    escape = min(max(potential.escape_energy, low), high)
    # Rounding decides whether exits are open at the escape energy itself.
    below = np.linspace(low, max(escape - _MARGIN * (high - low), low), _ENERGIES_BELOW)
    # The square places energies closer together just above the escape energy.
    above = escape + (high - escape) * np.linspace(0.0, 1.0, _ENERGIES_ABOVE)[1:] ** 2
    return np.unique([*below, *above])
