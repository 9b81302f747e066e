"""Command ``orbit``: one orbit with its chaos indicators."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli import options
from cli.options import DEFAULT_PLANE, DEFAULT_STYLE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from engine import IndicatorVerdict, Orbit, OrbitVerdict

EXAMPLES = """Examples:

escape-explorer orbit I --energy 0.19 --start 0.1 -0.2

escape-explorer orbit III --state 0.1 0 0 0.7 --t-max 1e4 --output orbit --json
"""


def follow_orbit(
    case: options.Case,
    energy: options.Energy = None,
    plane: options.Plane = DEFAULT_PLANE,
    fix: options.Fix = None,
    start: Annotated[
        tuple[float, float] | None, typer.Option("--start", metavar="X ORDINATE", help="Start on the plane, at --energy.")
    ] = None,
    state: Annotated[
        tuple[float, float, float, float] | None,
        typer.Option("--state", metavar="X Y PX PY", help="Full initial state instead, which determines the energy."),
    ] = None,
    t_max: options.OrbitTMax = 1e5,
    most_rows: Annotated[
        int, typer.Option("--most-rows", min=1, help="Maximum number of rows of the table; longer orbits are thinned.")
    ] = 100_000,
    palette: options.PaletteName = "paper",
    width: options.Width = DEFAULT_STYLE.width,
    dpi: options.Dpi = DEFAULT_STYLE.dpi,
    font_size: options.FontSize = DEFAULT_STYLE.font_size,
    titles: options.Titles = DEFAULT_STYLE.titles,
    output: options.Output = None,
    as_json: options.AsJson = False,
) -> None:
    """Integrate one orbit: verdict, SALI, Lyapunov exponent and Birkhoff digits.

    With --output, STEM.csv contains the path, SALI, exponent and R² against time, and STEM.png shows them; or FILE.csv, FILE.png,
    FILE.svg or FILE.pdf alone.
    """
    from cli.arguments import find_palette, find_start
    from cli.files import reserve_output, write_files
    from cli.orbit_output import Drawing, contents
    from cli.potential_argument import find_potential
    from cli.run_context import cancellable_run
    from engine import Fate, compute_birkhoff_digits, evaluate_indicators, integrate_orbit, judge_orbit
    from plots.printed.figure_style import FigureStyle

    style = FigureStyle(width, dpi, font_size, titles)
    potential, colours = find_potential(case), find_palette(palette)
    whole = find_start(case, plane, fix, energy, start, state)
    with reserve_output(output):
        with cancellable_run() as run:
            run.start_stage("orbit")
            orbit = integrate_orbit(potential, whole, t_max, execution=run.execution)
            bounded = orbit.fate == Fate.BOUNDED
            digits = compute_birkhoff_digits(potential, whole, t_max, execution=run.execution) if bounded else None
        verdict, files = judge_orbit(orbit, digits), []
        if output is not None:
            files = write_files(contents(output, potential, orbit, verdict, Drawing(colours, style, most_rows)))
    _print_result(orbit, verdict, evaluate_indicators(orbit, digits), files, as_json)


def _print_result(
    orbit: Orbit, verdict: OrbitVerdict, indicators: Sequence[IndicatorVerdict], files: list[str], as_json: bool
) -> None:
    from cli.output import print_json, print_sentences

    if not as_json:
        lines = [f"{one.name} {one.value:.3g}: {one.sentence}" for one in indicators]
        print_sentences(verdict.describe(), *lines, *([f"Written: {', '.join(files)}"] if files else []))
        return
    names = ("energy", "escape_time", "crossings", "energy_error", "exits_unknown")
    answer: dict[str, Any] = {"verdict": verdict.describe(), "outcome": verdict.outcome, "fate": orbit.fate}
    answer |= {"character": verdict.character, "bounded_for_ever": verdict.is_bounded_for_ever}
    answer |= {name: getattr(orbit, name) for name in names}
    answer["start"] = [float(getattr(orbit, name)[0]) for name in ("x", "y", "px", "py")]
    answer["indicators"] = [
        {"name": one.name, "value": one.value, "conclusion": one.conclusion, "sentence": one.sentence} for one in indicators
    ]
    print_json(answer | {"files": files})
