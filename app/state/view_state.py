"""The view state: the validated choices of the user, which all parts of the page follow."""

from __future__ import annotations

import reprlib
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import param

from app.state.places import find_crossing, find_place
from app.state.system_review import PageReview, review_catalogue_entry, review_job
from app.state.view import ANALYSES, FIRST_VIEW, PICTURES, View, allowed_resolutions, allowed_t_max
from app.state.watched_starts import WatchedStarts
from engine import (
    Fate,
    MapSpec,
    Orbit,
    ParameterAxis,
    Potential,
    Section,
    Slice,
    System,
    Window,
    integrate_orbit,
    start_states,
)
from engine.foundations.validation import LARGEST_NUMBER
from engine.jobs.job import Job, Queue
from engine.maps.warmup import is_ready_for_maps
from engine.propagation.fates import describe_fate
from engine.systems.catalogue.entry import EnergyRange
from engine.systems.catalogue.table import PAPER_ENERGIES
from engine.systems.system import TYPED
from plots.layers.table import LAYERS
from plots.links.map_view import RESOLUTION_CHOICES, SETTINGS, T_MAX_CHOICES, Start
from plots.pictures.orbit_curves import OrbitCurves
from plots.pictures.palette import DEFAULT_PALETTE, MOST_ORBITS, PALETTES, Palette
from plots.pictures.time_scale import TimeScale
from plots.studies.study import Subject

WINDOW_UNKNOWN = "The window is not known before the first map."
"""Message while the default window is not known."""

STARTS_FULL = f"{MOST_ORBITS} orbits are shown already. Remove one first."
"""Message when no start can be added."""

# Longest initial t_max of systems whose bounded orbits must all be integrated until t_max, in natural units of time.
_LONGEST_FIRST_T_MAX = 1000.0


def plane_of_system(plane: Slice, system: System) -> Slice:
    """Return the slice for another system, or the default slice if the system lacks the parameter on an axis of the slice."""
    try:
        return plane.of_system(system)
    except ValueError:
        return FIRST_VIEW.plane


class _Starts(param.Parameter):
    """Up to MOST_ORBITS starts, each a pair of finite numbers."""

    def _validate(self, val: Any) -> None:
        if not isinstance(val, tuple) or len(val) > MOST_ORBITS or not all(map(_is_start, val)):
            raise ValueError(f"starts={reprlib.repr(val)}: must be up to {MOST_ORBITS} pairs of finite numbers x, ordinate")


class _Layers(param.ClassSelector):
    """Names of layers, as a frozenset."""

    def _validate(self, val: Any) -> None:
        super()._validate(val)
        unknown = sorted(val.difference(LAYERS))
        if unknown:
            raise ValueError(f"layers: {', '.join(unknown)}: must be among {', '.join(LAYERS)}")


class _Settings(param.ClassSelector):
    """One of its choices for each setting of the layers."""

    def _validate(self, val: Any) -> None:
        super()._validate(val)
        if val.keys() != SETTINGS.keys():
            raise ValueError(f"settings={reprlib.repr(val)}: must have a value for each of {', '.join(SETTINGS)}")
        for name, value in val.items():
            choices = list(SETTINGS[name].choices.values())
            if value not in choices:
                raise ValueError(f"settings: {name}={value!r}: must be one of {choices}")


def _is_start(value: Any) -> bool:
    is_pair = isinstance(value, tuple) and len(value) == 2
    return is_pair and all(isinstance(number, int | float) and abs(number) < np.inf for number in value)


def longest_first_t_max(potential: Potential) -> float:
    """Return the longest initial t_max of a system. It is short if all bounded orbits must be integrated until t_max."""
    allowed = allowed_t_max().values()
    longest = np.inf if potential.tori_are_evidence else _LONGEST_FIRST_T_MAX * potential.well.exact_time_unit
    return max((each for each in allowed if each <= longest), default=min(allowed))


def _start_state(potential: Potential, plane: Slice, energy: float, start: Start) -> tuple[float, ...] | None:
    """Return x, y, px, py of a start on a slice of one potential; None for a forbidden start."""
    x, ordinate = (np.array([value]) for value in start)
    state = start_states(potential, plane, energy, x, ordinate)[0]
    return tuple(state.tolist()) if np.isfinite(state).all() else None


def _integrate_start(reviewed: PageReview, line: Slice, energy: float, start: Start, t_max: float, section: Section) -> Orbit:
    """Return the orbit of a start on a slice of a reviewed system; ValueError if the start is forbidden."""
    state = _start_state(reviewed.potential, line, energy, start)
    if state is None:
        raise ValueError(describe_fate(Fate.FORBIDDEN))
    return integrate_orbit(reviewed.potential, state, t_max, section=section)


class ViewState(param.Parameterized):
    """What a session shows: the fields of `View` with their legal values, other choices, and what is known of the browser.

    `follow` calls a function now and after each change; `param.watch` calls it only after changes.
    """

    system = param.ClassSelector(class_=System, default=FIRST_VIEW.system)
    plane = param.ClassSelector(class_=Slice, default=FIRST_VIEW.plane)
    section = param.ClassSelector(class_=Section, default=FIRST_VIEW.section)
    energy = param.Number(default=PAPER_ENERGIES["I"].first, bounds=(-LARGEST_NUMBER, LARGEST_NUMBER))
    window = param.ClassSelector(class_=Window, default=FIRST_VIEW.window, allow_None=True)
    t_max = param.Selector(default=FIRST_VIEW.t_max, objects=list(T_MAX_CHOICES.values()))
    resolution = param.Selector(default=FIRST_VIEW.resolution, objects=list(RESOLUTION_CHOICES.values()))
    layers = _Layers(class_=frozenset, default=FIRST_VIEW.layers, doc="names of the layers that are on")
    settings = _Settings(class_=Mapping, default=FIRST_VIEW.settings, doc="value of each setting of the layers")
    analysis = param.Selector(default=FIRST_VIEW.analysis, objects=list(ANALYSES))
    box = param.ClassSelector(class_=Window, default=FIRST_VIEW.box, allow_None=True)
    watched = param.ClassSelector(class_=WatchedStarts, default=FIRST_VIEW.watched)
    starts = _Starts(default=FIRST_VIEW.starts)
    chosen = param.Integer(default=FIRST_VIEW.chosen, bounds=(0, MOST_ORBITS - 1))
    compared = param.ClassSelector(
        class_=View, default=None, allow_None=True, doc="view with which this view is compared; None for no comparison"
    )
    focus = param.Selector(default="", objects=["", *PICTURES], doc="picture that is shown large; empty for none")
    palette = param.Selector(default=DEFAULT_PALETTE, objects=list(PALETTES), doc="name of the palette")
    touch = param.Boolean(default=False, doc="whether the visitor has touched the page with a finger")
    narrow = param.Boolean(default=False, doc="whether the page has had the layout of a phone")
    lock_times = param.ClassSelector(
        class_=TimeScale, default=None, allow_None=True, doc="scale of the escape times; None fits it to the map in view"
    )

    def __init__(self, **values: Any) -> None:
        first = FIRST_VIEW.within_limits()
        super().__init__(t_max=first.t_max, resolution=first.resolution)
        self.param.t_max.objects = list(allowed_t_max().values())
        self.param.resolution.objects = list(allowed_resolutions().values())
        self._review = review_catalogue_entry(self.system.case)
        self.found_axis: ParameterAxis | None = None
        """The parameter along which the potentials have been found, by the last map."""
        self.known_orbits: Mapping[Start, OrbitCurves] = {}
        """The orbits of starts that have been integrated."""
        self.param.update(**values)

    def follow(self, show: Callable[..., object], *names: str) -> None:
        """Call a function with the values of these fields, now and whenever one of them changes."""

        def update(*events: object) -> None:
            show(*(getattr(self, name) for name in names))

        self.param.watch(update, list(names))
        update()

    @property
    def view(self) -> View:
        """The part of the state that belongs to a view."""
        return View(**{name: getattr(self, name) for name in FIRST_VIEW.values()})

    @property
    def reviewed(self) -> PageReview:
        """The review of the system; RuntimeError outside the catalogue, unless `show` has received the review."""
        if self._review.system != self.system:
            if self.system.case == TYPED or self.system.parameters:
                raise RuntimeError(f"{self.system} has not been reviewed")
            self._review = review_catalogue_entry(self.system.case)
        return self._review

    @property
    def potential(self) -> Potential:
        """The potential of the chosen system."""
        return self.reviewed.potential

    @property
    def energies(self) -> EnergyRange:
        """The energy range of the chosen system."""
        return self.reviewed.energies

    @property
    def subject(self) -> Subject:
        """What the studies of the view are about."""
        window = self.window if self.section.is_drawn_on(self.plane) else None
        # Along a parameter, starts belong to other potentials.
        start = self.chosen_start if self.plane.parameter is None else None
        state = None if start is None else self.start_state(start)
        return Subject(
            self.system, self.potential, self.plane, self.energy, self.energies, self.t_max, self.section, window, state
        )

    @property
    def colours(self) -> Palette:
        """The chosen palette."""
        return PALETTES[self.palette]

    @property
    def chosen_start(self) -> Start | None:
        """The chosen start; None if there are no starts."""
        return self.starts[self.chosen] if self.chosen < len(self.starts) else None

    def map_spec(self) -> MapSpec:
        """Return the specification of the map; ValueError if a choice is invalid."""
        return self.view.map_spec(self.reviewed)

    @property
    def is_ready(self) -> bool:
        """Whether the kernels, and the potentials along a parameter, are known without compiling or searching."""
        return is_ready_for_maps(self.potential) and self.plane.parameter in (None, self.found_axis)

    @property
    def is_window_known(self) -> bool:
        """Whether the window in view is given or can be found at once."""
        return self.window is not None or self.is_ready

    def find_window(self) -> Window:
        """Return the window in view; ValueError if it is not known."""
        if not self.is_window_known:
            raise ValueError(WINDOW_UNKNOWN)
        return self.map_spec().find_window()

    def orbit_job(self, start: Start) -> Job[Orbit] | None:
        """Return the job of the orbit of a start; None if the start is known to be forbidden.

        Along a parameter, the job fails for a forbidden start, because the potential of the start is found by a job.
        """
        axis_index = self.plane.parameter_axis
        if axis_index is not None:
            review, line = review_job(self.plane.system_at(self.system, *start)), self.plane.line(start[axis_index])
            return Job(_integrate_start, (review, line, self.energy, start, self.t_max, self.section), queue=Queue.LONG_CALL)
        state = self.start_state(start)
        if state is None:
            return None
        return Job(integrate_orbit, (self.potential, state, self.t_max), (("section", self.section),), queue=Queue.LONG_CALL)

    def start_state(self, start: Start) -> tuple[float, ...] | None:
        """Return x, y, px, py of a start on a slice of one potential; None for a forbidden start."""
        return _start_state(self.potential, self.plane, self.energy, start)

    def add_start(self, start: Start) -> bool:
        """Add a start and choose it, or return False if there are already `MOST_ORBITS` other starts."""
        if start in self.starts:
            self.chosen = self.starts.index(start)
        elif len(self.starts) < MOST_ORBITS:
            self.param.update(starts=(*self.starts, start), chosen=len(self.starts))
        return start in self.starts

    def switch_layer(self, name: str, *, on: bool) -> None:
        """Switch a layer on or off."""
        self.layers = self.layers | {name} if on else self.layers - {name}

    def compare(self, *, on: bool) -> None:
        """Compare later views with the present view in the same window, or end the comparison."""
        if not on:
            self.compared = None
            return
        window = self.find_window() if self.is_window_known else None
        self.param.update(compared=self.view, window=window)

    def enlarge(self, name: str) -> None:
        """Show a picture large; if it is large already, show all pictures side by side."""
        self.focus = "" if name == self.focus else name

    def show(self, reviewed: PageReview, **values: Any) -> None:
        """Set a reviewed system together with other values."""
        self._review = reviewed
        values["plane"] = plane_of_system(values.get("plane", self.plane), reviewed.system)
        values["system"] = reviewed.system
        for name in ("layers", "plane", "system"):
            # Param would call the watchers even for equal layers, or an equal slice or system.
            if values.get(name) == getattr(self, name):
                del values[name]
        self.param.update(**values)

    def show_slice(self, plane: Slice) -> None:
        """Set a slice without a window, and keep the orbits that have a place on the slice, at their start or at the section."""
        places = [] if plane.parameter or self.plane.parameter else [self._place_on(plane, start) for start in self.starts]
        starts = tuple(dict.fromkeys(place for place in places if place is not None))
        chosen = places[self.chosen] if self.chosen < len(places) else None
        index = starts.index(chosen) if chosen is not None else 0
        self.param.update(plane=plane, window=None, starts=starts, chosen=index)

    def _place_on(self, plane: Slice, start: Start) -> Start | None:
        """Return where the orbit of a start begins on another slice, or first meets it, if it is the slice of the section."""
        state = self.start_state(start)
        place = None if state is None else find_place(plane, self.potential, self.energy, state)
        curves = self.known_orbits.get(start)
        if place is None and curves is not None and curves.orbit.section == self.section:
            return find_crossing(plane, self.potential, self.energy, curves)
        return place

    def show_section(self, section: Section, *, with_slice: bool) -> None:
        """Set the section at which crossings are counted and, with `with_slice`, show a slice of starts on it."""
        # One call of each watcher for both changes.
        with param.parameterized.batch_call_watchers(self):
            self.section = section
            if with_slice and section.plane is not None and self.plane != section.plane:
                self.show_slice(section.plane)

    def show_system(self, reviewed: PageReview, energy: float | None = None) -> None:
        """Set a reviewed system at an energy, by default its initial energy, and remove window and starts."""
        new_energy = reviewed.energies.first if energy is None else energy
        longest_t_max = self.t_max if reviewed.system.case == self.system.case else longest_first_t_max(reviewed.potential)
        self.show(reviewed, energy=new_energy, window=None, starts=(), chosen=0, t_max=min(self.t_max, longest_t_max))

    def remove_start(self, index: int) -> None:
        """Remove the start at an index."""
        starts = self.starts[:index] + self.starts[index + 1 :]
        self.param.update(starts=starts, chosen=max(min(self.chosen, len(starts) - 1), 0))
