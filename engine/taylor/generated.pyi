"""What `codegen` writes for each potential, for the type checker; `loop`, `swing` and `gliding` are compiled behind it."""

from numpy import ndarray

def step(
    coefficients: ndarray,
    n: int,
    tolerance: float,
    horizon: float,
    gates: ndarray,
    x: ndarray,
    y: ndarray,
    px: ndarray,
    py: ndarray,
    t: ndarray,
    x_new: ndarray,
    y_new: ndarray,
    px_new: ndarray,
    py_new: ndarray,
    t_new: ndarray,
    h_taken: ndarray,
    flag: ndarray,
    crossed: ndarray,
) -> None: ...
def glide(
    coefficients: ndarray,
    n: int,
    h: float,
    weight: float,
    x: ndarray,
    y: ndarray,
    px: ndarray,
    py: ndarray,
    x_square: ndarray,
    y_square: ndarray,
) -> None: ...
def jets(
    coefficients: ndarray, n: int, x: ndarray, y: ndarray, px: ndarray, py: ndarray, x_jet: ndarray, y_jet: ndarray
) -> None: ...
def tangent(
    coefficients: ndarray,
    n: int,
    duration: ndarray,
    x: ndarray,
    y: ndarray,
    px: ndarray,
    py: ndarray,
    wx: ndarray,
    wy: ndarray,
    wpx: ndarray,
    wpy: ndarray,
) -> None: ...
def potential_value(coefficients: ndarray, x: float, y: float) -> float: ...
