"""List environment variables with which libraries compute as on another processor."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

_FEATURES = (
    *("cmov", "cx16", "fxsr", "mmx", "popcnt", "sahf", "sse", "sse2", "sse3", "sse4.1", "sse4.2", "ssse3"),
    *("avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "xsave"),
)
_OF_NUMPY = [
    name for name in np.show_config(mode="dicts")["SIMD Extensions"].get("found", []) if name not in ("X86_V2", "X86_V3")
]

X86_64_V3: Mapping[str, str] = MappingProxyType(
    {
        # The name alone would keep the features of this processor.
        "NUMBA_CPU_NAME": "haswell",
        "NUMBA_CPU_FEATURES": ",".join(f"+{name}" for name in _FEATURES),
        "OPENBLAS_CORETYPE": "Haswell",
        "NPY_DISABLE_CPU_FEATURES": " ".join(_OF_NUMPY),
    }
)
"""Variables for processors with AVX2 and without AVX-512, for Numba, OpenBLAS and NumPy."""
