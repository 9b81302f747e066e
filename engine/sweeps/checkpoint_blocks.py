"""Checkpoint of a map: its finished row blocks in files, each of which is written atomically."""

from __future__ import annotations

import os
import shutil
from collections.abc import Mapping
from pathlib import Path

import numpy as np


class CheckpointBlocks:
    """Finished row blocks of one map, one file each.

    Parameters
    ----------
    folder
        Folder of the files; created with the first block.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def __contains__(self, number: int) -> bool:
        return self._file(number).exists()

    def write(self, number: int, images: Mapping[str, np.ndarray]) -> None:
        """Write the arrays of a block; its file is renamed to its final name once it is on the disk.

        Raises
        ------
        OSError
            When the file cannot be written, as on a full disk; the block is then missing.
        """
        self._folder.mkdir(parents=True, exist_ok=True)
        unfinished = self._folder / f"{number}.partial"
        with unfinished.open("wb") as file:
            np.savez(file, allow_pickle=False, **images)
            file.flush()
            os.fsync(file.fileno())
        os.replace(unfinished, self._file(number))

    def read(self, number: int, name: str) -> np.ndarray:
        """Return one array of a block."""
        with np.load(self._file(number), allow_pickle=False) as images:
            array: np.ndarray = images[name]
        return array

    def delete(self) -> None:
        """Delete all blocks."""
        shutil.rmtree(self._folder, ignore_errors=True)

    def _file(self, number: int) -> Path:
        return self._folder / f"{number}.npz"
