"""Straight-line programs as a WebAssembly module with SIMD that runs in the browser of a visitor.

The functions of a potential are those that kernels call by their addresses, with the same arguments in the same order
(`engine.integrator.jit.function_pointers`). Kernels are therefore compiled for WebAssembly without changes
(`engine.integrator.jit.kernel_module`). A function with lanes runs its program for two lanes at a time;
`engine.integrator.jit.llvm_emitter` writes the program for vectors of two doubles.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from engine.foundations.cache_files import SUFFIX, cache_folder, read_or_make
from engine.integrator.jit.compiling_process import call_compiler
from engine.integrator.jit.source_digests import program_digest
from engine.integrator.source.recurrence import CodeOutline, Structure


def webassembly_module(outline: CodeOutline, section_outline: CodeOutline | None = None) -> bytes:
    """Return the functions of the potentials of one structure as a WebAssembly module, which imports its memory.

    The functions are those of `engine.integrator.jit.webassembly_object.FUNCTIONS`.

    The functions of `section_outline`, which count crossings of another section than y = 0, upward, replace those of `outline`.

    The functions have the arguments of Numba's calling convention. The number of lanes is rounded up to an even number, and rows
    must be long enough for this number. The module is read from the disk, or else compiled, which can take seconds.

    Raises
    ------
    ValueError
        If another process compiles and cannot; the message has the reason.
    """
    outlines = [outline] if section_outline is None else [outline, section_outline]
    digests = ".".join(each.digest[:24] for each in outlines)
    path = cache_folder() / f"{__name__}.{digests}.{program_digest()}{SUFFIX}"
    structures = tuple(each.structure for each in outlines)
    return read_or_make(path, "WebAssembly modules", partial(call_compiler, partial(_compile, structures)))


def _compile(structures: Sequence[Structure]) -> bytes:
    # Numba is imported where code is compiled, see `engine.integrator.jit.decorator`.
    from engine.integrator.jit.webassembly_writer import compile_functions

    return compile_functions(structures)
