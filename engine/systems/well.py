"""Quantities derived from a potential, each computed at its first use: critical points, numbered exits, symmetries, units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from types import ModuleType
from typing import Any

import numpy as np

from engine.foundations.arrays import read_only
from engine.integrator.bound_kernels import load_kernels
from engine.integrator.source.recurrence import Structure, find_structure
from engine.integrator.source.section_numbers import SectionForm
from engine.integrator.source.series import Setting
from engine.systems.forms.expression_form import Form
from engine.systems.forms.form import DescentError, NotIsolatedError, UndecidedError, hessian_matrix
from engine.systems.forms.stored_points import stored_points
from engine.systems.landscape.closed_energy import component_search, find_closed_energy
from engine.systems.landscape.exit_saddles import find_exit_lines, find_maxima_beside, in_channel_order
from engine.systems.landscape.hill_component import ComponentSearch
from engine.systems.landscape.mirror_images import (
    MIRROR_X,
    MIRROR_Y,
    Signs,
    make_symmetric,
    mirrors_of,
    without_rounding,
)
from engine.systems.landscape.mirror_symmetry import image_fates, well_mirrors
from engine.systems.merged_channels import ChannelMerger, MergedExit, exit_numbers, merged_exits, name_exit
from engine.systems.outcomes import End, EscapeCircle, Exit, Outcome, outcomes_of
from engine.systems.well_scales import WellScales

EQUAL_ENERGY_TOLERANCE = 1e-12
"""Largest difference of the energies of saddles that count as equally high, in units of energy of the well."""

# Interval between the samples of averages for a frequency of 1; near the escape energy, it is one integration step.
_SAMPLE_INTERVAL = 1.0 / 3.0


@dataclass(frozen=True, eq=False)
class Well(WellScales):
    """The well, or the body, at the origin of a potential, with its exits.

    Lengths, energies and times are in the units of the potential.

    Attributes
    ----------
    form, rotation, ends, mass
        See `Potential`.
    """

    form: Form
    rotation: float
    ends: tuple[End, ...]
    mass: float

    @property
    def escape_radius(self) -> float | None:
        """Radius of the escape circle; None for exits over saddles."""
        return next((end.radius for end in self.ends if isinstance(end, EscapeCircle)), None)

    @property
    def critical_points(self) -> np.ndarray:
        """All points with ∇V = 0, of shape (n, 2). A point at the origin is exactly (0, 0). ValueError for a curve of points.

        For a formula that is not a polynomial, these are the points of a region, see `engine.systems.forms.stationary_points`.
        """
        return self._points_and_indices[:, :2]

    @property
    def critical_indices(self) -> np.ndarray:
        """The indices of the critical points, of shape (n,): 1 for a minimum or maximum, −1 for a saddle, 0 if degenerate."""
        return self._points_and_indices[:, 2]

    @cached_property
    def _points_and_indices(self) -> np.ndarray:
        """x, y and index of each critical point, of shape (n, 3)."""
        points, indices = np.split(stored_points("critical_points", self.form, self.form.find_critical_points), [2], axis=1)
        return read_only(np.column_stack([make_symmetric(points, points, mirrors_of(self.form)), indices]))

    @cached_property
    def saddles(self) -> np.ndarray:
        """Saddles that lead out of the well at the origin, of shape (n, 2): ∇V = 0 and V_xx V_yy − V_xy² < 0.

        The saddles are in counterclockwise order from the +x axis: channel k passes over ``saddles[k - 1]``. A saddle is an exit
        if exactly one of the two lines of steepest descent from the saddle ends at the origin. Zotos (2014) prints the saddle
        test without the square of V_xy, a misprint. With an escape radius, there are no exit saddles; if they are not known, see
        `exits_unknown`, the array is empty.
        """
        if not self.escapes_over_saddles or self.exits_unknown:
            return read_only(np.empty((0, 2)))
        exits = np.unique(self._exit_places[:, 0].astype(int))
        return read_only(in_channel_order(self.critical_points[exits], self.mirrors))

    @cached_property
    def exits_unknown(self) -> str:
        """The reason why the exit saddles are not known; empty if they are known."""
        try:
            _ = self._exit_places
        except (DescentError, NotIsolatedError, UndecidedError) as error:
            return str(error)
        return ""

    @cached_property
    def _exit_places(self) -> np.ndarray:
        """The places on lines of steepest descent over the exit saddles, see `find_exit_lines`."""
        form, points, indices = self.form, self.critical_points, self.critical_indices
        return stored_points("exit_lines", form, lambda: find_exit_lines(form, points, indices, form.singular_points))

    @cached_property
    def exit_lines(self) -> tuple[np.ndarray, ...]:
        """For each channel, the places (n, 2) on lines of steepest descent over its saddle, from the origin to the outside."""
        index, places = self._exit_places[:, 0], self._exit_places[:, 1:]
        nearest = [np.argmin(np.hypot(*(self.critical_points - saddle).T)) for saddle in self.saddles]
        return tuple(places[index == k] for k in nearest)

    @property
    def channels(self) -> int:
        """The number of exit channels. Channels are numbered from 1, counterclockwise from the +x axis."""
        return len(self.saddles)

    @cached_property
    def saddle_energies(self) -> np.ndarray:
        """V at the exit saddles, in channel order, of shape (channels,)."""
        return read_only(np.asarray(self.form.value(self.saddles[:, 0], self.saddles[:, 1]), dtype=float))

    @cached_property
    def escape_energy(self) -> float:
        """The lowest energy at which orbits can escape: V at the lowest exit saddle; infinite if there is none.

        With an escape radius, the value is −∞, because orbits can start outside the saddles at every energy.
        """
        if not self.escapes_over_saddles:
            return -np.inf
        return float(self.saddle_energies.min(initial=np.inf))

    def open_channels(self, energy: float) -> tuple[int, ...]:
        """Return the numbers of the channels whose saddle lies below `energy`; empty at or below the escape energy."""
        return tuple(
            int(k) + 1 for k in np.flatnonzero(self.saddle_energies < energy - EQUAL_ENERGY_TOLERANCE * self.units.energy)
        )

    @cached_property
    def component_search(self) -> ComponentSearch:
        """The search for components of the Hill region around the origin."""
        return component_search(self.form, self._length_unit)

    @cached_property
    def closed_energy(self) -> float:
        """The highest energy up to which the well is shown to be closed, at most the escape energy; −∞ if it is not shown."""
        form, saddles = self.form, self.saddles

        def find() -> np.ndarray:
            search, directions = self.component_search, self.outward_directions
            return np.array(find_closed_energy(search, form, saddles, directions, self.bottom, self.units.energy))

        return float(stored_points("closed_energy", (form, saddles.tolist()), find))

    def is_closed_at(self, energy: Any) -> Any:
        """Return whether no orbit of the well with this energy is shown to have an end, see `closed_energy`.

        With ends other than exits, such as an escape radius, the result is always False. The criterion also holds in a rotating
        frame, because orbits cannot pass the zero-velocity curve V = h.
        """
        can_be_closed = np.logical_and(np.asarray(energy) <= self.escape_energy, not self.ends)
        # Above the escape energy, the search is not needed.
        return can_be_closed & (np.asarray(energy) <= self.closed_energy) if can_be_closed.any() else can_be_closed

    @cached_property
    def outward_directions(self) -> np.ndarray:
        """Unit vectors along the unstable directions of the exit saddles, away from the well, of shape (channels, 2)."""
        directions = np.array([self._unstable_direction(saddle) for saddle in self.saddles]).reshape(-1, 2)
        return read_only(make_symmetric(self.saddles, directions, self.mirrors))

    def _unstable_direction(self, saddle: np.ndarray) -> np.ndarray:
        """Return the unit vector along the unstable direction of a saddle, away from the origin."""
        _, eigenvectors = np.linalg.eigh(hessian_matrix(self.form, *saddle))
        # The first eigenvector belongs to the negative eigenvalue.
        direction = without_rounding(eigenvectors[None, :, 0])[0]
        return direction if direction @ saddle > 0 else -direction

    @cached_property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The possible ends of orbits: exits in channel order, then `ends`. The first has the fate 1."""
        return outcomes_of(self.channels, self.ends)

    @property
    def setting(self) -> Setting:
        """The properties other than the formula on which compiled functions depend."""
        return Setting(self.channels, tuple(end.side for end in self.ends), self.rotation != 0.0)

    @cached_property
    def structure(self) -> Structure:
        """The structure of the compiled functions, for a potential in units of its well. Finding it takes up to 0.2 s."""
        return self.structure_of(None)

    def structure_of(self, section: SectionForm | None) -> Structure:
        """Return the structure of the compiled functions that count crossings of a section with this form, see `kernels_of`."""
        return find_structure(self.form.definition, self.setting._replace(section=section))

    @property
    def kernels(self) -> ModuleType:
        """The kernels, see `load_kernels`, for a potential in units of its well. The first use generates their code."""
        return self.kernels_of(None)

    def kernels_of(self, section: SectionForm | None) -> ModuleType:
        """Return the kernels that count crossings of a section with this form; None for y = 0, upward."""
        return load_kernels(self.form.definition, self.setting._replace(section=section), self.rotation)

    @property
    def sample_interval(self) -> float:
        """The time between the samples of Birkhoff averages, for a potential in units of its well."""
        return _SAMPLE_INTERVAL / max(1.0, self.fastest_frequency)

    @cached_property
    def channel_mergers(self) -> tuple[ChannelMerger, ...]:
        """The maxima that separate exits from each other, the lowest first.

        A maximum lies between two exits if lines of steepest ascent from both saddles end at the maximum.
        """
        if not self.channels:
            return ()
        form = self.form
        points, indices = self.critical_points, self.critical_indices
        # Indices of the exit saddles among the critical points: the nearest, because `saddles` are rounded.
        saddles = np.array([np.argmin(np.hypot(*(points - saddle).T)) for saddle in self.saddles], int)
        # For each exit and each critical point, whether the point is a maximum beside the exit, of shape (channels, points).
        is_beside = stored_points("maxima", form, lambda: find_maxima_beside(form, points, indices, saddles))
        maxima = np.flatnonzero(is_beside.sum(axis=0) > 1)
        return self._mergers_at(points[maxima], [np.flatnonzero(is_beside[:, k]) + 1 for k in maxima])

    def _mergers_at(self, maxima: np.ndarray, adjacent_channels: Sequence[np.ndarray]) -> tuple[ChannelMerger, ...]:
        """Return the mergers at maxima (n, 2), each between adjacent channels, the lowest first."""
        pairs = zip(maxima.tolist(), adjacent_channels, strict=True)
        return tuple(
            sorted(ChannelMerger(float(self.form.value(x, y)), x, y, tuple(numbers.tolist())) for (x, y), numbers in pairs)
        )

    def merged_exits(self, energy: float) -> tuple[MergedExit, ...]:
        """Return the exits of several channels above the maxima between them. Each has the lowest number of its channels."""
        return merged_exits(self.channel_mergers, energy)

    def exit_numbers(self, energy: Any) -> np.ndarray:
        """Return the number of the exit to which each fate belongs, of shape (…, outcomes + 1) at energies (…). Entry 0 is 0."""
        merger_count = np.searchsorted([merger.energy for merger in self.channel_mergers], np.asarray(energy), side="left")
        return exit_numbers(self.channel_mergers, len(self.outcomes))[merger_count]

    def outcomes_at(self, energy: float | tuple[float, float], names: Sequence[str] = ()) -> tuple[Outcome, ...]:
        """Return `outcomes` with the names that exits have at an energy, or in a range of energies (low, high).

        names: the names of all channels. Without names, an exit is called "exit 1".
        """
        low, high = energy if isinstance(energy, tuple) else (energy, energy)
        if not (names or self.merged_exits(high)):
            return self.outcomes
        numbers_at_low = self.exit_numbers(low)
        exit_names = [name_exit(channel, self.channel_mergers, low, high, names) for channel in range(1, self.channels + 1)]
        exits = [
            Exit.outcome(channel, name if names else f"{Exit.word} {name}", occurs=bool(numbers_at_low[channel] == channel))
            for channel, name in enumerate(exit_names, 1)
        ]
        return (*exits, *self.outcomes[self.channels :])

    @property
    def mirror_in_x(self) -> bool:
        """Whether (x, px) → (−x, −px) maps orbits to orbits exactly: V and the ends are even in x, and the frame is at rest."""
        return MIRROR_X in self.mirrors

    @property
    def mirror_in_y(self) -> bool:
        """Whether (y, py) → (−y, −py) maps orbits to orbits exactly: V and the ends are even in y, and the frame is at rest."""
        return MIRROR_Y in self.mirrors

    @property
    def mirrors(self) -> tuple[Signs, ...]:
        """The reflections that map V and the ends onto themselves, in a frame at rest."""
        return well_mirrors(self.form, self.rotation, self.ends)

    @cached_property
    def mirror_fates(self) -> np.ndarray:
        """The fate onto which x → −x maps each fate, of shape (outcomes + 1,). Entry 0 is 0. Requires `mirror_in_x`."""
        return read_only(image_fates(self.saddles, self.ends, MIRROR_X))

    def mirror_numbers(self, energy: Any) -> np.ndarray:
        """Return `mirror_fates` as exit numbers at energies (…), of shape (…, outcomes + 1)."""
        return self.exit_numbers(energy)[..., self.mirror_fates]
