"""Initial deviation vectors of the variational equations."""

from __future__ import annotations

import numpy as np

# Fixed, generic and orthonormal: the same orbit always gets the same answer, and no symmetry keeps a vector apart.
DEVIATION_VECTORS = np.array([[1.0, 2.0, 3.0, 4.0], [4.0, -3.0, 2.0, -1.0]]) / np.sqrt(30.0)
DEVIATION_VECTORS.flags.writeable = False
