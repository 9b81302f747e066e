"""Escapes in open Hamiltonian systems with two degrees of freedom and any smooth potential with a well.

These are the public names of the library. All results are displayed in notebooks and have `plot`, `to_pandas`, `to_xarray` and
`to_holoviews`, see `Result`; the classes of results that are not listed here are in `results`. Names in other modules are for the
programs of this repository, and may change with any version.

- systems: `Potential`, `System`, `Centre`, `Outcome`, `CASES`, `POTENTIALS`, `parse_formula`, `FormulaError`, `write_formula`,
  `review_potential`, `UnknownNameError`
- starts: `Plane`, `Slice`, `Coordinate`, `Direction`, `ParameterAxis`, `Window`, `Section`, `read_section`, `start_states`,
  `sample_starts`, `sample_entrances`, `sample_entrances_by_exit`
- orbits: `integrate_orbit`, `Orbit`, `sample_orbits`, `classify_orbits`, `find_returns`, `find_lyapunov_orbits`,
  `LyapunovOrbit`, `UndefinedExitsError`, `judge_orbit`, `compute_separation`, `find_divergent_start`, `compute_flux`
- maps of escapes: `MapSpec`, `compute_map`, `EscapeMap`, `Fate`, `Evidence`, `compute_returns`, `store_returns`,
  `compute_regularity`, `Regularity`, `compute_trust`, `Trust`, `compute_origin_fates`, `find_stable_manifolds`,
  `compute_lagrangian_descriptor`, `TimeDirection`
- periodic orbits: `find_periodic_orbit`, `find_periodic_orbits`, `PeriodicOrbit`, `Stability`, `NoPeriodicOrbitError`,
  `continue_family`, `OrbitFamily`, `SpecialKind`, `find_symmetric_families`, `read_jpl_table`, `write_jpl_table`
- measures: `MEASURES`, `Measure`; of basins and statistics `compute_basin_entropy`, `compute_wada_test`,
  `compute_uncertainty_exponent`, `compute_statistics`, `compute_islands`, `compute_chaotic_share`, `compute_exit_matching`,
  `fit_decay_laws`
- sweeps over energies and parameters: `SweepSpec`, `EnergyAxis`, `compute_sweep`, `plan_sweep`, `find_where`
- files, execution and reports of errors: `Result`, `open_result`, `Execution`, `show_versions`
"""

import types
import typing

from engine.exits.closed_orbit import Stability as Stability
from engine.exits.lyapunov_orbit import LyapunovOrbit as LyapunovOrbit
from engine.exits.lyapunov_orbits import UndefinedExitsError as UndefinedExitsError
from engine.exits.lyapunov_orbits import find_lyapunov_orbits as find_lyapunov_orbits
from engine.foundations.execution import Execution as Execution
from engine.foundations.names import UnknownNameError as UnknownNameError
from engine.foundations.result import Result as Result
from engine.foundations.versions import show_versions as show_versions
from engine.maps.analyses.descriptors import TimeDirection as TimeDirection
from engine.maps.analyses.descriptors import compute_lagrangian_descriptor as compute_lagrangian_descriptor
from engine.maps.analyses.regularity import compute_regularity as compute_regularity
from engine.maps.analyses.trust import Trust as Trust
from engine.maps.analyses.trust import compute_trust as compute_trust
from engine.maps.compute import compute_map as compute_map
from engine.maps.origin_fates import compute_origin_fates as compute_origin_fates
from engine.maps.result import EscapeMap as EscapeMap
from engine.maps.returns import compute_returns as compute_returns
from engine.maps.spec import MapSpec as MapSpec
from engine.measures.basins.basin_entropy import compute_basin_entropy as compute_basin_entropy
from engine.measures.basins.chaotic_share import compute_chaotic_share as compute_chaotic_share
from engine.measures.basins.decay_law_fits import fit_decay_laws as fit_decay_laws
from engine.measures.basins.escape_statistics import compute_statistics as compute_statistics
from engine.measures.basins.exit_matching import compute_exit_matching as compute_exit_matching
from engine.measures.basins.islands import compute_islands as compute_islands
from engine.measures.basins.wada import compute_wada_test as compute_wada_test
from engine.measures.flux import compute_flux as compute_flux
from engine.measures.measure import Measure as Measure
from engine.measures.table import MEASURES as MEASURES
from engine.measures.uncertain_pairs import compute_uncertainty_exponent as compute_uncertainty_exponent
from engine.opened_results import open_result as open_result
from engine.periodic.families.continuation import continue_family as continue_family
from engine.periodic.families.family import OrbitFamily as OrbitFamily
from engine.periodic.families.special_points import SpecialKind as SpecialKind
from engine.periodic.jpl_table import read_jpl_table as read_jpl_table
from engine.periodic.jpl_table import write_jpl_table as write_jpl_table
from engine.periodic.nearest_orbit import NoPeriodicOrbitError as NoPeriodicOrbitError
from engine.periodic.nearest_orbit import find_periodic_orbit as find_periodic_orbit
from engine.periodic.periodic_orbit import PeriodicOrbit as PeriodicOrbit
from engine.periodic.search import find_periodic_orbits as find_periodic_orbits
from engine.periodic.symmetric.search import find_symmetric_families as find_symmetric_families
from engine.propagation.fates import Evidence as Evidence
from engine.propagation.fates import Fate as Fate
from engine.propagation.fates import Regularity as Regularity
from engine.slices.axes import Coordinate as Coordinate
from engine.slices.axes import Direction as Direction
from engine.slices.axes import ParameterAxis as ParameterAxis
from engine.slices.planes import Plane as Plane
from engine.slices.planes import start_states as start_states
from engine.slices.sampling import sample_starts as sample_starts
from engine.slices.sections.section import Section as Section
from engine.slices.sections.section_text import read_section as read_section
from engine.slices.slice import Slice as Slice
from engine.slices.window import Window as Window
from engine.sweeps.axes import EnergyAxis as EnergyAxis
from engine.sweeps.plan import plan_sweep as plan_sweep
from engine.sweeps.spec import SweepSpec as SweepSpec
from engine.sweeps.stored_returns import store_returns as store_returns
from engine.sweeps.sweep import compute_sweep as compute_sweep
from engine.sweeps.threshold import find_where as find_where
from engine.systems.formulas.formula_tokens import FormulaError as FormulaError
from engine.systems.formulas.formula_writer import write_formula as write_formula
from engine.systems.known_potentials import CASES as CASES
from engine.systems.known_potentials import POTENTIALS as POTENTIALS
from engine.systems.outcomes import Centre as Centre
from engine.systems.outcomes import Outcome as Outcome
from engine.systems.potential import Potential as Potential
from engine.systems.review.potential_review import review_potential as review_potential
from engine.systems.system import System as System
from engine.systems.system import parse_formula as parse_formula
from engine.trajectories.classified_orbits import classify_orbits as classify_orbits
from engine.trajectories.entrances import sample_entrances as sample_entrances
from engine.trajectories.entrances import sample_entrances_by_exit as sample_entrances_by_exit
from engine.trajectories.nearest_divergent_start import find_divergent_start as find_divergent_start
from engine.trajectories.orbit_returns import find_returns as find_returns
from engine.trajectories.orbit_verdicts import judge_orbit as judge_orbit
from engine.trajectories.sampled_orbits import sample_orbits as sample_orbits
from engine.trajectories.separation import compute_separation as compute_separation
from engine.trajectories.stable_manifolds import find_stable_manifolds as find_stable_manifolds
from engine.trajectories.trajectory import Orbit as Orbit
from engine.trajectories.trajectory import integrate_orbit as integrate_orbit

if not typing.TYPE_CHECKING:
    __all__ = sorted(name for name, value in vars().items() if name[0] != "_" and not isinstance(value, types.ModuleType))
