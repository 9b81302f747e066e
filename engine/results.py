"""Classes of the results that the functions of the library return, for annotations and `isinstance`."""

import typing

from engine.exits.monodromy import Monodromy as Monodromy
from engine.foundations.drawing import Drawing as Drawing
from engine.maps.analyses.descriptors import DescriptorMap as DescriptorMap
from engine.maps.analyses.regularity import RegularityMap as RegularityMap
from engine.maps.analyses.trust import TrustMap as TrustMap
from engine.maps.origin_fates import OriginFateMap as OriginFateMap
from engine.maps.returns import Returns as Returns
from engine.measures.basins.basin_entropy import BasinEntropy as BasinEntropy
from engine.measures.basins.chaotic_share import ChaoticShare as ChaoticShare
from engine.measures.basins.decay_laws import DecayLaws as DecayLaws
from engine.measures.basins.decay_laws import LawFit as LawFit
from engine.measures.basins.escape_statistics import EscapeStatistics as EscapeStatistics
from engine.measures.basins.exit_matching import ExitMatching as ExitMatching
from engine.measures.basins.islands import Islands as Islands
from engine.measures.basins.power_law_fit import UncertaintyExponent as UncertaintyExponent
from engine.measures.basins.wada import WadaTest as WadaTest
from engine.measures.flux import EscapeFlux as EscapeFlux
from engine.periodic.families.family import SpecialPoint as SpecialPoint
from engine.periodic.periodic_orbits import PeriodicOrbits as PeriodicOrbits
from engine.periodic.symmetric.symmetric_families import SymmetricFamilies as SymmetricFamilies
from engine.propagation.classification import Outcomes as Outcomes
from engine.sweeps.plan import SweepPlan as SweepPlan
from engine.sweeps.sweep import Sweep as Sweep
from engine.sweeps.threshold import Threshold as Threshold
from engine.systems.review.potential_review import PotentialReview as PotentialReview
from engine.trajectories.birkhoff_digits import BirkhoffDigits as BirkhoffDigits
from engine.trajectories.chaos_indicators import Verdict as Verdict
from engine.trajectories.nearest_divergent_start import DivergentStart as DivergentStart
from engine.trajectories.orbit_returns import OrbitReturns as OrbitReturns
from engine.trajectories.orbit_verdicts import OrbitVerdict as OrbitVerdict
from engine.trajectories.sampled_orbits import SampledOrbits as SampledOrbits
from engine.trajectories.separation import Separation as Separation
from engine.trajectories.stable_manifolds import StableManifolds as StableManifolds

if not typing.TYPE_CHECKING:
    __all__ = sorted(name for name in vars() if name[0].isupper())
