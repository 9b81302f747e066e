"""Compute a map, then the results of its layers."""

from __future__ import annotations

from cli.execution import RunContext
from cli.layer_options import LayerOptions
from engine import EscapeMap, MapSpec, compute_map
from engine.jobs.job import run_job
from engine.maps.map_jobs import map_job
from plots.layers.layer import Analyses


def compute_map_with_layers(spec: MapSpec, requested_layers: LayerOptions, context: RunContext) -> tuple[EscapeMap, Analyses]:
    """Return the complete map and the results of its layers; CancelledError if interrupted."""
    frame = compute_whole_map(spec, context)
    results = {}
    for layer in requested_layers.layers:
        results[layer.name] = run_job(
            layer.job(spec, requested_layers.values), context.start_stage(layer.stage), {map_job(spec): frame}
        )
    return frame, results


def compute_whole_map(spec: MapSpec, context: RunContext) -> EscapeMap:
    """Return the complete map; CancelledError if interrupted."""
    frame = compute_map(spec, execution=context.start_stage("map"))
    context.execution.raise_if_cancelled()
    return frame
