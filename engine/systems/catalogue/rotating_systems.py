"""Entries of the catalogue with rotating frames or bodies."""

from engine.systems.catalogue.entry import CatalogueEntry, EnergyRange
from engine.systems.parameters import ROTATION

# Mass of the Moon, as a share of the mass of Earth and Moon. The clause of the Moon divides its radius by its distance, in km.
_MOON_MASS = 0.0121505856
# Parameter of systems whose unit of time is 1/Ω.
_UNIT_ROTATION = {ROTATION: 1.0}


ROTATING_ENTRIES = (
    CatalogueEntry(
        "Copenhagen",
        "Copenhagen problem",
        "−(1 − m)/√((x + m)² + y²) − m/√((x + m − 1)² + y²); "
        "centre body 1 (−m, 0) 0.001; centre body 2 (1 − m, 0) 0.001; escape 10",
        "The restricted three-body problem of two equal masses m = ½: a light body collides with one of them or escapes beyond "
        "r = 10.",
        "E. Strömgren, Copenhagen Observatory; J. Nagler, Physical Review E 69, 066218 (2004), for collisions and escapes; this "
        "project chose the radii of collision and escape",
        {"m": 0.5} | _UNIT_ROTATION,
        ("m",),
        EnergyRange(-2.6, -1.0, (), -1.6),
        ("x = -0.5 up", "x = 0.5 up", "apsis about (-0.5, 0)", "apsis about (0.5, 0)"),
    ),
    CatalogueEntry(
        "Earth-Moon",
        "Earth–Moon system, at the Moon",
        "−(1 − m)/√((x + 1)² + y²) − m/r − (1 − m)x; centre the Moon (0, 0) 1737.4/384400; exits L2, L1",
        "The restricted three-body problem seen from the Moon: a light body leaves through the neck at L1, towards the Earth at "
        "x = −1, or at L2, or collides with the Moon.",
        "S. C. de Assis & M. O. Terra, Celestial Mechanics and Dynamical Astronomy 120, 105 (2014)",
        {"m": _MOON_MASS} | _UNIT_ROTATION,
        ("m",),
        EnergyRange(-1.14, -1.045, (), -1.095, 4),
        ("x = 0 up", "x = 0 down", "x = 0.1678327510078692 up", "x = -0.1509342885802875 down", "pericentre"),
    ),
    CatalogueEntry(
        "Hill",
        "Hill's problem",
        "−1/r − x² + ½y²; centre the planet (0, 0) 0.001; exits L2, L1",
        "A light body near a planet that goes around a distant star: exits at L1 and L2, and collisions with the planet.",
        "G. W. Hill, American Journal of Mathematics 1, 5 (1878); M. Hénon, Astronomy & Astrophysics 1, 223 (1969)",
        _UNIT_ROTATION,
        (),
        EnergyRange(-3.0, -1.0, (), -2.0),
        ("x = 0 up", "x = 0.6933612743506348 up", "x = -0.6933612743506348 down", "pericentre"),
    ),
    CatalogueEntry(
        "Star cluster",
        "Star cluster in a tide",
        "−1/√(r² + c²) − ½(3 − k²)x² + ½y²; exits L2, L1",
        "A Plummer sphere of radius c on a circular orbit in a galaxy whose epicyclic frequency is k: stars leave at L1 and L2.",
        "A. Ernst, A. Just, R. Spurzem & O. Porth, MNRAS 383, 1619 (2008), for the form of the potential; this project "
        "chose the values",
        {"c": 0.15, "k": 1.4} | _UNIT_ROTATION,
        ("c", "k"),
        EnergyRange(-3.0, -0.9, (), -1.6),
        ("x = 0 up", "pericentre"),
    ),
    CatalogueEntry(
        "Barred galaxy",
        "Barred galaxy",
        "−400/√(r² + 0.25²) − 7000/√(r² + 3.175²) − 20000/√(r² + 20²) "
        "+ 1750/a (log(x − a + √((x − a)² + y² + 1)) − log(x + a + √((x + a)² + y² + 1)))",
        "A nucleus, a disc, a halo and a bar of half length a, which turns at Ω = 4.5: stars leave at both ends of the bar.",
        "C. Jung & E. E. Zotos, MNRAS 457, 2583 (2016)",
        {"a": 10.0, ROTATION: 4.5},
        ("a", ROTATION),
        EnergyRange(-3500.0, -3010.0, (), -3200.0, 1),
        ("x = 0 up", "apocentre"),
    ),
    CatalogueEntry(
        "Logarithmic bar",
        "Rotating logarithmic bar",
        "½ log(x² + y²/q² + c²)",
        "Flat rotation curve, axis ratio q: stars leave over the ends of the long axis.",
        "J. Binney & S. Tremaine, Galactic Dynamics, section 3.3.2; this project chose the values",
        {"q": 0.8, "c": 0.1} | _UNIT_ROTATION,
        ("q", "c", ROTATION),
        EnergyRange(-1.5, -0.35, (), -0.44),
    ),
    CatalogueEntry(
        "Two Yukawa centres",
        "Two Yukawa centres",
        "−exp(−k√((x + 1)² + y²))/√((x + 1)² + y²) − exp(−k√((x − 1)² + y²))/√((x − 1)² + y²); "
        "centre body 1 (−1, 0) 0.001; centre body 2 (1, 0) 0.001; escape 10",
        "Two screened charges at x = ±1, at rest: collision with one of them, or escape beyond r = 10.",
        "two potentials of H. Yukawa, Proceedings of the Physico-Mathematical Society of Japan 17, 48 (1935); this project "
        "chose the values",
        {"k": 0.5},
        ("k", ROTATION),
        EnergyRange(-1.5, 1.0, (), 0.02),
        ("x = -1 up", "x = 1 up"),
    ),
    CatalogueEntry(
        "Four hills",
        "Four hills",
        "x² y² exp(−x² − y²); escape 6 exits 4",
        "Chaotic scattering off four hills of height exp(−2) = 0.135, at rest: escape beyond r = 6 near one of four directions.",
        "S. Bleher, E. Ott & C. Grebogi, Physical Review Letters 63, 919 (1989); this project chose the radius",
        {},
        (ROTATION,),
        EnergyRange(0.005, 0.2, (), 0.05),
    ),
)
"""The entries, in the order of the catalogue."""
