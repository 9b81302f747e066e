"""Pixels of a map, numbered row by row from 0: their mirror images, and the codes that an analysis assigns to them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.result import MapResult
from engine.foundations.stored_fields import write_field
from engine.maps.result import EscapeMap, PixelArrays, pixel_dataset
from engine.maps.spec import MapSpec

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, eq=False, repr=False)
class PixelAnalysis(MapResult):
    """Base of results of an analysis of every pixel of a map.

    Attributes
    ----------
    spec
        The map's request.
    complete
        Whether every pixel is decided.
    """

    spec: MapSpec
    complete: bool = field(default=True, kw_only=True)
    pixel_arrays: ClassVar[PixelArrays] = {}
    """The arrays of the analysis, of shape (rows, columns)."""

    def to_xarray(self) -> xr.Dataset:
        """Return the values of the pixels as a dataset with named axes and provenance, which can be written as NetCDF."""
        images = {name: value for name, value in vars(self).items() if isinstance(value, np.ndarray) and value.ndim == 2}
        variables = {name: (image, self._meaning(name, image)) for name, image in images.items()}
        numbers = {name: write_field(value) for name, value in self.numbers().items()}
        attributes = {"result": type(self).__name__, **self.spec.provenance(), **numbers}
        return pixel_dataset(self.spec, self.spec.pixel_centres(), variables, attributes)


def code_share(codes: np.ndarray, *selected: int) -> float:
    """Return the share of the codes that equal one of the selected codes; NaN if there are no codes."""
    return float(np.mean(np.isin(codes, selected))) if codes.size else float("nan")


class MirrorPixels:
    """Pairs of pixels whose orbits are exact mirror images under x → −x. Only the first pixel of a pair needs computing.

    Parameters
    ----------
    spec
        The map.
    x, ordinate
        (columns,), (rows,) pixel centres of the map or of some of its rows.

    Attributes
    ----------
    symmetric
        Whether the potential, the pixels and the section are symmetric under x → −x.
    partner
        (n,) mirror image of each pixel; without this symmetry, the pixel itself.
    """

    def __init__(self, spec: MapSpec, x: np.ndarray, ordinate: np.ndarray) -> None:
        # Crossings of a section that is not symmetric differ from those of mirror images.
        is_symmetric = spec.section.is_mirrored
        partner = spec.plane.find_mirror_images(spec.potential, x, ordinate) if is_symmetric else None
        self.symmetric = partner is not None
        self.partner = np.arange(x.size * ordinate.size) if partner is None else partner

    def select_first_images(self, pixels: np.ndarray) -> np.ndarray:
        """Return the pixels among `pixels`, (n,), that are the first of their pair."""
        return pixels[pixels <= self.partner[pixels]]

    def find_first_images(self, pixels: np.ndarray) -> np.ndarray:
        """Return the first pixels of the pairs of `pixels`, of shape (n,). Given and returned pixels are sorted and distinct."""
        is_first = np.zeros(self.partner.size, bool)
        is_first[np.minimum(pixels, self.partner[pixels])] = True
        return np.flatnonzero(is_first)

    def copy_to_second_images(self, values: np.ndarray) -> None:
        """Overwrite, in a contiguous array (rows, columns), the second pixel of each pair by the first."""
        second_images = np.flatnonzero(self.partner < np.arange(self.partner.size))
        values.ravel()[second_images] = values.ravel()[self.partner[second_images]]


class PixelCodes:
    """The codes of the pixels of a map while an analysis decides them. Mirror images have the same code.

    Parameters
    ----------
    escape_map
        The map.
    codes
        (rows, columns) codes that follow from the map alone, and `pending` where the analysis has to decide.
    pending
        The code of undecided pixels.

    Attributes
    ----------
    pixels
        (n,) the pixels to decide, without second mirror images.
    """

    def __init__(self, escape_map: EscapeMap, codes: np.ndarray, pending: int) -> None:
        self._mirror = MirrorPixels(escape_map.spec, escape_map.x, escape_map.ordinate)
        self._codes, self._pending = codes.astype(np.int8), pending
        self.pixels = self._mirror.select_first_images(np.flatnonzero(codes == pending))

    def assign(self, pixels: np.ndarray, code: int) -> None:
        """Set the code of the pixels (n,)."""
        self._codes.ravel()[pixels] = code

    def mirrored(self, values: np.ndarray) -> np.ndarray:
        """Return a read-only copy of values (rows, columns) in which the second pixel of each pair has the value of the first."""
        mirrored = values.copy()
        self._mirror.copy_to_second_images(mirrored)
        return read_only(mirrored)

    def snapshot(self) -> tuple[np.ndarray, bool]:
        """Return a read-only copy of the codes (rows, columns), and whether all pixels are decided."""
        codes = self.mirrored(self._codes)
        return codes, not np.any(codes == self._pending)
