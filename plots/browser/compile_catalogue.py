"""Make the files of `plots.browser.compiled_files`: kernels, and systems of the catalogue with crossings of y = 0, upward.

Run after each change of the kernels or of the catalogue: uv run python -m plots.browser.compile_catalogue
"""

from __future__ import annotations

from engine import System
from engine.foundations.execution import DEFAULT_EXECUTION
from engine.integrator.portable_kernels import kernel_module
from engine.systems.catalogue.table import CATALOGUE
from engine.systems.review.potential_review import review_system
from plots.browser.browser_system import compile_browser_system, file_name
from plots.browser.compiled_files import KERNELS, write_compiled


def main() -> None:
    """Compile everything, and replace the files."""
    contents = {KERNELS: kernel_module()}
    for name in CATALOGUE:
        review = review_system(System(name))
        definition = review.potential, review.energies.low, review.energies.high
        contents[file_name(*definition)] = compile_browser_system(*definition, execution=DEFAULT_EXECUTION).content
    write_compiled(contents)


if __name__ == "__main__":
    main()
