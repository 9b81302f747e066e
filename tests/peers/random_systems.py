"""Make random wells: polynomials, wells with functions, and wells with functions in rotating frames, with bodies or escape radii.

A well with functions is a harmonic, Plummer, logarithmic or cosine well plus two terms of degree 3 or 4 times a random function.
"""

from __future__ import annotations

import numpy as np

from engine import Potential, parse_formula, review_potential
from engine.systems.outcomes import Centre
from tests.contracts.scaling import Scaling

HIGHEST_DEGREE = 10
# Energies of wells with functions, as multiples of their depth.
FACTORS = (1.02, 1.5)
# Largest rotation, as a share of the slowest frequency of the well. With a rotation above this frequency, Φ has no well. One in
# `AT_REST` systems does not rotate.
FASTEST, AT_REST = 0.9, 8

_WELLS = (
    "½(a x² + b y²)",
    "−1/√(a x² + b y² + c²)",
    "½ log(a x² + b y² + c²)",
    "−cos(a x) − b cos(y)",
    "(a x² + b y² + c²)^0.7",
)
_POWERS = ("x³", "x²y", "x y²", "y³", "x²y²", "x⁴", "y⁴", "x³y")
_FUNCTIONS = (
    "",
    "exp(−c (x² + y²))",
    "exp(−y²)",
    "cos(a x + b y)",
    "/(1 + b y² + c x²)",
    "(1 + r²)^(−a)",
    "log(2 + r²)",
    "sin(1 + x)",
    "√(1 + b (x + y)²)",
)


def random_well(seed: int, highest_degree: int = 8) -> Potential:
    """Return a well with up to ten random terms of degree 3 and higher."""
    random = np.random.default_rng([19, seed])
    degree = int(random.integers(3, highest_degree + 1))
    a, b = random.uniform(0.2, 1.2, 2)
    c = random.uniform(-1.8, 1.8) * np.sqrt(a * b) if random.random() < 0.5 else 0.0
    powers = [(i, n - i) for n in range(3, degree + 1) for i in range(n + 1)]
    chosen = random.choice(len(powers), int(random.integers(1, min(len(powers), 10) + 1)), replace=False)
    terms = {(2, 0): a, (0, 2): b, (1, 1): c} | {powers[k]: 0.5 * random.normal() for k in chosen}
    return Potential(f"random {seed}", tuple((*power, round(value, 4)) for power, value in terms.items() if round(value, 4)))


def random_scaling(seed: int) -> Scaling:
    """Return random units between the smallest and the largest that are supported. They are no powers of 2."""
    length, energy = 10.0 ** np.random.default_rng([20, seed]).uniform(-6.0, 6.0, 2)
    return Scaling(float(length), float(energy))


def random_formula(seed: int) -> tuple[str, dict[str, float]]:
    """Return a formula and the values of its letters."""
    random = np.random.default_rng([33, seed])
    terms = [
        f"{'−+'[int(random.integers(2))]} {letter} {_POWERS[random.integers(len(_POWERS))]} "
        f"{_FUNCTIONS[random.integers(len(_FUNCTIONS))]}"
        for letter in "kq"
    ]
    text = " ".join([_WELLS[seed % len(_WELLS)], *terms])
    values = dict(zip("abckq", random.uniform(0.4, 1.4, 5).round(3).tolist(), strict=True))
    return text, {name: value for name, value in values.items() if name in text.replace("cos", "").replace("exp", "")}


def random_system(seed: int) -> tuple[Potential, float]:
    """Return a system, and an energy above its lowest exit."""
    random = np.random.default_rng([57, seed])
    text, values = random_formula(seed)
    well = parse_formula(text, parameters=values)
    slowest = np.sqrt(np.linalg.eigvalsh(well.hessian_matrix(0.0, 0.0))[0])
    if seed % AT_REST:
        well = well.in_rotating_frame(float(random.uniform(-FASTEST, FASTEST) * slowest))
    review = review_potential(well)
    if review.refusal is not None or not review.channels:
        raise ValueError(review.describe())
    energy = well.well.energy_at(float(random.uniform(*FACTORS)))
    energy = min(energy, well.escape_energy + 0.5 * (review.highest_energy - well.escape_energy))
    size = well.units.length
    x, y = (size * random.uniform(-0.5, 0.5, 2)).tolist()
    centre = Centre(x, y, float(size * 10.0 ** random.uniform(-3.0, -1.0)))
    radius = float(size * random.uniform(1.0, 4.0))
    body = f"{text} − {0.1 * size}/√((x − {x:.17f})² + (y − {y:.17f})²)".replace("− -", "+ ")
    builders = (
        lambda: well,
        lambda: well.with_outcomes([centre]),
        lambda: well.with_outcomes(escape_radius=radius),
        lambda: parse_formula(body, parameters=values).in_rotating_frame(well.rotation).with_outcomes([centre], radius),
    )
    # `well_comparison` compares the exits of wells at rest, which are not straight lines.
    return builders[int(random.integers(0 if well.rotation else 2, len(builders)))](), energy
