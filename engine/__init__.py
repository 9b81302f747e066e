"""Escapes in open Hamiltonian systems with polynomial potentials: orbits, exits, maps. Computes, and knows of no screen."""

from engine.escape_maps import EscapeMap
from engine.fates import CHAOS_THRESHOLD, Fate, Regularity, describe_fate, judge_regularity
from engine.jobs import Jobs, OrbitSpec, Ticket
from engine.lyapunov_orbits import LyapunovOrbit, find_lyapunov_orbits
from engine.map_runs import compute_map
from engine.map_specs import LARGEST_SIDE, LONGEST_TIME, MapSpec
from engine.orbits import Orbit, integrate_orbit
from engine.outcomes import Outcomes, classify_orbits
from engine.planes import Plane, Window, default_window, start_states, trace_equipotentials, trace_zero_velocity_curve
from engine.potentials import CASES, Potential

__all__ = [
    "CASES",
    "CHAOS_THRESHOLD",
    "LARGEST_SIDE",
    "LONGEST_TIME",
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
    "Ticket",
    "Window",
    "classify_orbits",
    "compute_map",
    "default_window",
    "describe_fate",
    "find_lyapunov_orbits",
    "integrate_orbit",
    "judge_regularity",
    "start_states",
    "trace_equipotentials",
    "trace_zero_velocity_curve",
]
