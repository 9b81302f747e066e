"""Compute basin entropy, Wada test, uncertainty exponent and decay laws of a map.

Examples:

escape-explorer measures II --energy 0.2 --plane x_y

escape-explorer measures I --energy 0.15 --window -0.1 0.1 0 0.2 --no-exponent --json
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

from cli.arguments import Exponent
from cli.execution import THREADS_ONLY, Place, RunContext
from cli.map_analyses import compute_whole_map
from cli.option_marks import But
from cli.options import with_options
from cli.printing import AsJson, print_result
from engine import (
    EscapeMap,
    MapSpec,
    compute_basin_entropy,
    compute_statistics,
    compute_uncertainty_exponent,
    compute_wada_test,
    fit_decay_laws,
)

_ENTROPY = ("s_b", "s_b_error", "s_bb", "s_bb_error", "boxes", "boundary_boxes", "labels", "box", "beyond_ln2")
_MERGING = ("basins", "radius", "radius_99", "boundary_pixels")
_EXPONENT = ("exponent", "low", "high", "dimension", "amplitude", "misfit", "separations", "pairs", "uncertain", "used")
_LAWS = ("preferred", "settled", "t_low", "t_high", "escapes", "escapes_in_all", "ratio", "ratio_low", "ratio_high")
_FIT = ("rate", "low", "high", "p_value")


@with_options
def run(
    *,
    spec: Annotated[MapSpec, But(without=("backward",))],
    exponent: Exponent = True,
    place: Annotated[Place, THREADS_ONLY],
    as_json: AsJson = False,
) -> None:
    """Compute and print the measures of a map."""
    with place.run() as context:
        frame = compute_whole_map(spec, context, "map")
        measures = _measure(frame, exponent, context)
    sentences = [measure["sentence"] for measure in measures.values()]
    print_result(as_json, {"request": frame.provenance(), **measures}, *sentences)


def _measure(frame: EscapeMap, exponent: bool, context: RunContext) -> dict[str, dict[str, Any]]:
    """Return the numbers of each measure with a sentence, by name."""
    laws = fit_decay_laws(compute_statistics(frame))
    fits = {"exponential": laws.exponential, "power_law": laws.power_law}
    measures = {
        "basin_entropy": _numbers(compute_basin_entropy(frame), _ENTROPY),
        "merging": _numbers(compute_wada_test(frame), _MERGING),
        "escape_laws": _numbers(laws, _LAWS)
        | {name: None if fit is None else {one: getattr(fit, one) for one in _FIT} for name, fit in fits.items()},
    }
    if exponent:
        found = compute_uncertainty_exponent(frame.spec, execution=context.start_stage("uncertainty exponent"))
        measures["uncertainty_exponent"] = _numbers(found, _EXPONENT)
    return measures


def _numbers(measure: Any, names: Sequence[str]) -> dict[str, Any]:
    return {"sentence": measure.describe(), **{name: getattr(measure, name) for name in names}}
