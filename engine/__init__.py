"""Escapes in open Hamiltonian systems with two degrees of freedom and any smooth potential with a well.

These are the public names of the library. All results show themselves in notebooks and have `plot`, `to_pandas`, `to_xarray` and
`to_holoviews`, see `Result`; the classes of results that are not named here are in `results`. Names of other modules are for the
programs of this repository, and may change with any version.

- systems: `Potential`, `System`, `Centre`, `Outcome`, `CASES`, `POTENTIALS`, `parse_formula`, `write_formula`, `review_potential`
- starts: `Plane`, `Slice`, `Coordinate`, `Direction`, `ParameterAxis`, `Window`, `start_states`, `sample_starts`
- orbits: `integrate_orbit`, `classify_orbits`, `find_lyapunov_orbits`, `judge_orbit`, `compute_separation`,
  `find_divergent_start`, `compute_flux`
- maps of escapes: `MapSpec`, `compute_map`, `compute_regularity`, `compute_trust`,
  `compute_origin_fates`, `find_stable_manifolds`, `compute_lagrangian_descriptor`
- measures: `MEASURES`; of basins and statistics `compute_basin_entropy`, `compute_wada_test`, `compute_uncertainty_exponent`,
  `compute_statistics`, `compute_islands`, `compute_chaotic_share`, `compute_exit_matching`, `fit_decay_laws`
- files: `Result.save`, `open_result`
- sweeps over energies or a parameter: `SweepSpec`, `compute_sweep`, `plan_sweep`
"""

from typing import TYPE_CHECKING

from engine.exits.lyapunov_orbits import LyapunovOrbit, find_lyapunov_orbits
from engine.foundations.execution import Execution
from engine.foundations.former_names import find_former_name as find_former_name
from engine.foundations.result import Result
from engine.maps.compute import compute_map
from engine.maps.descriptors import TimeDirection, compute_lagrangian_descriptor
from engine.maps.origin_fates import compute_origin_fates
from engine.maps.regularity import compute_regularity
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.maps.trust import Trust, compute_trust
from engine.maps.uncertain_pairs import compute_uncertainty_exponent
from engine.measures.basin_entropy import compute_basin_entropy
from engine.measures.chaotic_share import compute_chaotic_share
from engine.measures.decay_law_fits import fit_decay_laws
from engine.measures.escape_statistics import compute_statistics
from engine.measures.exit_matching import compute_exit_matching
from engine.measures.islands import compute_islands
from engine.measures.measure import Measure
from engine.measures.wada import compute_wada_test
from engine.periodic.stable_manifolds import find_stable_manifolds
from engine.propagation.classification import classify_orbits
from engine.propagation.evidence import Evidence
from engine.propagation.fates import Fate, Regularity
from engine.slices.axes import Coordinate, Direction, ParameterAxis
from engine.slices.planes import Plane, start_states
from engine.slices.sampling import sample_starts
from engine.slices.slice import Slice
from engine.slices.window import Window
from engine.sweeps.measures import MEASURES
from engine.sweeps.opened_results import open_result
from engine.sweeps.plan import plan_sweep
from engine.sweeps.spec import SweepSpec
from engine.sweeps.sweep import compute_sweep
from engine.systems.formulas.formula_parser import parse_formula
from engine.systems.formulas.formula_tokens import FormulaError
from engine.systems.formulas.formula_writer import write_formula
from engine.systems.known_potentials import CASES, POTENTIALS
from engine.systems.outcomes import Centre, Outcome
from engine.systems.potential import Potential
from engine.systems.review.potential_review import review_potential
from engine.systems.system import System
from engine.trajectories.entrances import sample_entrances, sample_entrances_by_exit
from engine.trajectories.flux import compute_flux
from engine.trajectories.nearest_divergent_start import find_divergent_start
from engine.trajectories.orbit_verdicts import judge_orbit
from engine.trajectories.sampled_orbits import sample_orbits
from engine.trajectories.separation import compute_separation
from engine.trajectories.trajectory import Orbit, integrate_orbit

__all__ = [
    "CASES",
    "MEASURES",
    "POTENTIALS",
    "Centre",
    "Coordinate",
    "Direction",
    "EscapeMap",
    "Evidence",
    "Execution",
    "Fate",
    "FormulaError",
    "LyapunovOrbit",
    "MapSpec",
    "Measure",
    "Orbit",
    "Outcome",
    "ParameterAxis",
    "Plane",
    "Potential",
    "Regularity",
    "Result",
    "Slice",
    "SweepSpec",
    "System",
    "TimeDirection",
    "Trust",
    "Window",
    "classify_orbits",
    "compute_basin_entropy",
    "compute_chaotic_share",
    "compute_exit_matching",
    "compute_flux",
    "compute_islands",
    "compute_lagrangian_descriptor",
    "compute_map",
    "compute_origin_fates",
    "compute_regularity",
    "compute_separation",
    "compute_statistics",
    "compute_sweep",
    "compute_trust",
    "compute_uncertainty_exponent",
    "compute_wada_test",
    "find_divergent_start",
    "find_lyapunov_orbits",
    "find_stable_manifolds",
    "fit_decay_laws",
    "integrate_orbit",
    "judge_orbit",
    "open_result",
    "parse_formula",
    "plan_sweep",
    "review_potential",
    "sample_entrances",
    "sample_entrances_by_exit",
    "sample_orbits",
    "sample_starts",
    "start_states",
    "write_formula",
]

if not TYPE_CHECKING:
    # Type checkers would take any name for one of the module.
    __getattr__ = find_former_name
