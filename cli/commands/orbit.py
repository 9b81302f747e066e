"""Integrate one orbit and print its verdict, SALI, Lyapunov exponent and Birkhoff digits.

With --output STEM, STEM.csv contains the path, SALI, the exponent and R² against time, STEM.crossings.csv the crossings of the
section, and STEM.png shows them.
With --output FILE.csv, FILE.png, FILE.svg or FILE.pdf, only this file is written.

Examples:

escape-explorer orbit I --energy 0.19 --start 0.1 -0.2

escape-explorer orbit III --state 0.1 0 0 0.7 --t-max 1e4 --output orbit --json
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

from cli.arguments import GivenEnergy
from cli.execution import Place
from cli.option_marks import DocumentedBy
from cli.options import with_options
from cli.output_files import Content, Stem, name_files, reserve_output, write_files
from cli.printing import AsJson, print_result
from cli.starts import GivenState, Start, find_state
from engine import Fate, Orbit, Potential, Section, Slice, integrate_orbit, judge_orbit
from engine.results import OrbitVerdict
from engine.trajectories.birkhoff_digits import compute_birkhoff_digits
from engine.trajectories.chaos_indicators import IndicatorVerdict, evaluate_indicators
from plots.pictures.orbit_curves import compute_orbit_curves
from plots.pictures.palette import Palette
from plots.printed.figure_files import orbits_figure_bytes
from plots.printed.figure_style import FigureFormat, FigureStyle
from plots.texts.exports import orbits_csv, section_csv

CROSSINGS = "crossings.csv"
"""Ending of the name of the file with the crossings of the section."""


@with_options
def run(
    *,
    potential: Potential,
    plane: Slice,
    energy: GivenEnergy,
    start: Start = None,
    state: GivenState = None,
    t_max: Annotated[float, DocumentedBy(integrate_orbit)],
    section: Section,
    most_rows: Annotated[int, DocumentedBy(orbits_csv)],
    palette: Palette,
    style: FigureStyle,
    output: Stem = None,
    as_json: AsJson = False,
) -> None:
    """Integrate, judge and write an orbit."""
    if start is None and state is None:
        raise ValueError("start: give either --start X ORDINATE on a plane, or --state X Y PX PY")
    initial_state = find_state(potential, plane, energy, start, state)
    paths = name_files(output, ["csv", CROSSINGS, *FigureFormat], ["csv", CROSSINGS, FigureFormat.PNG])

    def make_content(ending: str) -> Content:
        if ending == "csv":
            return orbits_csv([orbit], most_rows, [verdict])
        if ending == CROSSINGS:
            return section_csv([orbit])
        curves = [compute_orbit_curves(potential, orbit)]
        return orbits_figure_bytes(potential, curves, palette, [verdict.describe()], FigureFormat(ending), style)

    with reserve_output(output):
        with Place().run() as context:
            context.start_stage("orbit")
            orbit = integrate_orbit(potential, initial_state, t_max, section=section, execution=context.execution)
            digits = None
            if orbit.fate == Fate.BOUNDED:
                digits = compute_birkhoff_digits(potential, initial_state, t_max, execution=context.execution)
        verdict = judge_orbit(orbit, digits)
        files = write_files({path: make_content(ending) for ending, path in paths.items()})
    _print(orbit, verdict, evaluate_indicators(orbit, digits), files, as_json)


def _print(
    orbit: Orbit, verdict: OrbitVerdict, indicators: Sequence[IndicatorVerdict], files: Sequence[str], as_json: bool
) -> None:
    answer: dict[str, Any] = {
        "verdict": verdict.describe(),
        "outcome": verdict.outcome,
        "fate": orbit.fate,
        "character": verdict.character,
        "bounded_for_ever": verdict.is_bounded_for_ever,
        **{name: getattr(orbit, name) for name in ("energy", "escape_time", "crossings", "energy_error", "exits_unknown")},
        "section": orbit.section.text,
        "start": [float(getattr(orbit, name)[0]) for name in ("x", "y", "px", "py")],
        "indicators": [
            {"name": each.name, "value": each.value, "conclusion": each.conclusion, "sentence": each.sentence}
            for each in indicators
        ],
    }
    lines = [f"{each.name} {each.value:.3g}: {each.sentence}" for each in indicators]
    print_result(as_json, answer, verdict.describe(), *lines, files=files)
