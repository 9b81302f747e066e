"""Compute a map, then the results of its layers."""

from __future__ import annotations

from concurrent.futures import CancelledError
from pathlib import Path

from cli.execution import RunContext
from cli.layer_options import LayerOptions
from engine import EscapeMap, MapSpec, compute_map
from engine.jobs.job import run_job
from engine.maps.map_jobs import map_job
from plots.layers.layer import Analyses


def compute_map_with_layers(
    spec: MapSpec, requested_layers: LayerOptions, context: RunContext, store: Path | None = None
) -> tuple[EscapeMap, Analyses]:
    """Return the complete map, which a store keeps, and the results of its layers; CancelledError if interrupted."""
    frame = compute_whole_map(spec, context, store)
    results = {}
    for layer in requested_layers.layers:
        results[layer.name] = run_job(
            layer.job(spec, requested_layers.values), context.start_stage(layer.stage), {map_job(spec): frame}
        )
    return frame, results


def compute_whole_map(spec: MapSpec, context: RunContext, store: Path | None = None) -> EscapeMap:
    """Return the complete map, which a store keeps; CancelledError if interrupted."""
    frame = compute_map(spec, store=store, execution=context.start_stage("map"))
    if store is not None and context.execution.is_cancelled:
        raise CancelledError(f"interrupted; finished blocks are kept in {store}, and the same command continues from there")
    context.execution.raise_if_cancelled()
    return frame
