"""Compare the engine with own integrations, on examples and random formulas.

Run: uv run python -m tests.referee --formulas 2000 --energies 3 --seed 1 --jobs 2

Prints the numbers of compared, undecided, refused and wrong answers, and writes the wrong ones to a file, a line of JSON each.
The seed is that of the first formula. ``--checks fates,images`` runs some checks only.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

from tests.referee.checks import CHECKS
from tests.referee.report import Report
from tests.referee.runner import SECONDS, example_tasks, random_tasks, run_tasks


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--formulas", type=int, default=100, help="number of random formulas")
    parser.add_argument("--energies", type=int, default=1, help="energies of each formula")
    parser.add_argument("--seed", type=int, default=1, help="seed of the first formula")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="longest processor time for a formula")
    parser.add_argument("--checks", default=",".join(CHECKS), help=f"of {', '.join(CHECKS)}")
    parser.add_argument("--no-examples", action="store_true", help="random formulas only")
    parser.add_argument("--wrong", type=Path, default=Path("wrong.jsonl"), help="file of the wrong answers")
    options = parser.parse_args()
    checks = tuple(options.checks.split(","))
    tasks = [] if options.no_examples else example_tasks(checks)
    tasks += random_tasks(range(options.seed, options.seed + options.formulas), options.energies, checks)
    total, begin = Report(), time.monotonic()
    with options.wrong.open("w") as file:
        for task, report in run_tasks(tasks, options.jobs, options.seconds):
            total.merge(report)
            file.writelines(json.dumps(finding, default=float) + "\n" for finding in report.wrong)
            file.flush()
            print(f"{time.monotonic() - begin:6.0f} s  {len(report.wrong):3} wrong  {task.name}", file=sys.stderr, flush=True)
    print(total.describe())
    return int(bool(total.wrong))


if __name__ == "__main__":
    sys.exit(main())
