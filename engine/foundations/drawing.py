"""What `Result.plot` has drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.colorbar import Colorbar
    from matplotlib.image import AxesImage
    from matplotlib.legend import Legend


@dataclass(frozen=True, eq=False)
class Drawing:
    """The axes with a result, and the artists of Matplotlib that show the result.

    Attributes
    ----------
    ax
        The axes, in the coordinates of the result.
    artists
        All artists that show the result, from back to front.
    image
        The image of a map, of a sweep with two axes or of another result with pixels; None for results without pixels. The image
        of a picture with a colour scale contains the numbers, so it fits ``figure.colorbar(drawing.image)``.
    legend
        The legend; None without one.
    colorbar
        The colour bar; None without one.
    """

    ax: Axes
    artists: tuple[Artist, ...]
    image: AxesImage | QuadMesh | None = None
    legend: Legend | None = None
    colorbar: Colorbar | None = None
