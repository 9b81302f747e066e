"""The finished bands of a map that is under way: files that are there whole or not at all, until the map is."""

from __future__ import annotations

import os
import shutil
from collections.abc import Mapping
from pathlib import Path

import numpy as np


class KeptBands:
    """Bands of one map in a folder of their own, which is made when the first is kept.

    Parameters
    ----------
    folder
        Where.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def __contains__(self, number: int) -> bool:
        return self._file(number).exists()

    def keep(self, number: int, images: Mapping[str, np.ndarray]) -> None:
        """Keep the arrays of a band; its file gets its name once all of it is on the disk, so that a name is a mark.

        Raises
        ------
        OSError
            When the disk is full or cannot be written to; the band is not there then.
        """
        self._folder.mkdir(parents=True, exist_ok=True)
        unfinished = self._folder / f"{number}.partial"
        with unfinished.open("wb") as file:
            np.savez(file, allow_pickle=False, **images)
            file.flush()
            os.fsync(file.fileno())
        os.replace(unfinished, self._file(number))

    def read(self, number: int, name: str) -> np.ndarray:
        """One array of a band."""
        with np.load(self._file(number), allow_pickle=False) as images:
            array: np.ndarray = images[name]
        return array

    def discard(self) -> None:
        """Delete all of them."""
        shutil.rmtree(self._folder, ignore_errors=True)

    def _file(self, number: int) -> Path:
        return self._folder / f"{number}.npz"
