"""Names for the programs of this repository: background jobs, warm-up, single steps of analyses, limits, and words.

They are not part of the public interface of `engine` and may change with any version.
"""

from engine.dynamics.certificates import describe_certificate
from engine.dynamics.fates import UNRESOLVED, describe_fate, is_chaotic, name_fate, outcome_of
from engine.dynamics.portable_system import PortableSystem, make_portable_system
from engine.execution import DEFAULT_EXECUTION, count_cores
from engine.exits.lyapunov_orbits import find_known_exits
from engine.expressions.nodes import Coordinate as CoordinateNode
from engine.expressions.nodes import Expression, Function, Product, Sum
from engine.invariant_sets.stable_manifolds import MOST_IMAGES, ManifoldArc
from engine.jobs.client import MOST_REQUESTS, JobClient, JobSubmitter
from engine.jobs.job import Job, Queue
from engine.jobs.manager import Jobs
from engine.jobs.map_jobs import (
    BasinMeasures,
    basin_measures_job,
    curves_job,
    decay_laws_job,
    flux_job,
    map_job,
    origin_fate_job,
    regularity_job,
    trust_job,
)
from engine.jobs.stats import JobStats
from engine.jobs.subscription import Subscription
from engine.maps.compute import run_map
from engine.maps.origin_fates import join_origin_fates
from engine.maps.spec import DEFAULT_RESOLUTION, LARGEST_SIDE, finest_pixel
from engine.maps.super_sticky import SuperStickySearch, find_super_sticky_orbits
from engine.measures.decay_laws import DecayLaw, LawFit
from engine.measures.escape_statistics import compute_survival
from engine.measures.labels import ENTROPY_COUNTS_BOUNDED, WADA_COUNTS_BOUNDED, exit_labels
from engine.measures.published_fits import HyperbolicTangent, PaperFits, Polynomial
from engine.measures.share_fits import Deviation
from engine.measures.uncertainty_exponent import fit_uncertainty
from engine.potentials.catalogue import CATALOGUE
from engine.potentials.energy_ranges import HIGHEST_SHOWN, PAPER_ENERGIES, EnergyRange, critical_energies, depth_levels
from engine.potentials.forms.expression_form import ExpressionForm
from engine.potentials.forms.form import Form
from engine.potentials.forms.polynomial_form import PolynomialForm
from engine.potentials.formulas.formula_parser import LARGEST_VALUE, LONGEST_TEXT, checked_letter_value, formula_letters
from engine.potentials.outcomes import OutcomeKind
from engine.potentials.potential_entry import PotentialEntry
from engine.potentials.system import PARAMETERS, RANGES, SHOWN_DIGITS, TYPED
from engine.potentials.validation_report import CriticalPoint, PointKind
from engine.results.codes import describe_codes
from engine.results.extras import require_package
from engine.results.wording import format_number, format_time, format_whole, short_fraction
from engine.slices.energies import common_energy, highest_energy
from engine.slices.limiting_curves import trace_equipotentials
from engine.slices.planes import SPACE, checked_slice
from engine.slices.section import SECTION
from engine.slices.slice_text import AXIS_NAMES, default_range, read_slice, write_slice
from engine.storage.output_lock import hold_lock
from engine.sweeps.crossing_statistics import tabulate_crossing_statistics
from engine.sweeps.curve_points import CurvePoint, CurvePointSpec, compute_curve_point
from engine.taylor.jit.compiled_operations import compiled_operations
from engine.trajectories.radius_envelope import RadiusEnvelope, compute_radius_envelope
from engine.trajectories.separation import LONGEST_SEPARATION
from engine.validation import LARGEST_NUMBER, LONGEST_TIME
from engine.warmup import (
    is_ready_for_maps,
    prepare_for_certificates,
    prepare_for_maps,
    prepare_kernels,
    reserve_catalogue,
    seconds_until_ready_for_maps,
)

__all__ = [
    "AXIS_NAMES",
    "CATALOGUE",
    "DEFAULT_EXECUTION",
    "DEFAULT_RESOLUTION",
    "ENTROPY_COUNTS_BOUNDED",
    "HIGHEST_SHOWN",
    "LARGEST_NUMBER",
    "LARGEST_SIDE",
    "LARGEST_VALUE",
    "LONGEST_SEPARATION",
    "LONGEST_TEXT",
    "LONGEST_TIME",
    "MOST_IMAGES",
    "MOST_REQUESTS",
    "PAPER_ENERGIES",
    "PARAMETERS",
    "RANGES",
    "SECTION",
    "SHOWN_DIGITS",
    "SPACE",
    "TYPED",
    "UNRESOLVED",
    "WADA_COUNTS_BOUNDED",
    "BasinMeasures",
    "CoordinateNode",
    "CriticalPoint",
    "CurvePoint",
    "CurvePointSpec",
    "DecayLaw",
    "Deviation",
    "EnergyRange",
    "Expression",
    "ExpressionForm",
    "Form",
    "Function",
    "HyperbolicTangent",
    "Job",
    "JobClient",
    "JobStats",
    "JobSubmitter",
    "Jobs",
    "LawFit",
    "ManifoldArc",
    "OutcomeKind",
    "PaperFits",
    "PointKind",
    "Polynomial",
    "PolynomialForm",
    "PortableSystem",
    "PotentialEntry",
    "Product",
    "Queue",
    "RadiusEnvelope",
    "Subscription",
    "Sum",
    "SuperStickySearch",
    "basin_measures_job",
    "checked_letter_value",
    "checked_slice",
    "common_energy",
    "compiled_operations",
    "compute_curve_point",
    "compute_radius_envelope",
    "compute_survival",
    "count_cores",
    "critical_energies",
    "curves_job",
    "decay_laws_job",
    "default_range",
    "depth_levels",
    "describe_certificate",
    "describe_codes",
    "describe_fate",
    "exit_labels",
    "find_known_exits",
    "find_super_sticky_orbits",
    "finest_pixel",
    "fit_uncertainty",
    "flux_job",
    "format_number",
    "format_time",
    "format_whole",
    "formula_letters",
    "highest_energy",
    "hold_lock",
    "is_chaotic",
    "is_ready_for_maps",
    "join_origin_fates",
    "make_portable_system",
    "map_job",
    "name_fate",
    "origin_fate_job",
    "outcome_of",
    "prepare_for_certificates",
    "prepare_for_maps",
    "prepare_kernels",
    "read_slice",
    "regularity_job",
    "require_package",
    "reserve_catalogue",
    "run_map",
    "seconds_until_ready_for_maps",
    "short_fraction",
    "tabulate_crossing_statistics",
    "trace_equipotentials",
    "trust_job",
    "write_slice",
]
