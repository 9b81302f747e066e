"""List the catalogue, or show critical points, escape energy and exits of one potential.

Examples:

escape-explorer potential

escape-explorer potential C5@epsilon=0.8

escape-explorer potential "0.5(x^2 + y^2) - x^2 y + y^3/3" --json
"""

from __future__ import annotations

from typing import Annotated, Any

import typer

from cli.arguments import find_potential
from cli.options import with_options
from cli.printing import AsJson, Table, print_result
from engine import POTENTIALS, review_potential
from engine.results import PotentialReview
from engine.systems.catalogue.table import CATALOGUE


@with_options
def run(*, case: Annotated[str | None, typer.Argument(metavar="CASE")] = None, as_json: AsJson = False) -> None:
    """Print the catalogue or the review.

    Parameters
    ----------
    case
        Name or formula; by default all names are listed.
    """
    if case is None:
        _print_catalogue(as_json)
    else:
        _print(review_potential(find_potential(case)), as_json)


def _print_catalogue(as_json: bool) -> None:
    names = ("name", "title", "formula", "description", "reference")
    answer = {"potentials": [{name: getattr(entry, name) for name in names} for entry in CATALOGUE.values()]}
    rows = [(entry.name, entry.formula, f"{POTENTIALS[entry.name].escape_energy:.6g}") for entry in CATALOGUE.values()]
    print_result(as_json, answer, Table(("name", "V(x, y)", "escape energy"), rows))


def _print(review: PotentialReview, as_json: bool) -> None:
    points: list[dict[str, Any]] = [
        {"kind": point.kind.value, "x": point.x, "y": point.y, "energy": point.energy, "channel": point.channel}
        for point in review.critical_points
    ]
    rows = [
        (point.kind.value, f"({point.x:.9g}, {point.y:.9g})", f"{point.energy:.9g}", str(point.channel or ""))
        for point in review.critical_points
    ]
    names = ("formula", "escape_energy", "closed_energy", "channels", "highest_energy")
    answer = {name: getattr(review, name) for name in names} | {"critical_points": points, "remarks": list(review.remarks)}
    exits = f"{review.channels} exits above h = {review.escape_energy:.12g}" if review.channels else "no exits"
    sentence = f"V = {review.formula}: {exits}."
    print_result(as_json, answer, sentence, Table(("critical point", "(x, y)", "V", "channel"), rows), *review.remarks)
