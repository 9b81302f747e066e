"""A file with the finished part of a map, from which an interrupted computation continues."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from engine.foundations.netcdf_files import read_netcdf, write_netcdf
from engine.foundations.output_lock import hold_lock
from engine.foundations.stored_fields import content_named
from engine.maps.result import EscapeMap, read_map
from engine.maps.spec import MapSpec

# Shortest time between two saves in seconds, and the largest share of the time that saves take.
_SHORTEST_INTERVAL, _LARGEST_SHARE = 10.0, 0.05


@contextmanager
def open_map_store(path: Path, spec: MapSpec) -> Iterator[MapStore]:
    """Open the file of a map, new or with a part of the map, locked for this process.

    Raises
    ------
    ValueError
        If the file holds another map or no map, its name does not end in ".nc", its folder does not exist, or the map is along
        a parameter.
    OSError
        If the file cannot be read or written.
    BlockingIOError
        If another process has locked the file.
    """
    if path.suffix != ".nc":
        raise ValueError(f"store={path}: must end in .nc")
    if spec.plane.parameter is not None:
        raise ValueError(f"store={path}: must be None for a map along a parameter; compute_sweep stores maps at its values")
    if not path.absolute().parent.exists():
        raise ValueError(f"store={path}: the folder {path.parent} does not exist; make it first")
    with hold_lock(path):
        yield MapStore(path, _read_earlier(path, spec))


def _read_earlier(path: Path, spec: MapSpec) -> EscapeMap | None:
    """Return the map of a file, None if the file does not exist."""
    if not path.exists():
        return None
    dataset = read_netcdf(path)
    if dataset.attrs.get("result") != EscapeMap.__name__:
        raise ValueError(f"store={path}: holds no map; must be new, or the store of this map")
    with content_named(f"store={path}"):
        earlier = read_map(dataset)
    if different := spec.different_fields(earlier.spec):
        raise ValueError(f"store={path}: holds a map with another {', '.join(different)}; must be new, or the store of this map")
    return earlier


class MapStore:
    """The file of a map.

    Attributes
    ----------
    earlier
        The map that the file held when it was opened; None for a new file.
    """

    def __init__(self, path: Path, earlier: EscapeMap | None) -> None:
        self._path, self.earlier = path, earlier
        self._next_save = time.monotonic() + _SHORTEST_INTERVAL

    def save(self, escapes: EscapeMap) -> None:
        """Replace the content of the file."""
        begin = time.monotonic()
        write_netcdf(escapes.to_xarray(), self._path)
        end = time.monotonic()
        self._next_save = end + max(_SHORTEST_INTERVAL, (end - begin) / _LARGEST_SHARE)

    def saving(self, on_frame: Callable[[EscapeMap], None] | None) -> Callable[[EscapeMap], None]:
        """Return a function that saves a frame when enough time has passed since the last save, and then calls `on_frame`."""

        def receive(frame: EscapeMap) -> None:
            if time.monotonic() >= self._next_save:
                self.save(frame)
            if on_frame is not None:
                on_frame(frame)

        return receive
