"""A map and its analyses, computed one after the other."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from math import isnan
from typing import Annotated, Any

import typer

from cli.execution import RunContext
from engine import EscapeMap, MapSpec, compute_map, compute_regularity, compute_trust, find_stable_manifolds
from engine.maps.origin_fates import join_origin_fates
from engine.periodic.stable_manifolds import MOST_IMAGES
from engine.slices.section import SECTION
from plots.pictures.map_analyses import MapAnalyses


@dataclass(frozen=True)
class AnalysisOptions:
    """Requested analyses.

    Attributes
    ----------
    trust
        Find and mark doubtful pixels, whose fate depends on rounding.
    judge
        Classify bounded orbits as regular or chaotic.
    origins
        Find the exit that each orbit entered by.
    manifolds
        Number of images of the stable manifolds, on x_px; 0 for none.
    """

    trust: bool = False
    judge: bool = False
    origins: bool = False
    manifolds: Annotated[int, typer.Option(metavar="IMAGES", min=0, max=MOST_IMAGES)] = 0

    def with_pictures(self, pictures: Collection[str]) -> AnalysisOptions:
        """Return them with those that some pictures need."""
        return replace(self, judge=self.judge or "characters" in pictures, origins=self.origins or "origins" in pictures)

    @property
    def pictures(self) -> list[str]:
        """Pictures of the requested analyses."""
        return [name for name, requested in (("characters", self.judge), ("origins", self.origins)) if requested]

    def check(self, spec: MapSpec) -> None:
        """Raise ValueError if an analysis is not defined for the map."""
        if self.manifolds and (spec.plane != SECTION.plane or spec.backward):
            raise ValueError(f"manifolds={self.manifolds}: stable manifolds need --plane {SECTION.plane.key}, and no --backward")
        if self.origins and spec.backward:
            raise ValueError("origins: cannot be combined with --backward")


def compute_map_with_analyses(spec: MapSpec, wanted: AnalysisOptions, run: RunContext) -> tuple[EscapeMap, MapAnalyses]:
    """Return the complete map and its analyses; CancelledError if interrupted."""
    frame = compute_whole_map(spec, run, "map")
    found: dict[str, Any] = {}
    if wanted.judge:
        found["regularity"] = compute_regularity(frame, execution=run.start_stage("bounded orbits"))
    if wanted.origins:
        found["origins"] = join_origin_fates(frame, compute_whole_map(replace(spec, backward=True), run, "origins"))
    if wanted.trust:
        found["trust"] = compute_trust(frame, execution=run.start_stage("doubtful pixels"))
    if wanted.manifolds:
        assert spec.common_energy is not None
        found["manifolds"] = find_stable_manifolds(
            spec.potential,
            spec.common_energy,
            images=wanted.manifolds,
            window=spec.find_window(),
            execution=run.start_stage("stable manifolds"),
        )
    run.execution.raise_if_cancelled()
    return frame, MapAnalyses(**found)


def compute_whole_map(spec: MapSpec, run: RunContext, stage: str) -> EscapeMap:
    """Return the complete map; CancelledError if interrupted."""
    frame = compute_map(spec, execution=run.start_stage(stage))
    run.execution.raise_if_cancelled()
    return frame


def describe_analyses(analyses: MapAnalyses) -> list[str]:
    """Return one sentence per analysis."""
    sentences = []
    if analyses.regularity is not None:
        share = analyses.regularity.chaotic_share
        sentences.append("No orbit is bounded." if isnan(share) else f"Of the bounded orbits {100 * share:.2f} % are chaotic.")
    if analyses.origins is not None:
        sentences.append(analyses.origins.describe())
    if analyses.trust is not None:
        sentences.append(analyses.trust.describe())
    if analyses.manifolds is not None:
        arcs = analyses.manifolds.arcs
        cut = ", some of them left unfinished" if analyses.manifolds.truncated else ""
        sentences.append(f"Stable manifolds: {len(arcs)} arcs of {sum(arc.x.size for arc in arcs)} points{cut}.")
    return sentences
