"""Wrong calls are answered with one sentence that names the parameter and says what is legal."""

from __future__ import annotations

import functools
import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

import engine
from engine import (
    CASES,
    POTENTIALS,
    Coordinate,
    Fate,
    MapSpec,
    ParameterAxis,
    Plane,
    SweepSpec,
    System,
    classify_orbits,
    compute_lagrangian_descriptor,
    compute_map,
    compute_statistics,
    compute_sweep,
    find_periodic_orbits,
    integrate_orbit,
    judge_orbit,
    open_result,
    parse_formula,
    sample_orbits,
    sample_starts,
    start_states,
)
from engine.slices.slice_text import read_slice
from engine.systems.outcomes import Centre

LONGEST = 400
# A sweep along two axes.
PLATE = SweepSpec(
    CASES["I"], Plane.X_PX, ((0.2, 0.3), (0.8, 1.0)), (6, 6), t_max=10.0, measures=("shares",),
    along=("h", ParameterAxis("epsilon", 0.8, 1.2, CASES["I"])),
)  # fmt: skip


@functools.cache
def names() -> dict[str, Any]:
    """Return the names that the calls use."""
    case, state = CASES["III"], (0.1, 0.0, 0.05, 0.6)
    spec = MapSpec(case, Plane.X_PX, 0.45, (20, 20), t_max=50.0)
    whole = compute_map(spec)
    statistics = compute_statistics(whole)
    return {name: getattr(engine, name) for name in engine.__all__} | {
        "III": case, "S": state, "C": Coordinate, "spec": spec, "m": whole, "orbit": integrate_orbit(case, state, 20.0),
        "unfinished": replace(whole, complete=False),
        "many": classify_orbits(case, 0.45, sample_starts(case, 0.45, 5, rng=0), 1.0),
        "stats": statistics, "timeless": replace(statistics, t_max=float("inf")),
        "sw": SweepSpec(case, Plane.X_PX, (0.3, 0.4), (10, 10), t_max=20.0),
        "other": compute_sweep(SweepSpec(case, Plane.X_PX, (0.4,), (12, 12), t_max=30.0)),
        "well": parse_formula("x² + y²"), "Centre": Centre, "np": np, "threading": threading, "axes": Figure().subplots(),
        "EPSILON": ParameterAxis("epsilon", 0.5, 2.0, System("I")), "read_slice": read_slice, "replace": replace,
        "Figure": Figure, "plate": PLATE, "pair": compute_sweep(PLATE),
        "other_shares": compute_sweep(replace(PLATE, along="h", values=(0.2, 0.3))),
        "many_values": replace(PLATE, along="h", values=np.linspace(0.2, 0.4, 50)),
        "found": find_periodic_orbits(MapSpec(case, Plane.X_PX, 0.3, (8, 8), t_max=50.0)),
    }  # fmt: skip


# Each call with the beginning of the sentence. … stands for the value.
WRONG_CALLS = (
    ('MEASURES["basin entropy"]', "measure 'basin entropy': did you mean 'basin_entropy'? The names are shares, escape_times,"),
    ('CASES["IV"]', "case 'IV': did you mean 'I'? The names are I, II, III"),
    ('POTENTIALS["Henon-Heiles"]', "potential 'Henon-Heiles': did you mean 'HH'? The names are I, II, III, C3, C4, C5, C6, C7,"),
    ('POTENTIALS["barbanis"]', "potential 'barbanis': did you mean 'Barbanis'? The names are I, II, III, C3, C4, C5, C6, C7, C8"),
    ('MapSpec("III", Plane.X_PX, 0.45)', "potential='III': must be a Potential"),
    (
        'MapSpec(III, "x-px", 0.45)',
        "plane='x-px': must be a Slice, one of x_y, x_px, x_h, y_py, tangential, or two",
    ),
    ('MapSpec(III, Plane.X_PX, "0.45")', "energy='0.45': must be one finite number on (x, px), at most 1e+09 in magnitude"),
    ("MapSpec(III, Plane.X_H, 0.45)", "energy=0.45: on (x, h) must be a pair (low, high) of finite numbers with low < high"),
    ("MapSpec(III, Plane.X_PX, 0.45, 100)", "resolution=100: must be (columns, rows), each from 1 to 4096"),
    ("MapSpec(III, Plane.X_PX, 0.45, window=(1, -1, -1, 1))", "window x range 1.0 … -1.0: the lower edge must be below the uppe"),
    ("MapSpec(III, Plane.X_PX, 0.45, window=(1, 2))", "window=(1, 2): must be (x_low, x_high, ordinate_low, ordinate_high)"),
    ("MapSpec(III, Plane.X_PX, 0.45, t_max=0)", "t_max=0: must be above 0 and at most 1e+08"),
    ('MapSpec(III, Plane.X_PX, 0.45, use_evidence="no")', "use_evidence='no': must be True or False"),
    ("MapSpec(III, Plane.X_PX, (0.1, 0.2))", "energy=(0.1, 0.2): must be one finite number on (x, px), at most 1e+09 in"),
    ("MapSpec(III, Plane.X_PX, 0.45, (10, 4097))", "resolution=(10, 4097): must be (columns, rows), each from 1 to 4096"),
    ("MapSpec(III, Plane.X_PX, 0.45, t_max=2e8)", "t_max=200000000.0: must be above 0 and at most 1e+08"),
    ("MapSpec(III, Plane.X_PX, 0.45, window=(None, 1.0, 0.0, 1.0))", "window x edge=None: must be a finite number,"),
    (
        "MapSpec(III, Plane.X_PX, 0.45, window=(0.3, 0.3 + 1e-14, 0.2, 0.2 + 1e-14)).find_window()",
        "window=…: double precision ends here;",
    ),
    ('MapSpec(CASES["II"], Slice(C.X, EPSILON), 0.2)', "plane=(x, ε): its parameter belongs to another system; must be of"),
    ("compute_map(III)", "spec=…: must be a MapSpec"),
    ("compute_map(spec, executor=4)", "executor=4: must be a concurrent.futures.Executor or None"),
    ("compute_map(spec, cancel=True)", "cancel=True: must be a threading.Event or None"),
    ("compute_map(spec, execution=4)", "execution=4: must be an Execution"),
    ("compute_map(spec, on_frame=3)", "on_frame=3: must be a function or None"),
    ("compute_map(spec, resume=spec)", "resume=…: must be an EscapeMap or None"),
    (
        "compute_map(MapSpec(III, Plane.X_PX, 0.45, (20, 21), t_max=50.0), resume=m)",
        "resume: a map with another resolution;",
    ),
    ("compute_map(MapSpec(III, Plane.X_PX, 0.46, (20, 20), t_max=50.0), resume=m)", "resume: a map with another energy; must"),
    ("compute_map(MapSpec(III, Plane.X_PX, 0.45, (20, 20), t_max=49.0), resume=m)", "resume: a map with another t_max; must"),
    ("compute_regularity(spec)", "escape_map=…: must be an EscapeMap"),
    ("compute_statistics(spec)", "frame=…: must be an EscapeMap"),
    ("compute_basin_entropy(spec)", "labels of shape () and type object: must be a map, or integers, (rows, columns)"),
    ("compute_basin_entropy(np.zeros((1, 1), int))", "labels of shape (1, 1): must have at least two rows and two columns"),
    ("compute_basin_entropy(m, box=1)", "box=1: must be an integer from 2 to 20"),
    ("compute_regularity(unfinished)", "escape_map: the map is not complete, its progress is "),
    ("compute_trust(unfinished)", "escape_map: the map is not complete, its progress is "),
    (
        "compute_basin_entropy(np.zeros((9, 9), int), np.ones((9, 9), int))",
        "valid of shape (9, 9) and type int64: must be bool, sha",
    ),
    ("compute_basin_entropy(np.zeros((9, 6), int), box=7)", "box=7: must be an integer from 2 to 6"),
    (
        "compute_wada_test(np.ones((9, 9), int), np.ones(9))",
        "valid of shape (9,) and type float64: must be bool, shaped like the",
    ),
    ("compute_chaotic_share(III)", "character=…: must be a RegularityMap, or an array of codes of Regularity"),
    ("compute_islands(many)", "starts: must be a map"),
    ("compute_statistics(many, (-1.0, 1.0, -1.0, 1.0))", "window=…: must be None for orbits that are no map"),
    ("compute_statistics(orbit.to_xarray())", "frame=…: must be an EscapeMap, or a dataset of one"),
    ("compute_lagrangian_descriptor(m, power=0.0)", "power=0.0: must be above 0 and at most 1"),
    ("compute_lagrangian_descriptor(m, power=1.5)", "power=1.5: must be above 0 and at most 1"),
    ("compute_lagrangian_descriptor(m, duration=0.0)", "duration=0.0: must be above 0 and at most 1e+08"),
    ('compute_lagrangian_descriptor(m, direction="up")', "direction='up': must be one of forward, backward, both"),
    ("compute_uncertainty_exponent(spec, pairs=9)", "pairs=9: must be an integer from 10 to 100000"),
    ("compute_uncertainty_exponent(spec, separations=4)", "separations=4: must be an integer from 5 to 100"),
    (
        "compute_uncertainty_exponent(spec, rng=-1)",
        "rng=-1: must be an integer from 0 to 9223372036854775807, a numpy.random.Generator or None",
    ),
    (
        "compute_uncertainty_exponent(MapSpec(III, Plane.X_PX, 0.45, (10, 10), (0.1, 0.1 + 1e-11, 0.1, 0.1 + 1e-11)))",
        "window=…: pixels of 1e-12 units of the well are too small for double precision; must be 1e-11 or more",
    ),
    ("find_stable_manifolds(III, 0.45, images=7)", "images=7: must be an integer from 1 to 6"),
    ("fit_decay_laws(timeless)", "t_max=inf: must be above 0 and at most"),
    ("fit_decay_laws(stats, window=(0.0, 5.0))", "window=(0.0, 5.0): must be (t_low, t_high) with 0 < t_low < t_high ≤ t_max=50"),
    (
        "integrate_orbit(III, (0.1, 0.0))",
        "state=(0.1, 0.0): must be four finite numbers x, y, px, py, at most 1e+09 in magnitude",
    ),
    ("classify_orbits(III, 0.45, S)", "states of shape (4,): must be (n, 4) with columns x, y, px, py"),
    ("classify_orbits(III, 0.45, [S])", "states: row 0 has energy 0.18625; must be energy=0.45 to within 1e-09"),
    ("judge_orbit(m)", "orbit=…: must be an Orbit"),
    ("judge_orbit(orbit, 3)", "digits=3: must be a BirkhoffDigits or None"),
    ('compute_separation(III, S, (0.0, 0.0, float("nan"), 1.0), 10.0)', "second=(0.0, 0.0, nan, 1.0): must be four finite"),
    ('find_divergent_start(III, Plane.X_PX, 0.45, "a", 0.0)', "x='a': must be a finite number, at most 1e+09 in magnitude"),
    ('find_divergent_start(CASES["I"], Plane.X_PX, 0.2, 0.1, 0.9)', "x=0.1, px=0.9: forbidden on (x, px) at h=0.2; must have"),
    ("find_divergent_start(III, Plane.X_Y, 0.3, 1.2, 1.2)", "x=1.2, y=1.2: outside on (x, y) at h=0.3; must have V ≤ h and"),
    ('find_divergent_start(CASES["II"], Plane.X_H, (0.2, 0.4), 0.1, -0.1)', "x=0.1, h=-0.1: forbidden on (x, h) at h=-0.1;"),
    ("find_divergent_start(III, Plane.X_PX, 0.45, 0.1, 0.1, furthest=0.0)", "furthest=0.0: must be a finite number above 1e-13"),
    (
        'MapSpec(POTENTIALS["HH"], Slice(C.X, C.Y, fixed=((C.PX, 100.0),)), 0.1).find_window()',
        "px=100: no start on (x, y), px = 100 has a real py at energy=0.1; must be at most 0.447",
    ),
    (
        "MapSpec(III, Slice(C.X, C.H, fixed=((C.Y, 0.5), (C.PY, -2.0))), (0.1, 0.3)).find_window()",
        "py=-2: no start on (x, h), py = −2, y = 0.5, px > 0 has a real px at energy=0.3; must be at most 0.5916 in magnitude",
    ),
    (
        "MapSpec(well, Plane.X_PX, -1.0).find_window()",
        "energy=-1.0: the interior is empty on (x, px); must be at least about 1e-5 abov",
    ),
    ("start_states(III, Plane.X_PX, 0.45, np.zeros(2), np.zeros(3))", "ordinate of shape (3,): must be shaped like x, (2,)"),
    (
        'ParameterAxis("b", 0.0, 1.0, III)',
        "parameter 'b': must be a parameter of the system: omega_1, omega_2,",
    ),
    (
        'ParameterAxis("b", 0.0, 1.0, well.with_outcomes(escape_radius=5.0))',
        "system=x² + y²: the parameters of this potential are not known; must be a System",
    ),
    ("parse_formula(3)", "text=3: must be text"),
    ('parse_formula("")', "formula, character 1: the formula ends where a number, x, y, r or a bracket is expected"),
    ('parse_formula("tanh(x)")', "formula, character 1: 'tanh' is not understood; write 1 − 2/(exp(2u) + 1) for tanh(u)"),
    ('parse_formula("a x² + y²", parameters=3)', "parameters=3: must be a mapping or None"),
    ('Potential("p", "abc")', "terms='abc': must be ((i, j, c), …)"),
    ("III.with_parameters(omega_1=0.0)", "omega_1=0.0: must be from 0.1 to 10"),
    ("III.with_parameters(omega_2=11.0)", "omega_2=11.0: must be from 0.1 to 10"),
    ('System("I", parameters=3)', "parameters=3: must be a mapping"),
    ("Slice(C.X, C.X)", "slice of x, x, py: each of x, y, px, py,"),
    ('Slice("q", "y")', "abscissa='q': must be one of x, y, px, py, theta, beta, v, h, a Direction or a ParameterAxis"),
    ('Slice("x", "y", fixed={"q": 1.0})', "fixed='q': must be one of x, y, px, py, theta, beta, v, h"),
    (
        'Slice("x", "y", fixed=(("px", 1.0), ("px", 2.0)))',
        "slice of x, y, px, px, py: each of x, y, px, py,",
    ),
    ('MapSpec(III, "x,q", 0.45)', "ordinate='q': must be one of x, y, px, py, theta, beta, v, h, a Direction"),
    ("Slice(C.X, C.SPEED)", "slice of x, v, py: must have no axis and no fixed value of v, which only the energy decides"),
    ("Slice(C.X, C.PX, fixed=3)", "fixed=3: must be a mapping such as {'y': 0.1}, or pairs"),
    ("Slice(C.X, C.THETA, C.PX)", "slice of x, theta, px: px, which the energy decides, must not be set by an axis or an angle"),
    ("Slice(C.X, C.THETA, fixed=((C.PX, 0.1),))", "slice of x, theta, px, v: with an angle the energy decides the speed; px,"),
    ('Slice(C.X, Direction("u", x=2.0))', "slice of x, u, py: the directions of the axes must not be parallel"),
    ("Slice(C.X, C.THETA, sign=-1)", "sign=-1: must be 1"),
    ("Slice(C.X, C.Y, C.Y)", "solved=y: must be px, py or v"),
    ("Slice(C.X, C.Y, sign=2)", "sign=2: must be 1 or -1"),
    ('Slice(C.X, C.Y, fixed=((C.PX, float("inf")),))', "fixed px=inf: must be a finite number, at most 1e+09 in magnitude"),
    ("Slice(EPSILON, EPSILON)", "slice of epsilon, epsilon, py: the axes must be different ones, at most one of them a"),
    ("Direction(3)", "key=3: must be text"),
    ('Direction("x", x=1.0)', "direction 'x': its name must be an identifier that is not a coordinate"),
    ('Direction("u")', "direction u: one of x, y, px, py must not be 0"),
    ('ParameterAxis("epsilon", 2, 1, System("I"))', "parameter epsilon from 2 to 1: the lower end must be below the upper end"),
    ('ParameterAxis("epsilon", -1.0, 0.5, System("I"))', "parameter epsilon from -1 to 0.5: must be between 0.01 and 100"),
    ('ParameterAxis("epsilon", 1, 2, 3)', "system=3: must be a System"),
    ("SweepSpec(III, Plane.X_PX, 0.3)", "values=0.3: must be a sequence of finite numbers"),
    ("SweepSpec(III, Plane.X_PX, [])", "values=[]: must be 1 to 10000 different numbers"),
    ("SweepSpec(III, Plane.X_H, (0.3,))", "plane=(x, h): must have no axis h, which already contains all energies"),
    ("SweepSpec(III, Plane.X_PX, (0.3,), measures=3)", "measures=3: must be one or more of shares, escape_times, islands, "),
    ('SweepSpec(III, Plane.X_PX, (0.3,), measures="shares", refine=2.5)', "refine=2.5: must be an integer from 0 to 1000"),
    (
        'SweepSpec(III, Plane.X_PX, (0.3,), along="epsilon", energy=0.2)',
        "along='epsilon': must be one of h, jacobi, a ParameterAxis, or a pair of these",
    ),
    ("SweepSpec(III, Plane.X_PX, range(10_001))", "values=range(0, 10001): must be 1 to 10000 different numbers"),
    (
        'SweepSpec(III, Plane.X_PX, (0.3,), measures=("shares", "colour"))',
        "measures=('shares', 'colour'): must be one or more of",
    ),
    ('SweepSpec(III, Plane.X_PX, (0.3,), measures="islands", refine=2)', "refine=2: must be 0 without the measure 'shares'"),
    (
        "SweepSpec(III, Plane.X_PX, (0.3,), energy=0.2)",
        "energy=0.2: must be given along parameters alone, and None along the energy",
    ),
    ("SweepSpec(III, Plane.X_PX, (0.8,), along=EPSILON, energy=0.2)", "plane=(x, ε): its parameter belongs to another system"),
    (
        'SweepSpec(CASES["I"], Slice(C.X, EPSILON), (0.8,), along=EPSILON, energy=0.2)',
        "plane: is on (x, ε); must be on a slice of",
    ),
    (
        'SweepSpec(CASES["I"], Plane.X_PX, (0.8,), along=EPSILON, energy=0.2)',
        "window=None: must be given for maps along a parameter",
    ),
    ("compute_sweep(spec)", "spec=…: must be a SweepSpec"),
    ("compute_sweep(sw, 3)", "store=3: must be text or a path or None"),
    ('compute_sweep(sw, tmp / "no" / "such" / "folder")', "store=…/no/such/folder: the folder …/no/such does not exist; make"),
    ("compute_sweep(sw, earlier=sw)", "earlier=…: must be a Sweep or None"),
    ("compute_sweep(sw, earlier=other)", "earlier: holds another request, with resolution=(12, 12); must have resolution="),
    ("compute_sweep(sw, on_frame=3)", "on_frame=3: must be a function or None"),
    ("compute_sweep(sw, measure=3)", "measure=3: must be a function or None"),
    ("compute_sweep(sw, execution=3)", "execution=3: must be an Execution"),
    ("plan_sweep(sw, cores=0)", "cores=0: must be an integer from 1 to 1000000"),
    ("sample_orbits(III, [S], (0.0, 1.0), execution=4)", "execution=4: must be an Execution"),
    ("sample_orbits(III, S, (0.0, 1.0))", "states of shape (4,): must be (n, 4) with columns x, y, px, py"),
    ("sample_orbits(III, [S], 10.0)", "times of shape (): must be (m,) or (1, m)"),
    ("sample_orbits(III, [S], (0.0, 1e9))", "times: the last one=1000000000.0: must be above 0 and at most 1e+07"),
    ("sample_orbits(III, [S], (1.0, 0.5))", "times"),
    ("open_result(3)", "path=3: must be text or a path"),
    ("open_result(tmp)", "path=…: is a folder without zarr.json; must be a NetCDF file or a Zarr store of format 3"),
    ("compute_flux(III, -1.0)", "energy=-1.0: must be above the bottom of the well, 0"),
    ('compute_flux(III, float("nan"))', "energy=nan: must be a finite number, at most 1e+09 in magnitude"),
    ("Execution(executor=4)", "executor=4: must be a concurrent.futures.Executor or None"),
    ("Execution(cancel=3)", "cancel=3: must be a threading.Event or None"),
    ("Execution(on_progress=3)", "on_progress=3: must be a function of the share done, or None"),
    ('m.plot(axes, color="red")', "color: no such option; the picture of EscapeMap has palette, legend, colorbar, picture"),
    ('m.plot(axes, picture="nice")', "picture='nice': must be one of curves, basins, times, crossings, characters, origins"),
    ("m.plot(ax=3)", "ax=3: must be Matplotlib axes or None"),
    ('III.in_rotating_frame(float("nan"))', "rotation=nan: must be a finite number, at most 1e+09 in magnitude"),
    ("III.in_rotating_frame(0.1).in_rotating_frame(0.1)", "potential=III: must be one of a frame that does not rotate"),
    ('System("Hill", parameters={"rotation": 2.0})', "parameters: 'rotation' is not a parameter of Hill; it has none"),
    ('System("HH", parameters={"omega": 1})', "parameters: 'omega' is not a parameter of HH; it has omega_1, omega_2, epsilon,"),
    ('System("typed", "½r² − a x y²", {"b": 2.0}).potential', "parameters: 'b' is not a letter of the formula; its letters"),
    ("III.with_outcomes(3)", "centres=3: must be a sequence"),
    ('Potential("p", ((2, 0, 1.0), (2, 0, 2.0)))', "terms=((2, 0, 1.0), (2, 0, 2.0)): each pair of exponents must occur only"),
    ('Potential("p", ((-1, 0, 1.0),))', "terms: exponent of x=-1: must be an integer from 0 to 12"),
    ('Potential("p", ((1, 0, float("nan")),))', "terms: coefficient=nan: must be a finite number, at most 1e+90 in magnitude"),
    ("III.with_outcomes([(0, 0, 1)])", "centres=(0, 0, 1): must be a Centre"),
    ("III.with_outcomes(escape_radius=0)", "escape_radius=0.0: must be from 1e-06 to 1e+06"),
    ('III.with_outcomes(escape_radius=float("nan"))', "escape_radius=nan: must be from 1e-06 to 1e+06"),
    ('parse_formula("−1/r; centre (0, 0) 0")', "formula, character 20: centre radius=0.0: must be from 1e-06 to 1e+06"),
    ('parse_formula("−1/r; centre (1e10, 0) 1")', "formula, character 23: centre x=10000000000.0: must be a finite number"),
    ('parse_formula("−1/r; centre (x, 0) 1")', "formula, character 15: a place, a radius or a mass must be a number, without"),
    ("POTENTIALS['HH'].jacobi_energy(float('nan'))", "potential=HH: its frame must rotate"),
    ("POTENTIALS['Hill'].jacobi_energy(float('nan'))", "constant=nan: must be"),
    ("POTENTIALS['Hill'].jacobi_constant([1.0, np.inf])", "energy="),
    ("POTENTIALS['Hill'].jacobi_energy('3.17')", "constant='3.17': must be an array of real numbers with rows of equal length"),
    ("sample_orbits(III, [[0, 0, 0.1, 0.2j]], (0.0, 1.0))", "states=[[0, 0, 0.1, 0.2j]]: must be an array of real numbers with"),
    ("compute_wada_test(m, valid=[])", "valid=[]: must be None for a map, of which the interior pixels count"),
    ("Centre(0.0, 0.0, True)", "centre radius=True: must be from 1e-06 to 1e+06"),
    ("Potential('', ((2, 0, 0.5),), mass=0.0)", "mass=0.0: must be from 1e-06 to 1e+06"),
    (
        'integrate_orbit(parse_formula("−1/r; escape 9"), S)',
        "potential=−(x² + y²)^(−1/2): must be defined everywhere within the ",
    ),
    ("integrate_orbit(III, S, 1e9)", "t_max=1000000000.0: must be above 0 and at most 1e+07"),
    (
        'find_stable_manifolds(System("Copenhagen").potential, -1.6)',
        "potential=Copenhagen: its orbits escape at a circle; stable manifolds belong to exits over saddles",
    ),
    (
        'classify_orbits(System("Hill").potential, -2.0, [(0.0, 0.0, 0.0, 1.0)])',
        "states: row 0 has energy -inf; must be energy=-",
    ),
    ('classify_orbits(III, 0.18625, [S, (float("nan"), 0, 0, 0)])', "states: row 1 has a number that is not finite or larger"),
    ("classify_orbits(III, 0.18625, [S, (0, 0, 0, 0.1)])", "states: row 1 has energy 0.005…; must be energy=0.18625 to"),
    ("classify_orbits(III, 0.18625 + 2e-9, [S])", "states: row 0 has energy 0.18625; must be energy=0.186250002 to within"),
    ('m.fractions(count_outside="no")', "count_outside='no': must be True or False"),
    ('sample_entrances(CASES["I"], 0.1, 10)', "energy=0.1: all exits are closed; must be above the escape energy 0.125"),
    ('find_lyapunov_orbits(CASES["I"], 1000.0)', "energy=1000.0: no Lyapunov orbit was found across channel 1; choose another"),
    ("sample_starts(III, 0.45, 0)", "count=0: must be an integer from 1 to 10000000"),
    (
        "sample_starts(III, 0.45, 10, rng=-1)",
        "rng=-1: must be an integer from 0 to 9223372036854775807, a numpy.random.Generator or None",
    ),
    ("sample_starts(III, 0.45, 10, plane=Plane.X_H)", "plane=(x, h): must have no axis h, as all starts have one energy"),
    ('sample_starts(CASES["I"], 0.2, 10, plane=Slice(C.X, EPSILON))', "plane: is on (x, ε); must be on a slice of one"),
    ("sample_starts(III, 0.45, 10, plane=Plane.X_Y, window=(5.0, 6.0, 5.0, 6.0))", "window=…: nothing of it is inside at"),
    ('sample_starts(III, float("nan"), 10)', "energy=nan: must be a finite number, at most 1e+09 in magnitude"),
    ('III.save(tmp / "result.csv")', "path=…: must end in .nc"),
    ("III.jacobi_constant(0.2)", "potential=III: its frame must rotate"),
    (
        'parse_formula("x + y²; well (0, 0)")',
        "formula, character 9: potential=x + y²: V must have a minimum to which its axes can be moved",
    ),
    ('SweepSpec("III", Plane.X_PX, (3.0,), along="jacobi")', "potential='III': must be a Potential"),
    ('SweepSpec(III, Plane.X_PX, ("0.3", "0.4"))', "values=('0.3', '0.4'): must be a sequence of finite numbers, at most 1e+09"),
    ("SweepSpec(III, Plane.X_PX, (True, False))", "values=(True, False): must be a sequence of finite numbers"),
    ("replace(plate, values=(0.1, 0.2))", "values[0]=0.1: must be a sequence of finite numbers"),
    ("replace(plate, values=((0.2,), ()))", "values[1]=(): must be 1 to 10000 different numbers"),
    ("replace(plate, values=((0.2,), (0.8, 5000.0)))", "epsilon=5000.0: must be from 0.01 to 100"),
    (
        'replace(plate, along=("h", "jacobi"))',
        "along=h, jacobi: must be one axis, or a pair of different axes of which at most one",
    ),
    ("replace(plate, along=(EPSILON, EPSILON), energy=0.2)", "along=epsilon, epsilon: must be one axis, or a pair of different"),
    ("compute_sweep(plate, earlier=other)", "earlier: holds another request, with axis='h'; must have axis='h, epsilon'"),
    ("compute_sweep(plate, measure=lambda point: 3)", "measure: returned 3; must return an xarray.Dataset"),
    ('compute_sweep(sw, "a\\0b")', "store='a\\x00b': must be the path of a file or folder, without a null character"),
    ('find_where(plate, "share_bounded", 0.1)', "spec: has the axes h and epsilon; must have one axis"),
    ('find_where(many_values, "share_bounded", 0.1)', "spec: has 50 values; must have from 2 to most_maps=40 values"),
    ('find_where(sw, "share_bounded", 0.1, last="yes")', "last='yes': must be True or False"),
    ('find_where(sw, "s_β", 0.1)', "quantity='s_β': must be one of direct_share,"),
    ('find_where(sw, "share_bounded", True)', "value=True: must be a finite number, at most 1e+09 in magnitude"),
    ('compute_map(spec, store="")', "store='': must be the path of a file or folder"),
    ('compute_map(spec, store=tmp / "no" / "map.nc")', "store=…/map.nc: the folder …/no does not exist; make it first"),
    ("MapSpec(III, Plane.X_PX, 0.45, (True, 10))", "resolution=(True, 10): must be (columns, rows), each from 1 to 4096"),
    ('MapSpec(III, Plane.X_PX, 0.45, window="0101")', "window x edge='0': must be a finite number, at most 1e+09 in magnitude"),
    ("MapSpec(III, Plane.X_PX, 0.45, window=(False, True, 0, 1))", "window x edge=False: must be a finite number"),
    ("compute_regularity(m, on_frame=3)", "on_frame=3: must be a function or None"),
    ("compute_trust(m, on_frame=3)", "on_frame=3: must be a function or None"),
    ("compute_lagrangian_descriptor(m, on_frame=3)", "on_frame=3: must be a function or None"),
    ('compute_returns(spec, on_frame="x")', "on_frame='x': must be a function or None"),
    ("find_periodic_orbits(spec, on_frame=3)", "on_frame=3: must be a function or None"),
    ("find_symmetric_families(spec, on_frame=3)", "on_frame=3: must be a function or None"),
    ("continue_family(found[0], 0.4, on_frame=3)", "on_frame=3: must be a function or None"),
    (
        "continue_family(found[0], (0.4, 0.2))",
        "until=(0.4, 0.2): must be a value of h below 0.3 or above 0.3, or (low, high) around",
    ),
    ('compute_uncertainty_exponent(spec, work=float("inf"))', "work=inf: must be above 0 and at most 1e+12"),
    ("compute_uncertainty_exponent(spec, work=True)", "work=True: must be above 0 and at most 1e+12"),
    (
        "classify_orbits(POTENTIALS['Hill'], None, [(0.0, 0.0, 0.0, 1.0)])",
        "states: row 0 has energy -inf; must have a finite energy",
    ),
    (
        "start_states(III, Plane.X_PX, np.array([0.4, 0.5]), np.zeros(1), np.zeros(1))",
        "energy of shape (2,): must be a number, or shaped like x, (1,)",
    ),
    ('start_states(III, Plane.X_PX, float("nan"), 0.1, 0.2)', "energy=nan: must be a finite number, at most 1e+09 in magnitude"),
    ("III.energy((0.0, 0.0, 0.1))", "states of shape (3,): must be (…, 4) with x, y, px, py"),
    ('System("I", "x²")', "formula='x²': must be empty for I, which has a formula"),
    ('System("I", parameters={"epsilon": "2"})', "epsilon='2': must be a finite number, at most 1e+09 in magnitude"),
    ('parse_formula("½r² − a x y²", parameters={"a": [1.0]})', "a=[1.0]: must be a finite number, at most 1e+09 in magnitude"),
    ('parse_formula("½r² − a x y²", parameters={"a": 1.0, None: 2.0})', "parameters=None: must be text"),
    ('ParameterAxis("a", 0.5, float("nan"), parse_formula("½r² − a x y²"))', "parameter a=nan: must be a finite number"),
    ("m.save(3)", "path=3: must be text or a path"),
    ('m.save("a\\0.nc")', "path='a\\x00.nc': must be the path of a file or folder, without a null character"),
    ('open_result("")', "path='': must be the path of a file or folder, without a null character"),
    ("spec.to_html(3)", "path=3: must be text or a path"),
    ('m.to_html(tmp / "a.html", energies=0.3)', "energies=0.3: must be a pair of numbers"),
    ('m.to_html(tmp / "a.html", starts=(0.1, 0.2))', "starts=0.1: must be a pair of numbers"),
    ('m.to_html(tmp / "a.html", starts=3)', "starts=3: must be a Sequence"),
    ('m.to_html(tmp / "a.html", caption=3)', "caption=3: must be text"),
    ('m.to_html(tmp / "a.html", link=3)', "link=3: must be text"),
    ('m.plot(axes, legend="below")', "legend='below': must be True or False"),
    ("m.plot(axes, colorbar=1)", "colorbar=1: must be True or False"),
    ('m.plot(axes, picture="times", cmap="virids")', "cmap='virids': must be a Colormap of Matplotlib or the name of one"),
    ('m.plot(axes, picture="times", norm=(0, 1))', "norm=(0, 1): must be a Normalize of Matplotlib or the name of one"),
    (
        'm.plot(axes, picture=["basins"])',
        "picture=['basins']: must be one of curves, basins, times, crossings, characters, origin",
    ),
    ('m.plot(axes, palette=["red"])', "palette=['red']: must be one of paper, safe, or a mapping from fates to colours"),
    ('m.plot(axes, palette={1.0: "red"})', "palette: fate=1.0: must be a Fate, or the number of an outcome, 1 to 4"),
    ('m.plot(axes, palette={True: "red"})', "palette: fate=True: must be a Fate, or the number of an outcome, 1 to 4"),
    ('m.plot(Figure().add_subplot(projection="polar"))', "ax=…: must be Matplotlib axes or None, and not polar"),
    ('m.plot(Figure().add_subplot(projection="3d"))', "ax=…: must be Matplotlib axes or None, and not polar"),
    ("pair.plot(axes, outcome=True)", "outcome=True: must be an integer from 0 to 2"),
    ("pair.plot(axes, outcome=1.0)", "outcome=1.0: must be an integer from 0 to 2"),
    ('pair.plot(axes, cmap="virids")', "cmap='virids': must be a Colormap of Matplotlib or the name of one, such as 'viridis'"),
    ('pair.plot(axes, measure=["shares"])', "measure=['shares']: must be one of shares"),
    ("other_shares.plot(axes, outcome=1)", "outcome=1: must be None for a picture that is not of the share of one outcome"),
    ('read_slice("x_px", "y=0.1", System("I"))', "fix='y=0.1': must be left out for x_px; give two axes such as x,py instead"),
    ('read_slice("x", "", System("I"))', "axes='x': must be one of x_y, x_px, x_h, y_py, tangential, or two axes such as x,py"),
    ('read_slice("x,z", "", System("I"))', "axes='z': must be one of x, y, px, py, theta, beta, h, omega_1, omega_2,"),
    ('read_slice("x,epsilon=a:2", "", System("I"))', "axes='epsilon=a:2': 'a' must be a number"),
    ('read_slice("x,y", "z=1", System("I"))', "fix='z=1': must be one of x, y, px, py, theta, beta, v, h with a number, such"),
)


@pytest.mark.parametrize(("call", "sentence"), WRONG_CALLS, ids=[call for call, _ in WRONG_CALLS])
def test_wrong_call_is_answered_with_one_sentence(call: str, sentence: str, tmp_path: Path) -> None:
    with pytest.raises((ValueError, TypeError) if ".plot(" in call else ValueError) as caught:
        eval(call, {**names(), "tmp": tmp_path})
    message = str(caught.value)
    first, *rest = sentence.split("…")
    assert message.startswith(first)
    assert all(part in message for part in rest)
    assert "\n" not in message
    assert len(message) < LONGEST


def test_one_start_may_be_given_by_numbers() -> None:
    rows = start_states(CASES["III"], Plane.X_PX, 0.45, np.array([0.1]), np.array([0.2]))
    assert start_states(CASES["III"], Plane.X_PX, 0.45, 0.1, 0.2).tolist() == rows.tolist()


def test_a_misspelt_name_is_answered_with_the_right_one() -> None:
    name = "Barbanis"
    with pytest.raises(KeyError, match="names are") as caught:
        _ = POTENTIALS[f"{name} "]
    assert isinstance(caught.value, ValueError)
    assert "did you mean" in str(caught.value)
    assert repr(name) in str(caught.value)
    assert POTENTIALS.get(f"{name} ") is None
    assert POTENTIALS[name].name == name


@pytest.mark.parametrize("formula", ["x² + y²", "x² + 2y² + x y²/9 + x⁴ + y⁴"])
def test_a_well_without_exits_has_a_map_without_escapes(formula: str) -> None:
    whole = compute_map(MapSpec(parse_formula(formula), Plane.X_PX, 0.3, (12, 12), t_max=100.0))
    assert whole.complete
    assert set(np.unique(whole.fate)) <= {Fate.FORBIDDEN, Fate.BOUNDED}
    assert whole.fractions()[Fate.BOUNDED] == 1.0


@pytest.mark.parametrize("formula", ["x² − y²", "x² + y"])
def test_motion_without_a_well_is_not_called_bounded(formula: str) -> None:
    potential = parse_formula(formula)
    with pytest.raises(ValueError, match="there is no exit, and the well is shown to be closed at no energy"):
        compute_map(MapSpec(potential, Plane.X_PX, 0.3, (8, 8), (-1.0, 1.0, -1.0, 1.0), t_max=10.0))
    orbit = integrate_orbit(potential, (0.1, 0.0, 0.0, 0.5), 10.0)
    assert judge_orbit(orbit).describe().startswith("Followed until t = 10")


def test_a_misspelt_argument_is_answered_with_the_name_of_the_function() -> None:
    with pytest.raises(TypeError, match=r"^sample_orbits\(\) got an unexpected keyword argument 't_max'"):
        sample_orbits(CASES["III"], [(0.1, 0.0, 0.0, 0.3)], (0.0, 1.0), t_max=5.0)  # type: ignore[call-arg]


def test_a_file_that_cannot_be_opened_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"^path=.*missing\.nc: there is no such file or folder$"):
        open_result(tmp_path / "missing.nc")
    (tmp_path / "text.nc").write_text("no numbers")
    with pytest.raises(OSError, match=r"^path=.*text\.nc: cannot be read as a NetCDF file: [^\n]*$"):
        open_result(tmp_path / "text.nc")


def test_files_that_hold_no_whole_result_are_named(tmp_path: Path) -> None:
    path, whole = tmp_path / "part.nc", names()["m"].to_xarray()
    empty = xr.Dataset({"a": ("x", [1.0, 2.0])})
    parts = [empty.assign_attrs(result=name) for name in ("EscapeMap", "Sweep", "Orbit", "Potential", "RegularityMap", "Islands")]
    for part in (*parts, whole.drop_vars("fate"), whole.assign_attrs(t_max="long")):
        part.to_netcdf(path)
        with pytest.raises(ValueError, match=rf"^path={path}: cannot be read as a result .*; must hold what this library has wr"):
            open_result(path)
    whole.drop_vars("fate").to_netcdf(path)
    with pytest.raises(ValueError, match=rf"^store={path}: cannot be read as a result .*fate"):
        compute_map(names()["spec"], store=path)


def test_periodic_orbits_of_a_map_backward_in_time_are_those_of_the_map() -> None:
    spec = MapSpec(CASES["III"], Plane.X_PX, 0.45, (10, 10), t_max=50.0)
    assert find_periodic_orbits(replace(spec, backward=True)).identical(find_periodic_orbits(spec))


def test_no_pixel_contains_a_place_that_is_not_a_number() -> None:
    spec: MapSpec = names()["spec"]
    assert spec.pixel_at(float("nan"), 0.0) is None
    assert spec.pixel_at(0.0, 0.0) is not None


def test_too_many_arguments_are_answered_as_by_python() -> None:
    with pytest.raises(TypeError, match=r"^compute_lagrangian_descriptor\(\) takes 1 positional argument but 2 were given$"):
        compute_lagrangian_descriptor(None, 10.0)
