"""Escapes in open Hamiltonian systems with two degrees of freedom and polynomial potentials.

These are the public names of the library; it does not depend on the page in `app`.

- systems: `Potential`, `CASES`, `parse_formula`, `review_potential`
- orbits: `integrate_orbit`, `classify_orbits`, `find_lyapunov_orbits`, `evaluate_indicators`, `judge_orbit`
- maps of escapes: `MapSpec`, `compute_map`, `compute_preview`, `compute_regularity`, `compute_trust`
- basins and statistics: `compute_basin_entropy`, `compute_wada_test`, `compute_uncertainty_exponent`, `compute_statistics`
- energies: `compute_energy_curves`, `compute_crossing_statistics`, `run_sweep`
- background jobs: `Jobs`, `JobClient` and the requests
"""

from engine.basins.basin_entropy import BasinEntropy, compute_basin_entropy
from engine.basins.labels import ENTROPY_COUNTS_BOUNDED, WADA_COUNTS_BOUNDED, exit_labels
from engine.basins.uncertainty_exponent import UncertaintyExponent, compute_uncertainty_exponent, fit_uncertainty
from engine.basins.wada import WadaTest, compute_wada_test
from engine.dynamics.certificates import Certificate, describe_certificate
from engine.dynamics.classification import Outcomes, classify_orbits
from engine.dynamics.fates import CHAOS_THRESHOLD, Fate, Regularity, Trust, describe_fate, judge_regularity
from engine.dynamics.lyapunov_orbits import LyapunovOrbit, find_lyapunov_orbits
from engine.dynamics.planes import Plane, Window, default_window, start_states, trace_equipotentials, trace_zero_velocity_curve
from engine.execution import count_cores
from engine.invariant_sets.stable_manifolds import MOST_IMAGES, ManifoldArc, StableManifolds, find_stable_manifolds
from engine.jobs.client import MOST_REQUESTS, JobClient, JobSubmitter
from engine.jobs.context import JobRequest
from engine.jobs.manager import Jobs
from engine.jobs.requests import (
    Answer,
    BasinMeasures,
    BasinMeasuresRequest,
    BirkhoffDigitsRequest,
    DecayLawsRequest,
    DivergentStartRequest,
    EnergyCurvesRequest,
    EnergyPointRequest,
    OrbitRequest,
    OriginFateRequest,
    PotentialReviewRequest,
    PreviewRequest,
    RegularityRequest,
    SeparationRequest,
    StableManifoldsRequest,
    TrustRequest,
    UncertaintyExponentRequest,
    UnresolvedMapSpec,
    WarmupRequest,
)
from engine.jobs.stats import JobStats
from engine.jobs.subscription import Subscription
from engine.maps.compute import compute_map
from engine.maps.origin_fates import OriginFateMap, compute_origin_fates, join_origin_fates
from engine.maps.preview import PREVIEW_SIDE, PREVIEW_TIME, compute_preview, preview_spec
from engine.maps.regularity import RegularityMap, compute_regularity
from engine.maps.result import EscapeMap, describe_codes
from engine.maps.spec import LARGEST_SIDE, MapSpec
from engine.maps.super_sticky import SuperStickySearch, find_super_sticky_orbits
from engine.maps.trust import TrustMap, compute_trust
from engine.potentials.catalogue import POTENTIALS, PotentialEntry, channel_family
from engine.potentials.formula_parser import LONGEST_TEXT, parse_formula, write_formula
from engine.potentials.potential import CASES, FREQUENCIES, STRENGTHS, Potential
from engine.potentials.validation_report import CriticalPoint, PointKind, PotentialReview, review_potential
from engine.representation import Result
from engine.statistics.decay_law_fits import fit_decay_laws
from engine.statistics.decay_laws import DecayLaw, DecayLaws, LawFit
from engine.statistics.escape_statistics import EscapeStatistics, compute_statistics, compute_survival
from engine.statistics.published_fits import PAPER_FITS, HyperbolicTangent, PaperFits, Polynomial
from engine.statistics.share_fits import Deviation, ShareFit, fit_direct_shares, fit_escape_shares, measure_deviation
from engine.sweeps.crossing_statistics import compute_crossing_statistics, tabulate_crossing_statistics
from engine.sweeps.energy_curves import (
    EnergyCurves,
    EnergyCurvesSpec,
    EnergyPoint,
    EnergyPointSpec,
    compute_energy_curves,
    compute_energy_point,
)
from engine.sweeps.run import SweepPlan, plan_sweep, run_sweep
from engine.sweeps.spec import SweepSpec
from engine.trajectories.chaos_indicators import (
    BirkhoffDigits,
    IndicatorVerdict,
    Verdict,
    compute_birkhoff_digits,
    evaluate_indicators,
)
from engine.trajectories.nearest_divergent_start import DivergentStart, find_divergent_start
from engine.trajectories.orbit_verdicts import OrbitVerdict, judge_orbit
from engine.trajectories.radius_envelope import RadiusEnvelope, compute_radius_envelope
from engine.trajectories.section_crossings import find_section_crossings
from engine.trajectories.separation import LONGEST_SEPARATION, Separation, compute_separation
from engine.trajectories.trajectory import Orbit, integrate_orbit
from engine.validation import LONGEST_TIME
from engine.warmup import (
    is_ready_for_maps,
    prepare_for_certificates,
    prepare_for_maps,
    prepare_kernels,
    seconds_until_ready_for_maps,
)
from engine.wording import format_number, format_time, format_whole

__all__ = [
    "CASES",
    "CHAOS_THRESHOLD",
    "ENTROPY_COUNTS_BOUNDED",
    "FREQUENCIES",
    "LARGEST_SIDE",
    "LONGEST_SEPARATION",
    "LONGEST_TEXT",
    "LONGEST_TIME",
    "MOST_IMAGES",
    "MOST_REQUESTS",
    "PAPER_FITS",
    "POTENTIALS",
    "PREVIEW_SIDE",
    "PREVIEW_TIME",
    "STRENGTHS",
    "WADA_COUNTS_BOUNDED",
    "Answer",
    "BasinEntropy",
    "BasinMeasures",
    "BasinMeasuresRequest",
    "BirkhoffDigits",
    "BirkhoffDigitsRequest",
    "Certificate",
    "CriticalPoint",
    "DecayLaw",
    "DecayLaws",
    "DecayLawsRequest",
    "Deviation",
    "DivergentStart",
    "DivergentStartRequest",
    "EnergyCurves",
    "EnergyCurvesRequest",
    "EnergyCurvesSpec",
    "EnergyPoint",
    "EnergyPointRequest",
    "EnergyPointSpec",
    "EscapeMap",
    "EscapeStatistics",
    "Fate",
    "HyperbolicTangent",
    "IndicatorVerdict",
    "JobClient",
    "JobRequest",
    "JobStats",
    "JobSubmitter",
    "Jobs",
    "LawFit",
    "LyapunovOrbit",
    "ManifoldArc",
    "MapSpec",
    "Orbit",
    "OrbitRequest",
    "OrbitVerdict",
    "OriginFateMap",
    "OriginFateRequest",
    "Outcomes",
    "PaperFits",
    "Plane",
    "PointKind",
    "Polynomial",
    "Potential",
    "PotentialEntry",
    "PotentialReview",
    "PotentialReviewRequest",
    "PreviewRequest",
    "RadiusEnvelope",
    "Regularity",
    "RegularityMap",
    "RegularityRequest",
    "Result",
    "Separation",
    "SeparationRequest",
    "ShareFit",
    "StableManifolds",
    "StableManifoldsRequest",
    "Subscription",
    "SuperStickySearch",
    "SweepPlan",
    "SweepSpec",
    "Trust",
    "TrustMap",
    "TrustRequest",
    "UncertaintyExponent",
    "UncertaintyExponentRequest",
    "UnresolvedMapSpec",
    "Verdict",
    "WadaTest",
    "WarmupRequest",
    "Window",
    "channel_family",
    "classify_orbits",
    "compute_basin_entropy",
    "compute_birkhoff_digits",
    "compute_crossing_statistics",
    "compute_energy_curves",
    "compute_energy_point",
    "compute_map",
    "compute_origin_fates",
    "compute_preview",
    "compute_radius_envelope",
    "compute_regularity",
    "compute_separation",
    "compute_statistics",
    "compute_survival",
    "compute_trust",
    "compute_uncertainty_exponent",
    "compute_wada_test",
    "count_cores",
    "default_window",
    "describe_certificate",
    "describe_codes",
    "describe_fate",
    "evaluate_indicators",
    "exit_labels",
    "find_divergent_start",
    "find_lyapunov_orbits",
    "find_section_crossings",
    "find_stable_manifolds",
    "find_super_sticky_orbits",
    "fit_decay_laws",
    "fit_direct_shares",
    "fit_escape_shares",
    "fit_uncertainty",
    "format_number",
    "format_time",
    "format_whole",
    "integrate_orbit",
    "is_ready_for_maps",
    "join_origin_fates",
    "judge_orbit",
    "judge_regularity",
    "measure_deviation",
    "parse_formula",
    "plan_sweep",
    "prepare_for_certificates",
    "prepare_for_maps",
    "prepare_kernels",
    "preview_spec",
    "review_potential",
    "run_sweep",
    "seconds_until_ready_for_maps",
    "start_states",
    "tabulate_crossing_statistics",
    "trace_equipotentials",
    "trace_zero_velocity_curve",
    "write_formula",
]
