"""Define a study: a computation beside the maps, with its charts, and what a click on them sets.

A study is one entry in a module of this package, listed in `plots.studies.table`. The tab with help texts, progress and clicks,
the table and the figure among the files, the name in links, and the command ``study`` follow from the entry.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from engine import Potential, Result, Section, Slice, System
from engine.jobs.job import Job
from engine.slices.window import GivenWindow
from engine.systems.catalogue.entry import EnergyRange
from plots.pictures.charts import Chart, Frame
from plots.pictures.palette import Palette
from plots.pictures.setting import Setting, Settings

Changes = Mapping[str, Any]
"""New values of fields of a view, by name. A new `system` is reviewed before it is shown; `start` is added to the starts."""


class Click(NamedTuple):
    """A click on a chart.

    Attributes
    ----------
    chart
        Name of the frame of the chart.
    x, y
        The place, in the coordinates of the chart.
    """

    chart: str
    x: float
    y: float


@dataclass(frozen=True)
class Subject:
    """What a study is about: the part of a view on which its job may depend.

    Attributes
    ----------
    system
        The system.
    potential
        Its potential.
    plane
        The slice of the starts.
    energy
        The energy h, in the units of the potential; on a slice with an axis h, the last energy of another slice.
    energies
        The energies at which the system is explored.
    t_max
        Longest time of the orbits, in the units of the potential.
    section
        The surface of section at which crossings are counted.
    window
        The window of a map whose axes are those of the section; None for the default window, and for other maps.
    state
        x, y, px and py at the start of the chosen orbit; None without one.
    """

    system: System
    potential: Potential
    plane: Slice
    energy: float
    energies: EnergyRange
    t_max: float
    section: Section = Section.Y_UP
    window: GivenWindow | None = None
    state: tuple[float, ...] | None = None


@dataclass(frozen=True, kw_only=True)
class Study[Found: Result]:
    """A computation beside the maps.

    Attributes
    ----------
    name
        Name in links and for the command ``study``. It must not change.
    title
        Label of the tab.
    tab
        Name of another study in whose tab this one is shown as well; empty for a tab of its own.
    button
        Label of the button that starts the job; empty for a study that follows the map.
    hint
        What the study computes, and how long this takes. The page shows it until there is a result.
    axes
        Returns the names of the quantities against which a system can be studied, "h" or a parameter; empty for no choice.
        If there are any, all charts share the axis of x, and the page marks the present value.
    job
        Returns the job, given one of `axes`, or "" if there are none; raises ValueError for a subject that cannot be studied.
    function
        The public function that returns the result for the arguments of the job; None if the job has this function.
    progress
        Returns the computed share of a result, 0 to 1. By default 0 for a result whose ``complete`` is False, and otherwise 1.
    needs_orbit
        Whether the job is about the orbit of `Subject.state`; other studies do not depend on it.
    follows_map
        Whether the study takes so little time that it is computed for each map while its tab is open, without a button.
    sentence
        Describes a result, complete or not.
    invitation
        What a click does, in a sentence, on the page; empty for a result without places to click.
    frames
        The charts, in order. Each has a help text.
    charts
        Returns the charts of a result that are not empty, in the order of the frames, given the palette and all settings.
    settings
        Settings of how the charts are drawn.
    changes
        Returns the changes of the view at a click, given the subject and the axis of the shown result, and the result.
    files
        The part of file names that identifies the study, and the label of its table.
    figure
        Title in the list of figures.
    caption
        Title of the printed figure of a result.
    """

    name: str
    title: str
    hint: str
    job: Callable[[Subject, str], Job[Found]]
    sentence: Callable[[Found], str]
    frames: Sequence[Frame]
    charts: Callable[[Found, Palette, Settings], Sequence[Chart]]
    changes: Callable[[Subject, str, Found, Click], Changes]
    files: str
    figure: str
    caption: Callable[[Found], str]
    invitation: Callable[[Found], str] = lambda found: ""
    axes: Callable[[System], Sequence[str]] = lambda system: ()
    function: Callable[..., Found] | None = None
    progress: Callable[[Found], float] = lambda found: float(getattr(found, "complete", True))
    follows_map: bool = False
    button: str = ""
    tab: str = ""
    needs_orbit: bool = False
    settings: tuple[Setting, ...] = ()

    def call(self, job: Job[Found]) -> Job[Found]:
        """Return the call of a public function that returns the result of a job, for scripts."""
        return replace(job, function=self.function or job.function)

    def is_complete(self, found: Found) -> bool:
        """Whether no further part of a result follows."""
        return self.progress(found) >= 1.0
