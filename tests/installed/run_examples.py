"""Compare the examples of docstrings and of the pages given as arguments with what the installed library prints.

Run this in a folder from which the repository cannot be imported: python -W error run_examples.py README.md
"""

from __future__ import annotations

import doctest
import inspect
import sys

import escape_explorer


def main(pages: list[str]) -> int:
    """Run the examples; return 1 if an example prints something else."""
    runner, finder = doctest.DocTestRunner(), doctest.DocTestFinder(recurse=False)
    for name in escape_explorer.__all__:
        for test in finder.find(inspect.unwrap(getattr(escape_explorer, name)), name):
            runner.run(test)
    failed, attempted = runner.summarize()
    for page in pages:
        of_page = doctest.testfile(page, module_relative=False)
        failed, attempted = failed + of_page.failed, attempted + of_page.attempted
    print(f"{attempted} examples of {escape_explorer.__file__}, {failed} failed")
    return 1 if failed or not attempted else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
