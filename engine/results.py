"""Classes of the results that functions of the library return, for annotations and `isinstance`."""

from engine.maps.descriptors import DescriptorMap
from engine.maps.origin_fates import OriginFateMap
from engine.maps.regularity import RegularityMap
from engine.maps.trust import TrustMap
from engine.measures.basin_entropy import BasinEntropy
from engine.measures.chaotic_share import ChaoticShare
from engine.measures.decay_laws import DecayLaws, LawFit
from engine.measures.escape_statistics import EscapeStatistics
from engine.measures.exit_matching import ExitMatching
from engine.measures.islands import Islands
from engine.measures.power_law_fit import UncertaintyExponent
from engine.measures.wada import WadaTest
from engine.periodic.stable_manifolds import StableManifolds
from engine.propagation.classification import Outcomes
from engine.sweeps.sweep import Sweep
from engine.systems.review.potential_review import PotentialReview
from engine.trajectories.birkhoff_digits import BirkhoffDigits
from engine.trajectories.flux import EscapeFlux
from engine.trajectories.nearest_divergent_start import DivergentStart
from engine.trajectories.orbit_verdicts import OrbitVerdict
from engine.trajectories.sampled_orbits import SampledOrbits
from engine.trajectories.separation import Separation

__all__ = [
    "BasinEntropy",
    "BirkhoffDigits",
    "ChaoticShare",
    "DecayLaws",
    "DescriptorMap",
    "DivergentStart",
    "EscapeFlux",
    "EscapeStatistics",
    "ExitMatching",
    "Islands",
    "LawFit",
    "OrbitVerdict",
    "OriginFateMap",
    "Outcomes",
    "PotentialReview",
    "RegularityMap",
    "SampledOrbits",
    "Separation",
    "StableManifolds",
    "Sweep",
    "TrustMap",
    "UncertaintyExponent",
    "WadaTest",
]
