"""Basin entropy: uncertainty of the outcome of an orbit whose start is known only up to a small box of pixels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.foundations.result import RecordedResult
from engine.foundations.validation import checked_count
from engine.foundations.wording import format_count
from engine.measures.basins.starts import checked_labels, describe_labels

DEFAULT_BOX = 5
"""Default side of a box in pixels; a box has 25 starts, as in Daza et al. (2016)."""

COUNTS_BOUNDED = True
"""Whether bounded orbits have a label of their own: yes, because they are one of the possible outcomes of a start."""

# Boxes with two labels in equal parts have an entropy of ln 2; their mean can exceed ln 2 by less than this, due to rounding.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class BasinEntropy(RecordedResult):
    """Basin entropies of a labelled image, in nats (dimensionless).

    Attributes
    ----------
    s_b
        S_b, the mean entropy of all boxes that count, 0 to ln(labels); NaN if no box counts.
    s_bb
        S_bb, the mean entropy of the boxes that count and have more than one label; NaN if there are no such boxes.
    s_b_error, s_bb_error
        Standard errors of these means for independent boxes; NaN for fewer than two boxes. The means of a tiling vary less than
        those of independent boxes: shifting the tiling by a few pixels changed S_b and S_bb of some maps by up to about two
        thirds of these errors. The errors do not include the larger effect of another box size or resolution.
    boxes, boundary_boxes
        Number of boxes that count, and number of these boxes with more than one label.
    labels
        Number of different labels in the boxes that count.
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
        """Whether S_bb > ln 2, a sufficient condition for a boundary that is not smooth at the scale of a box.

        A smooth boundary separates two labels almost everywhere, and a box with two labels has an entropy of at most ln 2. Three
        labels meet only at isolated points, whose share of the boundary boxes vanishes as boxes shrink. Beyond ln 2 the boundary
        is therefore fractal, or has smooth parts closer together than a box, which a finer image would resolve. The converse does
        not hold: fractal boundaries between two basins never exceed ln 2.
        """
        return self.s_bb > math.log(2.0) + _ROUNDING

    def numbers(self) -> dict[str, Any]:
        """Return the scalar attributes, and the conclusion."""
        return {**super().numbers(), "beyond_ln2": self.beyond_ln2}

    def describe(self) -> str:
        """Return the result in one or two sentences."""
        box_text = f"{self.box} × {self.box} starts"
        if not self.boxes:
            return f"No basin entropy: no box of {box_text} consists only of starts that count."
        s_b_text = f"S_b = {_format_mean(self.s_b, self.s_b_error)} over {format_count(self.boxes, 'box', 'boxes')} of {box_text}"
        if not self.boundary_boxes:
            return f"{s_b_text}: no box holds more than one label."
        s_bb_text = f"S_bb = {_format_mean(self.s_bb, self.s_bb_error)} over the {self.boundary_boxes} on a boundary"
        return f"{s_b_text}; {s_bb_text}. {self._describe_conclusion()}"

    def _describe_conclusion(self) -> str:
        """Return what S_bb implies for the boundary, in a sentence."""
        if self.beyond_ln2:
            return "S_bb > ln 2: at this scale the boundary is not smooth."
        if self.labels < 3:
            return "With two labels S_bb cannot exceed ln 2, so the ln 2 criterion does not apply."
        return "S_bb ≤ ln 2: the boundary can be smooth or fractal."


def compute_basin_entropy(labels: Any, valid: Any = None, *, box: int = DEFAULT_BOX) -> BasinEntropy:
    """Compute the basin entropies S_b and S_bb of a labelled image.

    The image is tiled with boxes from its first row and column. A strip at the far edges that is narrower than a box does not
    count, nor does a box with a pixel that does not count. With p_ij the share of label j in box i,

        S_i = Σ_j p_ij ln(1/p_ij),   S_b = mean of all S_i,   S_bb = mean of the S_i of boxes with several labels

    (Daza, Wagemakers, Georgeot, Guéry-Odelin & Sanjuán 2016, Sci. Rep. 6, 31416; leaving out boxes is our choice). Entropies for
    different box sizes or pixel spacings are not comparable.

    Parameters
    ----------
    labels
        A complete map or its dataset, such as ``dataset.sel(h=0.3)`` of a sweep; its bounded orbits are a basin of their own. Or
        (rows, columns) integers; equal integers are one basin.
    valid
        (rows, columns) bool, the pixels that count. None for the interior pixels of a map, or for all pixels of an array without
        negative labels.
    box
        Side of a box in pixels, from 2 to the shorter side of the image.

    Returns
    -------
    The `BasinEntropy`. Shares of finitely many starts underestimate the entropy of finely mixed basins, by about
    (m − 1)/(2 box²) for m random labels: 0.04 for three labels in boxes of 5 × 5.

    Raises
    ------
    ValueError
        If a parameter is out of range, or labels are negative without `valid`.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_basin_entropy, compute_map
    >>> entropy = compute_basin_entropy(compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.45, (80, 80), t_max=1e3)))
    >>> round(entropy.s_b, 2), round(entropy.s_bb, 2), entropy.beyond_ln2
    (0.5, 1.06, True)
    """
    made_by = describe_labels(labels)
    labels, valid = checked_labels(labels, valid, bounded=COUNTS_BOUNDED)
    if min(labels.shape) < 2:
        raise ValueError(f"labels of shape {labels.shape}: must have at least two rows and two columns")
    box = checked_count("box", box, 2, min(labels.shape))
    boxes = _split_into_boxes(labels, box)[_split_into_boxes(valid, box).all(axis=1)]
    entropies, label_counts = _box_entropies(boxes)
    on_boundary = label_counts > 1
    s_b, s_b_error = _mean_and_error(entropies)
    s_bb, s_bb_error = _mean_and_error(entropies[on_boundary])
    return BasinEntropy(
        s_b, s_bb, s_b_error, s_bb_error, len(boxes), int(np.count_nonzero(on_boundary)), np.unique(boxes).size, box,
        made_by=made_by,
    )  # fmt: skip


def _split_into_boxes(image: np.ndarray, box: int) -> np.ndarray:
    """Return the pixels of each complete box, of shape (boxes, box²)."""
    rows, columns = (side // box for side in image.shape)
    tiles = image[: rows * box, : columns * box].reshape(rows, box, columns, box)
    return tiles.swapaxes(1, 2).reshape(rows * columns, box * box)


def _box_entropies(boxes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return S_i and the number of labels of each box, (boxes,) each; S_i is exactly 0 for one label."""
    box_count, pixels_per_box = boxes.shape
    sorted_boxes = np.sort(boxes, axis=1)
    # Runs of equal labels in the sorted boxes, given by the index of their first pixel.
    is_first = np.ones(boxes.shape, np.bool_)
    is_first[:, 1:] = sorted_boxes[:, 1:] != sorted_boxes[:, :-1]
    run_starts = np.flatnonzero(is_first)
    shares = np.diff(run_starts, append=boxes.size) / pixels_per_box
    box_index = run_starts // pixels_per_box
    return np.bincount(box_index, -shares * np.log(shares), box_count), np.bincount(box_index, minlength=box_count)


def _mean_and_error(entropies: np.ndarray) -> tuple[float, float]:
    """Return the mean and its standard error; NaN for a mean of no boxes, and for an error from fewer than two boxes."""
    if not entropies.size:
        return math.nan, math.nan
    error = float(entropies.std(ddof=1)) / math.sqrt(entropies.size) if entropies.size > 1 else math.nan
    return float(entropies.mean()), error


def _format_mean(value: float, error: float) -> str:
    """Return a mean in words, with its standard error if there is one."""
    return f"{value:.3f}" if math.isnan(error) else f"{value:.3f} ± {error:.3f}"
