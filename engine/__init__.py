"""Escapes in open Hamiltonian systems with polynomial potentials: orbits, exits, maps. Computes, and knows of no screen."""

from engine.certificates import Certificate, describe_certificate
from engine.crossing_statistics import compute_crossing_statistics, tabulate_crossing_statistics
from engine.energy_curves import (
    EnergyCurves,
    EnergyCurvesSpec,
    EnergyPoint,
    EnergyPointSpec,
    compute_energy_curves,
    measure_energy,
)
from engine.escape_law_fits import fit_escape_laws
from engine.escape_laws import EscapeLaw, EscapeLaws, LawFit
from engine.escape_maps import EscapeMap, describe_codes
from engine.escape_statistics import EscapeStatistics, compute_statistics, compute_survival
from engine.fates import CHAOS_THRESHOLD, Fate, Regularity, Trust, describe_fate, judge_regularity
from engine.formulas import LONGEST_TEXT, parse_formula, typeset, write_formula
from engine.indicators import BirkhoffDigits, IndicatorVerdict, Verdict, compute_birkhoff_digits, judge_indicators
from engine.job_figures import JobFigures
from engine.job_specs import (
    BasinMeasures,
    BasinMeasuresSpec,
    DigitsSpec,
    EscapeLawsSpec,
    ManifoldsSpec,
    MapWish,
    OrbitSpec,
    OriginSpec,
    PreparationSpec,
    Preview,
    PreviewSpec,
    RegularitySpec,
    ReviewAnswer,
    ReviewSpec,
    SeparationSpec,
    TrustSpec,
    TwinAnswer,
    TwinSpec,
    UncertaintySpec,
)
from engine.jobs import Jobs, JobSpec
from engine.known_potentials import POTENTIALS, PotentialEntry, channel_family
from engine.lyapunov_orbits import LyapunovOrbit, find_lyapunov_orbits
from engine.map_specs import LARGEST_SIDE, LONGEST_TIME, MapSpec
from engine.maps import compute_map
from engine.metrics.basin_entropy import BasinEntropy, compute_basin_entropy
from engine.metrics.labels import ENTROPY_COUNTS_BOUNDED, MERGING_COUNTS_BOUNDED, exit_labels
from engine.metrics.merging import MergingTest, compute_merging
from engine.metrics.uncertainty import UncertaintyExponent, compute_uncertainty_exponent, fit_uncertainty
from engine.orbit_batches import count_cores
from engine.orbits import Orbit, integrate_orbit
from engine.origin_fates import OriginFateMap, compute_origin_fates, join_origin_fates
from engine.outcomes import Outcomes, classify_orbits
from engine.paper_fits import PAPER_FITS, HyperbolicTangent, PaperFits, Polynomial
from engine.planes import Plane, Window, default_window, start_states, trace_equipotentials, trace_zero_velocity_curve
from engine.potential_review import CriticalPoint, PointKind, PotentialReview, review_potential
from engine.potentials import CASES, FREQUENCIES, STRENGTHS, Potential
from engine.preparation import is_ready_for_maps, prepare_kernels
from engine.previews import PREVIEW_SIDE, PREVIEW_TIME, compute_preview, preview_spec
from engine.radius_envelopes import RadiusEnvelope, sample_r2
from engine.regularity_maps import RegularityMap, judge_bounded_orbits
from engine.sections import read_section_points
from engine.separations import LONGEST_SEPARATION, Separation, compute_separation
from engine.share_fits import Deviation, ShareFit, fit_direct_shares, fit_escape_shares, measure_deviation
from engine.stable_manifolds import MOST_IMAGES, ManifoldArc, StableManifolds, find_stable_manifolds
from engine.super_sticky import SuperStickyHunt, hunt_super_sticky_orbits
from engine.sweep_specs import SweepSpec
from engine.sweeps import SweepPlan, plan_sweep, run_sweep
from engine.tickets import Ticket
from engine.trust_maps import TrustMap, compute_trust
from engine.twins import Twin, find_twin
from engine.visitors import MOST_REQUESTS, Requests, Visitor

__all__ = [
    "CASES",
    "CHAOS_THRESHOLD",
    "ENTROPY_COUNTS_BOUNDED",
    "FREQUENCIES",
    "LARGEST_SIDE",
    "LONGEST_SEPARATION",
    "LONGEST_TEXT",
    "LONGEST_TIME",
    "MERGING_COUNTS_BOUNDED",
    "MOST_IMAGES",
    "MOST_REQUESTS",
    "PAPER_FITS",
    "POTENTIALS",
    "PREVIEW_SIDE",
    "PREVIEW_TIME",
    "STRENGTHS",
    "BasinEntropy",
    "BasinMeasures",
    "BasinMeasuresSpec",
    "BirkhoffDigits",
    "Certificate",
    "CriticalPoint",
    "Deviation",
    "DigitsSpec",
    "EnergyCurves",
    "EnergyCurvesSpec",
    "EnergyPoint",
    "EnergyPointSpec",
    "EscapeLaw",
    "EscapeLaws",
    "EscapeLawsSpec",
    "EscapeMap",
    "EscapeStatistics",
    "Fate",
    "HyperbolicTangent",
    "IndicatorVerdict",
    "JobFigures",
    "JobSpec",
    "Jobs",
    "LawFit",
    "LyapunovOrbit",
    "ManifoldArc",
    "ManifoldsSpec",
    "MapSpec",
    "MapWish",
    "MergingTest",
    "Orbit",
    "OrbitSpec",
    "OriginFateMap",
    "OriginSpec",
    "Outcomes",
    "PaperFits",
    "Plane",
    "PointKind",
    "Polynomial",
    "Potential",
    "PotentialEntry",
    "PotentialReview",
    "PreparationSpec",
    "Preview",
    "PreviewSpec",
    "RadiusEnvelope",
    "Regularity",
    "RegularityMap",
    "RegularitySpec",
    "Requests",
    "ReviewAnswer",
    "ReviewSpec",
    "Separation",
    "SeparationSpec",
    "ShareFit",
    "StableManifolds",
    "SuperStickyHunt",
    "SweepPlan",
    "SweepSpec",
    "Ticket",
    "Trust",
    "TrustMap",
    "TrustSpec",
    "Twin",
    "TwinAnswer",
    "TwinSpec",
    "UncertaintyExponent",
    "UncertaintySpec",
    "Verdict",
    "Visitor",
    "Window",
    "channel_family",
    "classify_orbits",
    "compute_basin_entropy",
    "compute_birkhoff_digits",
    "compute_crossing_statistics",
    "compute_energy_curves",
    "compute_map",
    "compute_merging",
    "compute_origin_fates",
    "compute_preview",
    "compute_separation",
    "compute_statistics",
    "compute_survival",
    "compute_trust",
    "compute_uncertainty_exponent",
    "count_cores",
    "default_window",
    "describe_certificate",
    "describe_codes",
    "describe_fate",
    "exit_labels",
    "find_lyapunov_orbits",
    "find_stable_manifolds",
    "find_twin",
    "fit_direct_shares",
    "fit_escape_laws",
    "fit_escape_shares",
    "fit_uncertainty",
    "hunt_super_sticky_orbits",
    "integrate_orbit",
    "is_ready_for_maps",
    "join_origin_fates",
    "judge_bounded_orbits",
    "judge_indicators",
    "judge_regularity",
    "measure_deviation",
    "measure_energy",
    "parse_formula",
    "plan_sweep",
    "prepare_kernels",
    "preview_spec",
    "read_section_points",
    "review_potential",
    "run_sweep",
    "sample_r2",
    "start_states",
    "tabulate_crossing_statistics",
    "trace_equipotentials",
    "trace_zero_velocity_curve",
    "typeset",
    "write_formula",
]
