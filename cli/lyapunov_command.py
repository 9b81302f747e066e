"""Command ``lyapunov``: the Lyapunov orbits of the open exits."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli import options

if TYPE_CHECKING:
    from engine import EscapeFlux, LyapunovOrbit

EXAMPLES = """Examples:

escape-explorer lyapunov II --energy 0.2

escape-explorer lyapunov III --energy 0.3 --json --output exits.csv
"""


def list_lyapunov_orbits(
    case: options.Case,
    energy: Annotated[float, typer.Option("--energy", help="h, dimensionless.")],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", metavar="FILE.csv", help="CSV file for their paths over one period; an existing file is replaced."
        ),
    ] = None,
    as_json: options.AsJson = False,
) -> None:
    """List the Lyapunov orbit of each open exit: its period, its turning points, and the flux through the exit."""
    from cli.files import reserve_output, write_files
    from cli.potential_argument import find_potential
    from engine import compute_flux, find_lyapunov_orbits

    potential = find_potential(case)
    with reserve_output(output):
        orbits = find_lyapunov_orbits(potential, energy)
        files = write_files({output: _paths_csv(orbits)}) if output is not None else []
    flux = compute_flux(potential, energy) if orbits else None
    _print_result(energy, potential.escape_energy, orbits, flux, files, as_json)


def _paths_csv(orbits: tuple[LyapunovOrbit, ...]) -> str:
    lines = ["channel,t,x,y"]
    for orbit in orbits:
        last = orbit.x.size - 1
        times = [orbit.period * k / last for k in range(last + 1)]
        points = zip(times, orbit.x.tolist(), orbit.y.tolist(), strict=True)
        lines += [f"{orbit.channel},{t!r},{x!r},{y!r}" for t, x, y in points]
    return "\n".join(lines) + "\n"


def _print_result(
    energy: float,
    escape_energy: float,
    orbits: tuple[LyapunovOrbit, ...],
    flux: EscapeFlux | None,
    files: list[str],
    as_json: bool,
) -> None:
    from cli.output import print_json, print_sentences, print_table

    found: list[dict[str, Any]] = [
        {
            "channel": orbit.channel,
            "name": orbit.name,
            "period": orbit.period,
            "flux": through,
            "ends": orbit.half_path[[0, -1]].tolist(),
        }
        for orbit, through in zip(orbits, [] if flux is None else flux.flux.tolist(), strict=True)
    ]
    if as_json:
        inside = {} if flux is None else {name: value for name, value in flux.numbers().items() if name != "energy"}
        print_json({"energy": energy, "escape_energy": escape_energy, "orbits": found, **inside, "files": files})
        return
    if flux is None:
        print_sentences(f"No Lyapunov orbits: h = {energy:g} is not above the escape energy {escape_energy:.12g}.")
    else:
        rows = [
            (one["name"], f"{one['period']:.12g}", f"{one['flux']:.9g}", *(_point(end) for end in one["ends"])) for one in found
        ]
        print_table(("channel", "period", "flux", "turning point (x, y)", "turning point (x, y)"), rows)
        print_sentences(flux.describe())
    print_sentences(*[f"Written: {', '.join(files)}"] if files else [])


def _point(point: list[float]) -> str:
    return f"({point[0]:.12f}, {point[1]:.12f})"
