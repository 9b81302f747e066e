"""Names for the programs of this repository: background jobs, warm-up, single steps of analyses, limits, and words.

They are not part of the public interface of `engine` and may change with any version.
"""

from engine.dynamics.certificates import describe_certificate
from engine.dynamics.fates import describe_fate, judge_regularity
from engine.dynamics.portable_system import PortableSystem, make_portable_system
from engine.execution import DEFAULT_EXECUTION, count_cores
from engine.invariant_sets.stable_manifolds import MOST_IMAGES, ManifoldArc
from engine.jobs.client import MOST_REQUESTS, JobClient, JobSubmitter
from engine.jobs.job import Job, Queue
from engine.jobs.manager import Jobs
from engine.jobs.map_jobs import (
    BasinMeasures,
    basin_measures_job,
    decay_laws_job,
    energy_curves_job,
    map_job,
    origin_fate_job,
    regularity_job,
    trust_job,
)
from engine.jobs.stats import JobStats
from engine.jobs.subscription import Subscription
from engine.maps.compute import run_map
from engine.maps.origin_fates import join_origin_fates
from engine.maps.result import describe_codes
from engine.maps.spec import DEFAULT_RESOLUTION, LARGEST_SIDE
from engine.maps.super_sticky import SuperStickySearch, find_super_sticky_orbits
from engine.measures.decay_laws import DecayLaw, LawFit
from engine.measures.escape_statistics import compute_survival
from engine.measures.labels import ENTROPY_COUNTS_BOUNDED, WADA_COUNTS_BOUNDED, exit_labels
from engine.measures.published_fits import HyperbolicTangent, PaperFits, Polynomial
from engine.measures.share_fits import Deviation
from engine.measures.uncertainty_exponent import fit_uncertainty
from engine.potentials.catalogue import PotentialEntry
from engine.potentials.energy_ranges import HIGHEST_SHOWN, PAPER_ENERGIES, EnergyRange
from engine.potentials.formula_parser import LONGEST_TEXT
from engine.potentials.potential import FREQUENCIES, STRENGTHS
from engine.potentials.system import PARAMETERS, SHOWN_DIGITS, TYPED, System
from engine.potentials.validation_report import CriticalPoint, PointKind
from engine.results.wording import format_number, format_time, format_whole
from engine.slices.limiting_curves import trace_equipotentials
from engine.slices.section import SECTION
from engine.slices.slice import SPACE, checked_slice, common_energy, highest_energy
from engine.storage.output_lock import hold_lock
from engine.sweeps.crossing_statistics import tabulate_crossing_statistics
from engine.sweeps.energy_curves import EnergyPoint, EnergyPointSpec, compute_energy_point
from engine.sweeps.run import SweepPlan, plan_sweep
from engine.taylor.jit.compiled_operations import compiled_operations
from engine.trajectories.chaos_indicators import IndicatorVerdict, evaluate_indicators
from engine.trajectories.radius_envelope import RadiusEnvelope, compute_radius_envelope
from engine.trajectories.separation import LONGEST_SEPARATION
from engine.validation import LARGEST_NUMBER, LONGEST_TIME
from engine.warmup import (
    is_ready_for_maps,
    prepare_for_certificates,
    prepare_for_maps,
    prepare_kernels,
    seconds_until_ready_for_maps,
)

__all__ = [
    "DEFAULT_EXECUTION",
    "DEFAULT_RESOLUTION",
    "ENTROPY_COUNTS_BOUNDED",
    "FREQUENCIES",
    "HIGHEST_SHOWN",
    "LARGEST_NUMBER",
    "LARGEST_SIDE",
    "LONGEST_SEPARATION",
    "LONGEST_TEXT",
    "LONGEST_TIME",
    "MOST_IMAGES",
    "MOST_REQUESTS",
    "PAPER_ENERGIES",
    "PARAMETERS",
    "SECTION",
    "SHOWN_DIGITS",
    "SPACE",
    "STRENGTHS",
    "TYPED",
    "WADA_COUNTS_BOUNDED",
    "BasinMeasures",
    "CriticalPoint",
    "DecayLaw",
    "Deviation",
    "EnergyPoint",
    "EnergyPointSpec",
    "EnergyRange",
    "HyperbolicTangent",
    "IndicatorVerdict",
    "Job",
    "JobClient",
    "JobStats",
    "JobSubmitter",
    "Jobs",
    "LawFit",
    "ManifoldArc",
    "PaperFits",
    "PointKind",
    "Polynomial",
    "PortableSystem",
    "PotentialEntry",
    "Queue",
    "RadiusEnvelope",
    "Subscription",
    "SuperStickySearch",
    "SweepPlan",
    "System",
    "basin_measures_job",
    "checked_slice",
    "common_energy",
    "compiled_operations",
    "compute_energy_point",
    "compute_radius_envelope",
    "compute_survival",
    "count_cores",
    "decay_laws_job",
    "describe_certificate",
    "describe_codes",
    "describe_fate",
    "energy_curves_job",
    "evaluate_indicators",
    "exit_labels",
    "find_super_sticky_orbits",
    "fit_uncertainty",
    "format_number",
    "format_time",
    "format_whole",
    "highest_energy",
    "hold_lock",
    "is_ready_for_maps",
    "join_origin_fates",
    "judge_regularity",
    "make_portable_system",
    "map_job",
    "origin_fate_job",
    "plan_sweep",
    "prepare_for_certificates",
    "prepare_for_maps",
    "prepare_kernels",
    "regularity_job",
    "run_map",
    "seconds_until_ready_for_maps",
    "tabulate_crossing_statistics",
    "trace_equipotentials",
    "trust_job",
]
