"""Outlines of generated code, stored on disk, so that code that is compiled can be loaded without being generated again."""

from __future__ import annotations

import hashlib
import pickle
from functools import partial
from pathlib import Path

from engine.foundations.cache_files import SUFFIX, cache_folder, read_or_make
from engine.integrator.jit.compiling_process import call_compiler
from engine.integrator.jit.source_digests import hash_package, program_digest
from engine.integrator.source.recurrence import CodeOutline, Structure, outline_code

# The package with the classes of which structures consist.
_EXPRESSIONS = Path(__file__).parents[2] / "expressions"


def find_outline(structure: Structure) -> CodeOutline:
    """Return the outline of the generated functions of a structure, from the disk or else generated, which can take seconds.

    Raises
    ------
    ValueError
        If another process generates the functions and cannot; the message has the reason.
    """
    definition = repr((structure, program_digest(), hash_package(_EXPRESSIONS)))
    key = hashlib.sha256(definition.encode()).hexdigest()[:24]
    make = partial(call_compiler, partial(_pickle_outline, structure))
    outline: CodeOutline = pickle.loads(read_or_make(cache_folder() / f"{__name__}.{key}{SUFFIX}", "outlines of kernels", make))
    return outline


def _pickle_outline(structure: Structure) -> bytes:
    return pickle.dumps(outline_code(structure))
