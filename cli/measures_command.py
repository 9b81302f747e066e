"""Command ``measures``: fractality of the basins of a map, and decay laws of its escapes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli import options
from cli.options import DEFAULT_PLANE

if TYPE_CHECKING:
    from cli.run_context import RunContext
    from engine import EscapeMap

EXAMPLES = """Examples:

escape-explorer measures II --energy 0.2 --plane x_y

escape-explorer measures I --energy 0.15 --window -0.1 0.1 0 0.2 --no-exponent --json
"""

_ENTROPY = ("s_b", "s_b_error", "s_bb", "s_bb_error", "boxes", "boundary_boxes", "labels", "box", "beyond_ln2")
_MERGING = ("basins", "radius", "radius_99", "boundary_pixels")
_EXPONENT = ("exponent", "low", "high", "dimension", "amplitude", "misfit", "separations", "pairs", "uncertain", "used")
_LAWS = ("preferred", "settled", "t_low", "t_high", "escapes", "escapes_in_all", "ratio", "ratio_low", "ratio_high")
_FIT = ("rate", "low", "high", "p_value")


def measure_basins(
    case: options.Case,
    energy: options.Energy = None,
    energies: options.Energies = None,
    plane: options.Plane = DEFAULT_PLANE,
    fix: options.Fix = None,
    window: options.Window = None,
    resolution: options.Resolution = "224",
    t_max: options.TMax = 1e5,
    use_evidence: options.UseEvidence = True,
    exponent: Annotated[
        bool, typer.Option("--exponent/--no-exponent", help="Whether to compute the uncertainty exponent, which takes longest.")
    ] = True,
    threads: options.Threads = None,
    as_json: options.AsJson = False,
) -> None:
    """Compute basin entropy, Wada test, uncertainty exponent and decay laws of a map."""
    from cli.arguments import build_map_spec
    from cli.map_analyses import compute_whole_map
    from cli.output import print_json, print_sentences
    from cli.run_context import cancellable_run

    spec = build_map_spec(case, plane, fix, energy, energies, window, resolution, t_max, use_evidence)
    with cancellable_run(threads) as run:
        frame = compute_whole_map(spec, run, "map")
        measures = _measure(frame, exponent, run)
    if as_json:
        print_json({"request": frame.provenance(), **measures})
    else:
        print_sentences(*(measure["sentence"] for measure in measures.values()))


def _measure(frame: EscapeMap, exponent: bool, run: RunContext) -> dict[str, dict[str, Any]]:
    """Return the numbers of each measure with a sentence, by name."""
    from engine import compute_basin_entropy, compute_statistics, compute_uncertainty_exponent, compute_wada_test, fit_decay_laws

    entropy = compute_basin_entropy(frame)
    merging = compute_wada_test(frame)
    laws = fit_decay_laws(compute_statistics(frame))
    measures = {"basin_entropy": _numbers(entropy, _ENTROPY), "merging": _numbers(merging, _MERGING)}
    measures["escape_laws"] = _numbers(laws, _LAWS) | {
        name: None if fit is None else {one: getattr(fit, one) for one in _FIT}
        for name, fit in (("exponential", laws.exponential), ("power_law", laws.power_law))
    }
    if exponent:
        found = compute_uncertainty_exponent(frame.spec, execution=run.start_stage("uncertainty exponent"))
        measures["uncertainty_exponent"] = _numbers(found, _EXPONENT)
    return measures


def _numbers(measure: Any, names: tuple[str, ...]) -> dict[str, Any]:
    return {"sentence": measure.describe(), **{name: getattr(measure, name) for name in names}}
