"""Compute a study, as the tabs beside the maps of the page do, and write it to STEM.nc and STEM.csv.

With --output FILE.png, FILE.svg or FILE.pdf, its charts are drawn instead.

Examples:

escape-explorer study energies I --output study-I

escape-explorer study energies III --against epsilon --energy 0.3 --output study-III.pdf

escape-explorer study periodic III --energy 0.3 --output periodic.png

escape-explorer study plate III --against epsilon --output plate.png

escape-explorer study family III --energy 0.2 --start 0 0 --output family.pdf
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from cli.arguments import Case, GivenEnergy, file_name_part
from cli.execution import THREADS_ONLY, Place
from cli.option_marks import DocumentedBy
from cli.options import with_options
from cli.output_files import Content, Stem, name_files, reserve_output, write_files
from cli.printing import AsJson, list_rows, print_result
from cli.starts import GivenState, Start, find_state
from engine import Execution, NoPeriodicOrbitError, Potential, Result, Section, Slice, SweepSpec, System
from engine.jobs.job import Job, run_job
from engine.systems.review.potential_review import review_system
from plots.pictures.setting import NO_SETTINGS, Settings
from plots.printed.figure_files import study_figure_bytes
from plots.printed.figure_style import FigureFormat, FigureStyle
from plots.studies.study import Study, Subject
from plots.studies.table import STUDIES
from plots.texts.exports import dataset_bytes, stem_of, table_csv

STUDY_HELP = " ".join(f"{name}: {study.hint}" for name, study in STUDIES.items())
AGAINST_HELP = "h, or a parameter; by default the first quantity against which the study can be made."


@with_options
def run(
    *,
    study: Annotated[str, typer.Argument(metavar="STUDY", help=STUDY_HELP)],
    case: Case,
    system: System,
    potential: Potential,
    plane: Slice,
    section: Section,
    energy: GivenEnergy,
    t_max: Annotated[float, DocumentedBy(SweepSpec)],
    start: Start = None,
    state: GivenState = None,
    against: Annotated[str | None, typer.Option(help=AGAINST_HELP)] = None,
    settings: Settings,
    style: FigureStyle,
    output: Stem = None,
    place: Annotated[Place, THREADS_ONLY],
    as_json: AsJson = False,
) -> None:
    """Compute, write and print the study. Without --energy, it is made at the first energy of the page.

    The study of a family needs --start or --state.
    """
    entry = _find_study(study)
    energies = review_system(system).energies
    chosen_energy = energies.first if energy is None else energy
    has_start = start is not None or state is not None
    if has_start != entry.needs_orbit:
        must = "needs" if entry.needs_orbit else "does not depend on"
        raise ValueError(f"start: the study {entry.name} {must} --start X ORDINATE or --state X Y PX PY")
    energy_of_start = energy if state is not None or plane.energy_axis is not None else chosen_energy
    chosen_state = find_state(potential, plane, energy_of_start, start, state) if has_start else None
    subject = Subject(system, potential, plane, chosen_energy, energies, t_max, section, state=chosen_state)
    job = entry.job(subject, _choose_axis(entry, system, against))
    stem = Path(stem_of(f"{entry.files}-{file_name_part(case)}", section))
    paths = name_files(output, ["nc", "csv", *FigureFormat], ["nc", "csv"], stem)
    with reserve_output(output or stem):
        with place.run() as context:
            found = _run(job, context.start_stage(entry.files))
        files = write_files({path: study_content(entry, found, ending, style, settings) for ending, path in paths.items()})
    _print(entry, found, files, as_json)


def _run(job: Job[Result], execution: Execution) -> Result:
    """Return the result of a job; ValueError if no periodic orbit is near the start."""
    try:
        return run_job(job, execution, {})
    except NoPeriodicOrbitError as error:
        raise ValueError(f"start: {error}") from None


def _find_study(name: str) -> Study[Any]:
    if name not in STUDIES:
        raise ValueError(f"study={name!r}: must be one of {', '.join(STUDIES)}")
    return STUDIES[name]


def _choose_axis(study: Study[Any], system: System, against: str | None) -> str:
    """Return the axis of the charts; ValueError for one that the study does not have."""
    axes = study.axes(system)
    if against is not None and against not in axes:
        raise ValueError(f"against={against!r}: must be {f'one of {", ".join(axes)}' if axes else f'left out for {study.name}'}")
    return against or next(iter(axes), "")


def study_content(study: Study[Any], found: Result, ending: str, style: FigureStyle, settings: Settings = NO_SETTINGS) -> Content:
    """Return the content of the output file with an ending."""
    if ending == "nc":
        return dataset_bytes(found.to_xarray())
    if ending == "csv":
        return table_csv(found)
    return study_figure_bytes(study, found, settings, FigureFormat(ending), style)


def _print(study: Study[Any], found: Result, files: Sequence[str], as_json: bool) -> None:
    points = list_rows(found.columns())
    print_result(as_json, {"numbers": found.numbers(), "points": points}, study.sentence(found), files=files)
