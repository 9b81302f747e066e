"""Compute measures of a map, from its pixels and from additional orbits.

Examples:

escape-explorer measures II --energy 0.2 --plane x_y

escape-explorer measures I --energy 0.15 --measure islands --json

escape-explorer measures I --energy 0.15 --window -0.1 0.1 0 0.2 --no-exponent --json
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from typing import Annotated, Any

import typer

from cli.arguments import Slow, check_measures
from cli.execution import THREADS_ONLY, Place
from cli.map_analyses import compute_whole_map
from cli.option_marks import OptionChanges
from cli.options import with_options
from cli.printing import AsJson, print_result
from engine import MEASURES, MapSpec, Result
from engine.measures.compute import measure_map

DESCRIBED = {name: measure for name, measure in MEASURES.items() if measure.sentence is not None}
"""The measures that this command can describe in a sentence, by name."""

MEASURE_HELP = f"{', '.join(DESCRIBED)}; all by default. Can be repeated."


@with_options
def run(
    *,
    spec: Annotated[MapSpec, OptionChanges(without=("backward",))],
    measure: Annotated[list[str] | None, typer.Option(help=MEASURE_HELP)] = None,
    exponent: Slow = True,
    place: Annotated[Place, THREADS_ONLY],
    as_json: AsJson = False,
) -> None:
    """Compute and print the measures of a map."""
    names = _choose(measure, exponent)
    with place.run() as context:
        frame = compute_whole_map(spec, context)
        stages = {name: DESCRIBED[name].title.lower() for name in names}
        results = {name: measure_map(frame, name, execution=context.start_stage(stages[name])) for name in names}
    sentences = {name: _describe(name, result) for name, result in results.items()}
    answer = {name: {"sentence": sentences[name], **_numbers(result)} for name, result in results.items()}
    print_result(as_json, {"request": frame.provenance(), **answer}, *sentences.values())


def _choose(chosen: Sequence[str] | None, slow: bool) -> list[str]:
    """Return the names of the chosen measures, in the order of `DESCRIBED`, without slow measures unless `slow`."""
    names = check_measures(chosen, DESCRIBED) or list(DESCRIBED)
    return [name for name in names if slow or not DESCRIBED[name].slow]


def _describe(name: str, result: Any) -> str:
    sentence = DESCRIBED[name].sentence
    return f"{DESCRIBED[name].title}: not defined for this map." if result is None or sentence is None else sentence(result)


def _numbers(result: Result | None) -> dict[str, Any]:
    """Return the numbers and short arrays of a result."""
    return {} if result is None else {**_plain(result), **result.numbers()}


def _plain(value: Any) -> Any:
    """Replace a result by its shown fields, and results in these fields as well."""
    if not is_dataclass(value) or isinstance(value, type):
        return value
    return {field.name: _plain(getattr(value, field.name)) for field in fields(value) if field.repr}
