"""Escapes in open Hamiltonian systems with polynomial potentials: orbits, exits, maps. Computes, and knows of no screen."""

from engine.certificates import Certificate, describe_certificate
from engine.escape_maps import EscapeMap
from engine.fates import CHAOS_THRESHOLD, Fate, Regularity, describe_fate, judge_regularity
from engine.jobs import Jobs, OrbitSpec, Ticket
from engine.lyapunov_orbits import LyapunovOrbit, find_lyapunov_orbits
from engine.map_specs import LARGEST_SIDE, LONGEST_TIME, MapSpec
from engine.maps import compute_map
from engine.orbits import Orbit, integrate_orbit
from engine.outcomes import Outcomes, classify_orbits
from engine.planes import Plane, Window, default_window, start_states, trace_equipotentials, trace_zero_velocity_curve
from engine.potentials import CASES, Potential
from engine.preparation import prepare_kernels
from engine.regularity_maps import RegularityMap, judge_bounded_orbits

__all__ = [
    "CASES",
    "CHAOS_THRESHOLD",
    "LARGEST_SIDE",
    "LONGEST_TIME",
    "Certificate",
    "EscapeMap",
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
    "Ticket",
    "Window",
    "classify_orbits",
    "compute_map",
    "default_window",
    "describe_certificate",
    "describe_fate",
    "find_lyapunov_orbits",
    "integrate_orbit",
    "judge_bounded_orbits",
    "judge_regularity",
    "prepare_kernels",
    "start_states",
    "trace_equipotentials",
    "trace_zero_velocity_curve",
]
