"""Escapes in open Hamiltonian systems with polynomial potentials: orbits, exits, maps. Computes, and knows of no screen."""

from engine.certificates import Certificate, describe_certificate
from engine.escape_maps import EscapeMap
from engine.escape_statistics import EscapeStatistics, compute_statistics
from engine.fates import CHAOS_THRESHOLD, Fate, Regularity, describe_fate, judge_regularity
from engine.job_specs import OrbitSpec, SeparationSpec, TwinSpec
from engine.jobs import Jobs, Ticket
from engine.lyapunov_orbits import LyapunovOrbit, find_lyapunov_orbits
from engine.map_specs import LARGEST_SIDE, LONGEST_TIME, MapSpec
from engine.maps import compute_map
from engine.orbits import Orbit, integrate_orbit
from engine.outcomes import Outcomes, classify_orbits
from engine.planes import Plane, Window, default_window, start_states, trace_equipotentials, trace_zero_velocity_curve
from engine.potentials import CASES, Potential
from engine.preparation import prepare_kernels
from engine.previews import PREVIEW_SIDE, PREVIEW_TIME, compute_preview, preview_spec
from engine.regularity_maps import RegularityMap, judge_bounded_orbits
from engine.sections import read_section_points
from engine.separations import LONGEST_SEPARATION, Separation, compute_separation
from engine.twins import Twin, find_twin

__all__ = [
    "CASES",
    "CHAOS_THRESHOLD",
    "LARGEST_SIDE",
    "LONGEST_SEPARATION",
    "LONGEST_TIME",
    "PREVIEW_SIDE",
    "PREVIEW_TIME",
    "Certificate",
    "EscapeMap",
    "EscapeStatistics",
    "Fate",
    "Jobs",
    "LyapunovOrbit",
    "MapSpec",
    "Orbit",
    "OrbitSpec",
    "Outcomes",
    "Plane",
    "Potential",
    "Regularity",
    "RegularityMap",
    "Separation",
    "SeparationSpec",
    "Ticket",
    "Twin",
    "TwinSpec",
    "Window",
    "classify_orbits",
    "compute_map",
    "compute_preview",
    "compute_separation",
    "compute_statistics",
    "default_window",
    "describe_certificate",
    "describe_fate",
    "find_lyapunov_orbits",
    "find_twin",
    "integrate_orbit",
    "judge_bounded_orbits",
    "judge_regularity",
    "prepare_kernels",
    "preview_spec",
    "read_section_points",
    "start_states",
    "trace_equipotentials",
    "trace_zero_velocity_curve",
]
