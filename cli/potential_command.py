"""Command ``potential``: list the catalogue, or review one potential."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli import options

if TYPE_CHECKING:
    from engine import PotentialReview

EXAMPLES = """Examples:

escape-explorer potential

escape-explorer potential C5@epsilon=0.8

escape-explorer potential "0.5(x^2 + y^2) - x^2 y + y^3/3" --json
"""


def describe_potential(
    case: Annotated[str | None, typer.Argument(metavar="CASE", help="Name or formula; by default all names are listed.")] = None,
    as_json: options.AsJson = False,
) -> None:
    """List the catalogue, or show critical points, escape energy and channels of one potential."""
    if case is None:
        _list_catalogue(as_json)
        return
    from cli.potential_argument import find_potential
    from engine import review_potential

    _print_result(review_potential(find_potential(case)), as_json)


def _list_catalogue(as_json: bool) -> None:
    from cli.output import print_json, print_table
    from engine import POTENTIALS
    from engine.systems.catalogue.table import CATALOGUE

    if as_json:
        names = ("name", "title", "formula", "description", "reference")
        print_json({"potentials": [{name: getattr(entry, name) for name in names} for entry in CATALOGUE.values()]})
        return
    rows = [(entry.name, entry.formula, f"{POTENTIALS[entry.name].escape_energy:.6g}") for entry in CATALOGUE.values()]
    print_table(("name", "V(x, y)", "escape energy"), rows)


def _print_result(found: PotentialReview, as_json: bool) -> None:
    from cli.output import print_json, print_sentences, print_table

    points: list[dict[str, Any]] = [
        {"kind": point.kind.value, "x": point.x, "y": point.y, "energy": point.energy, "channel": point.channel}
        for point in found.critical_points
    ]
    if as_json:
        numbers = {"escape_energy": found.escape_energy, "channels": found.channels, "highest_energy": found.highest_energy}
        print_json({"formula": found.formula, **numbers, "critical_points": points, "remarks": list(found.remarks)})
        return
    print_sentences(f"V = {found.formula}: {found.channels} channels above h = {found.escape_energy:.12g}.")
    rows = [
        (one["kind"], f"({one['x']:.9g}, {one['y']:.9g})", f"{one['energy']:.9g}", str(one["channel"] or "")) for one in points
    ]
    print_table(("critical point", "(x, y)", "V", "channel"), rows)
    print_sentences(*found.remarks)
