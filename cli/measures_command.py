"""``measures``: how mixed the basins of a map are, and how its orbits leave."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli import options
from cli.options import PlaneName

if TYPE_CHECKING:
    from cli.work import Work
    from engine import EscapeMap

EXAMPLES = """Examples:

escape-explorer measures II --energy 0.2 --plane x_y

escape-explorer measures I --energy 0.15 --window -0.1 0.1 0 0.2 --no-exponent --json
"""

_ENTROPY = ("s_b", "s_b_error", "s_bb", "s_bb_error", "boxes", "boundary_boxes", "labels", "box", "beyond_ln2")
_MERGING = ("basins", "radius", "radius_99", "boundary_pixels")
_EXPONENT = ("exponent", "low", "high", "dimension", "amplitude", "misfit", "separations", "pairs", "uncertain", "used")
_LAWS = ("preferred", "settled", "t_low", "t_high", "escapes", "escapes_in_all", "ratio", "ratio_low", "ratio_high")
_FIT = ("rate", "low", "high", "distance", "p_value")


def measure_basins(
    case: options.Case,
    energy: options.Energy = None,
    energies: options.Energies = None,
    plane: options.Plane = PlaneName.X_PX,
    window: options.Window = None,
    resolution: options.Resolution = "225",
    t_max: options.TMax = 1e5,
    certify: options.Certify = True,
    exponent: Annotated[
        bool, typer.Option("--exponent/--no-exponent", help="Whether to measure the uncertainty exponent, which takes longest.")
    ] = True,
    threads: options.Threads = None,
    as_json: options.AsJson = False,
) -> None:
    """Basin entropy, merging test for Wada basins, uncertainty exponent and escape laws of a map."""
    from cli.answers import print_json, print_sentences
    from cli.map_work import compute_whole_map
    from cli.requests import build_map_spec
    from cli.work import working

    spec = build_map_spec(case, plane, energy, energies, window, resolution, t_max, certify)
    with working(threads) as work:
        frame = compute_whole_map(spec, work, "map")
        measures = _measure(frame, exponent, work)
    if as_json:
        print_json({"request": frame.provenance(), **measures})
    else:
        print_sentences(*(measure["sentence"] for measure in measures.values()))


def _measure(frame: EscapeMap, exponent: bool, work: Work) -> dict[str, dict[str, Any]]:
    """Each measure by name, with its sentence and numbers."""
    from engine import (
        ENTROPY_COUNTS_BOUNDED,
        WADA_COUNTS_BOUNDED,
        compute_basin_entropy,
        compute_statistics,
        compute_uncertainty_exponent,
        compute_wada_test,
        exit_labels,
        fit_decay_laws,
    )

    work.begin("entropy, boundaries and escape laws")
    entropy = compute_basin_entropy(*exit_labels(frame.fate, bounded=ENTROPY_COUNTS_BOUNDED))
    merging = compute_wada_test(*exit_labels(frame.fate, bounded=WADA_COUNTS_BOUNDED))
    laws = fit_decay_laws(compute_statistics(frame), frame.spec.t_max, cancel=work.cancel)
    measures = {"basin_entropy": _numbers(entropy, _ENTROPY), "merging": _numbers(merging, _MERGING)}
    measures["escape_laws"] = _numbers(laws, _LAWS) | {
        name: None if fit is None else {one: getattr(fit, one) for one in _FIT}
        for name, fit in (("exponential", laws.exponential), ("power_law", laws.power_law))
    }
    if exponent:
        report = work.begin("uncertainty exponent")
        found = compute_uncertainty_exponent(frame.spec, on_progress=report, executor=work.executor, cancel=work.cancel)
        measures["uncertainty_exponent"] = _numbers(found, _EXPONENT)
    return measures


def _numbers(measure: Any, names: tuple[str, ...]) -> dict[str, Any]:
    return {"sentence": measure.describe(), **{name: getattr(measure, name) for name in names}}
