"""Another view of starts, with whose map that of the view state is compared pixel by pixel."""

from __future__ import annotations

from dataclasses import dataclass

from engine import MapSpec, Potential, Slice, System


@dataclass(frozen=True)
class ComparedView:
    """What differs between the two views; window, resolution and t_max are those of the view state.

    Attributes
    ----------
    system
        The system.
    plane
        The slice.
    energy
        The energy, or the lowest and the highest one of a slice with an axis h; in the units of the potential.
    """

    system: System
    plane: Slice
    energy: float | tuple[float, float]

    @property
    def title(self) -> str:
        """The view in words."""
        energy = "" if isinstance(self.energy, tuple) else f", h = {self.energy:.6g}"
        return f"{self.system.title}, {self.plane.title}{energy}"

    def map_spec(self, potential: Potential, like: MapSpec) -> MapSpec:
        """The map of this view with the pixels of another map.

        Parameters
        ----------
        potential
            That of the system, reviewed.
        like
            The other map, whose window is known.

        Raises
        ------
        ValueError
            If the view has no such map.
        """
        return MapSpec(potential, self.plane, self.energy, like.resolution, like.find_window(), like.t_max)
