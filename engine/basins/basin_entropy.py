"""Basin entropy: how unsure the end of an orbit is when its start is known only to lie within a small box."""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.basins.labels import checked_labels

BOX = 5
"""Default side of a box in pixels: 25 starts to a box, as in Daza et al. (2016)."""

# Two labels in equal parts give ln 2 itself, and their mean may end a few units in the last place above it.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class BasinEntropy:
    """Basin entropies of a picture, in nats (dimensionless).

    Attributes
    ----------
    s_b
        S_b, the mean entropy of all boxes that count, 0 to ln(labels); NaN without any.
    s_bb
        S_bb, the mean entropy of the boxes with more than one label; NaN without any.
    s_b_error, s_bb_error
        Standard errors of these means as if the boxes were drawn independently, NaN for fewer than two boxes. A tiling covers
        the picture more evenly than that: shifting it by some pixels changed S_b and S_bb of some maps by up to about two
        thirds of these. They do not hold what another box size or a finer picture changes, which is more.
    boxes, boundary_boxes
        How many boxes count, and how many of them hold more than one label.
    labels
        How many different labels the boxes that count hold.
    box
        Side of a box in pixels.
    """

    s_b: float
    s_bb: float
    s_b_error: float
    s_bb_error: float
    boxes: int
    boundary_boxes: int
    labels: int
    box: int

    @property
    def beyond_ln2(self) -> bool:
        """Whether S_bb > ln 2, which suffices for a boundary that is not smooth at the scale of a box.

        A smooth boundary parts two labels nearly everywhere, and a box with two has at most ln 2; three meet at isolated points,
        whose share among ever smaller boxes on the boundary vanishes. So beyond ln 2 the boundary is fractal, or has
        smooth parts closer together than a box, which a finer picture tells apart. Not beyond ln 2 says nothing: fractal
        boundaries between two basins never get there.
        """
        return self.s_bb > math.log(2.0) + _ROUNDING

    def describe(self) -> str:
        """The result in a sentence or two."""
        size = f"{self.box} × {self.box} starts"
        if not self.boxes:
            return f"No basin entropy: no box of {size} lies wholly among the starts that count."
        whole = f"S_b = {_with_error(self.s_b, self.s_b_error)} over {_count(self.boxes, 'box', 'boxes')} of {size}"
        if not self.boundary_boxes:
            return f"{whole}: no box holds more than one label."
        boundary = f"S_bb = {_with_error(self.s_bb, self.s_bb_error)} over the {self.boundary_boxes} on a boundary"
        return f"{whole}; {boundary}. {self._conclusion()}"

    def _conclusion(self) -> str:
        if self.beyond_ln2:
            return "S_bb > ln 2: at this scale the boundary is not smooth."
        if self.labels < 3:
            return "With two labels S_bb cannot exceed ln 2: the ln 2 criterion is no question."
        return "S_bb ≤ ln 2: the ln 2 criterion leaves open whether the boundary is fractal."


def compute_basin_entropy(labels: Any, valid: Any = None, box: int = BOX) -> BasinEntropy:
    """S_b and S_bb of a labelled picture.

    The picture is tiled with boxes from its first row and column on; a strip narrower than a box at the far edges is left out,
    and so is each box with a pixel that does not count. With p_ij the share of label j in box i,

        S_i = Σ_j p_ij ln(1/p_ij),   S_b = mean of all S_i,   S_bb = mean of those S_i with more than one label

    (Daza, Wagemakers, Georgeot, Guéry-Odelin & Sanjuán 2016, Sci. Rep. 6, 31416; leaving out boxes is ours). Entropies of
    different box sizes, or of different distances between pixels, are not comparable.

    Parameters
    ----------
    labels
        (rows, columns) of any integers; equal ones are one basin. For a map: `exit_labels`.
    valid
        (rows, columns) bool, the pixels that count; None for all.
    box
        Side of a box in pixels, 2 to the shorter side of the picture.

    Returns
    -------
    The `BasinEntropy`. As the shares are those of finitely many starts, entropies come out low for finely mixed basins: by about
    (m − 1)/(2 box²) for m labels at random, 0.04 for three in boxes of 5 × 5.

    Raises
    ------
    ValueError
        When a parameter is out of its range.
    """
    labels, valid = checked_labels(labels, valid)
    box = _checked_box(box, labels.shape)
    boxes = _tile(labels, box)[_tile(valid, box).all(axis=1)]
    entropies, kinds = _box_entropies(boxes)
    s_b, s_b_error = _mean(entropies)
    s_bb, s_bb_error = _mean(entropies[kinds > 1])
    return BasinEntropy(
        s_b, s_bb, s_b_error, s_bb_error, len(boxes), int(np.count_nonzero(kinds > 1)), np.unique(boxes).size, box
    )  # fmt: skip


def _checked_box(box: int, shape: tuple[int, ...]) -> int:
    try:
        side = operator.index(box)
    except TypeError:
        side = 0
    if not 2 <= side <= min(shape):
        raise ValueError(f"box={box!r}: must be an integer from 2 to the shorter side of the picture, {min(shape)}")
    return side


def _tile(image: np.ndarray, box: int) -> np.ndarray:
    """(boxes, box²): the pixels of each whole box."""
    rows, columns = (side // box for side in image.shape)
    parts = image[: rows * box, : columns * box].reshape(rows, box, columns, box)
    return parts.swapaxes(1, 2).reshape(rows * columns, box * box)


def _box_entropies(boxes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """S_i (boxes,), exactly 0 for one label, and the number of labels (boxes,) of each box."""
    count, size = boxes.shape
    ordered = np.sort(boxes, axis=1)
    first = np.ones(boxes.shape, np.bool_)
    first[:, 1:] = ordered[:, 1:] != ordered[:, :-1]
    begins = np.flatnonzero(first)
    share = np.diff(begins, append=boxes.size) / size
    where = begins // size
    return np.bincount(where, -share * np.log(share), count), np.bincount(where, minlength=count)


def _mean(entropies: np.ndarray) -> tuple[float, float]:
    """Mean and standard error; NaN where there is none."""
    if not entropies.size:
        return math.nan, math.nan
    error = float(entropies.std(ddof=1)) / math.sqrt(entropies.size) if entropies.size > 1 else math.nan
    return float(entropies.mean()), error


def _with_error(value: float, error: float) -> str:
    return f"{value:.3f}" if math.isnan(error) else f"{value:.3f} ± {error:.3f}"


def _count(number: int, one: str, many: str) -> str:
    return f"{number} {one if number == 1 else many}"
