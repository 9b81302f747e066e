"""List the Lyapunov orbit of each open exit: its period, its turning points, the flux, and how much of it comes back.

Examples:

escape-explorer lyapunov II --energy 0.2

escape-explorer lyapunov III --energy 0.3 --json --output exits.csv
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from cli.arguments import OneEnergy
from cli.options import with_options
from cli.output_files import reserve_output, split_ending, write_files
from cli.printing import AsJson, Table, print_result
from engine import LyapunovOrbit, Potential, compute_flux, find_lyapunov_orbits
from engine.results import EscapeFlux
from plots.texts.exports import write_csv


@with_options
def run(
    *,
    potential: Potential,
    energy: OneEnergy,
    output: Annotated[Path | None, typer.Option(metavar="FILE.csv")] = None,
    as_json: AsJson = False,
) -> None:
    """Find, write and list the orbits.

    Parameters
    ----------
    output
        CSV file of the paths of the orbits over one period; an existing file is replaced.
    """
    if output is not None:
        split_ending(output, ["csv"], [])
    with reserve_output(output):
        orbits = find_lyapunov_orbits(potential, energy)
        files = write_files({output: _paths_csv(orbits)}) if output is not None else []
    flux = compute_flux(potential, energy) if orbits and not potential.rotation else None
    _print(energy, potential.escape_energy, orbits, flux, files, as_json)


def _paths_csv(orbits: Sequence[LyapunovOrbit]) -> str:
    rows = [
        (orbit.channel, orbit.period * k / (orbit.x.size - 1), x, y)
        for orbit in orbits
        for k, (x, y) in enumerate(zip(orbit.x.tolist(), orbit.y.tolist(), strict=True))
    ]
    return write_csv(("channel", "t", "x", "y"), rows)


def _print(
    energy: float,
    escape_energy: float,
    orbits: Sequence[LyapunovOrbit],
    flux: EscapeFlux | None,
    files: Sequence[str],
    as_json: bool,
) -> None:
    answer: dict[str, Any] = {"energy": energy, "escape_energy": escape_energy}
    if not orbits:
        reason = f"h = {energy:g} is not above the escape energy {escape_energy:.12g}"
        sentence = f"No Lyapunov orbits: {reason if math.isfinite(escape_energy) else 'there are no exits'}."
        print_result(as_json, answer | {"orbits": []}, sentence, files=files)
        return
    fluxes = [(None, None)] * len(orbits) if flux is None else list(zip(flux.flux.tolist(), flux.returning.tolist(), strict=True))
    descriptions = [
        {"channel": orbit.channel, "name": orbit.name, "period": orbit.period}
        | {"flux": exit_flux, "returning": returning, "ends": _ends(orbit)}
        for orbit, (exit_flux, returning) in zip(orbits, fluxes, strict=True)
    ]
    rows = [
        (
            *(orbit.name, f"{orbit.period:.12g}"),
            *("" if exit_flux is None else f"{exit_flux:.9g}", "" if returning is None else f"{100.0 * returning:.3g} %"),
            *(f"({x:.12f}, {y:.12f})" for x, y in _ends(orbit)),
        )
        for orbit, (exit_flux, returning) in zip(orbits, fluxes, strict=True)
    ]
    # In a rotating frame, orbits have no turning points: the start and the point half a period later are printed instead.
    point_names = ("turning point (x, y)",) * 2 if flux is not None else ("point (x, y)", "half a period later")
    table = Table(("channel", "period", "flux", "comes back", *point_names), rows)
    answer["orbits"] = descriptions
    sentences: list[str] = []
    if flux is not None:
        answer |= flux.numbers()
        sentences.append(flux.describe())
    print_result(as_json, answer, table, *sentences, files=files)


def _ends(orbit: LyapunovOrbit) -> list[list[float]]:
    """Return (x, y) at the start and half a period later."""
    middle = orbit.x.size // 2
    return [[float(orbit.x[k]), float(orbit.y[k])] for k in (0, middle)]
