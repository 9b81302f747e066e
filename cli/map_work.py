"""A map and the second looks at it, one after the other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import isnan
from typing import Any

from app.rendering.map_analyses import MapAnalyses
from cli.work import Work
from engine import (
    MOST_IMAGES,
    EscapeMap,
    MapSpec,
    Plane,
    compute_map,
    compute_regularity,
    compute_trust,
    find_stable_manifolds,
    join_origin_fates,
)


@dataclass(frozen=True)
class FollowUpRequests:
    """What else is asked of a map: the character of bounded orbits, where all come from, doubtful pixels, images of manifolds."""

    judge: bool
    origins: bool
    trust: bool
    images: int

    @property
    def pictures(self) -> list[str]:
        """The pictures that belong to these."""
        return [name for name, asked in (("characters", self.judge), ("origins", self.origins)) if asked]

    def check(self, spec: MapSpec) -> None:
        """ValueError when one of them has no meaning for a map."""
        if not 0 <= self.images <= MOST_IMAGES:
            raise ValueError(f"manifolds={self.images}: must be from 0 to {MOST_IMAGES} images")
        if self.images and (spec.plane is not Plane.X_PX or spec.backward):
            raise ValueError(f"manifolds={self.images}: they are cut by the plane x_px and are of orbits into the future")
        if self.origins and spec.backward:
            raise ValueError("origins: follow orbits both ways; leave --backward out")


def compute_with_second_looks(spec: MapSpec, wanted: FollowUpRequests, work: Work) -> tuple[EscapeMap, MapAnalyses]:
    """The whole map, and all that was asked of it; CancelledError when stopped."""
    frame = compute_whole_map(spec, work, "map")
    found: dict[str, Any] = {}
    if wanted.judge:
        work.begin("bounded orbits")
        found["regularity"] = compute_regularity(frame, None, work.cancel, work.executor)
    if wanted.origins:
        found["origins"] = join_origin_fates(frame, compute_whole_map(replace(spec, backward=True), work, "origins"))
    if wanted.trust:
        work.begin("doubtful pixels")
        found["trust"] = compute_trust(frame, None, work.cancel, work.executor)
    if wanted.images:
        assert not isinstance(spec.energy, tuple)
        work.begin("stable manifolds")
        found["manifolds"] = find_stable_manifolds(
            spec.potential, spec.energy, wanted.images, window=spec.window, executor=work.executor, cancel=work.cancel
        )
    work.stop_if_cancelled()
    return frame, MapAnalyses(**found)


def compute_whole_map(spec: MapSpec, work: Work, stage: str) -> EscapeMap:
    """A map, to its end; CancelledError when stopped."""
    frame = compute_map(spec, _tell(work.begin(stage)), work.cancel, work.executor)
    work.stop_if_cancelled()
    return frame


def _tell(report: Callable[[float], None] | None) -> Callable[[EscapeMap], None] | None:
    return None if report is None else lambda frame: report(frame.progress)


def describe_findings(findings: MapAnalyses) -> list[str]:
    """What was found, a sentence each."""
    sentences = []
    if findings.regularity is not None:
        share = findings.regularity.chaotic_share
        sentences.append("No orbit is bounded." if isnan(share) else f"Of the bounded orbits {100 * share:.2f} % are chaotic.")
    if findings.origins is not None:
        sentences.append(findings.origins.describe())
    if findings.trust is not None:
        sentences.append(findings.trust.describe())
    if findings.manifolds is not None:
        arcs = findings.manifolds.arcs
        cut = ", some of them left unfinished" if findings.manifolds.truncated else ""
        sentences.append(f"Stable manifolds: {len(arcs)} arcs of {sum(arc.x.size for arc in arcs)} points{cut}.")
    return sentences
