"""The audit for known vulnerabilities fails when it finds some, and when it could audit nothing."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.skipif(os.name != "posix", reason="the program in its place is a script with a shebang")
AUDIT = Path(__file__).parents[1] / ".ci" / "audit"
SOUND = {"name": "numpy", "version": "2.0", "vulns": []}
FLAWED = {"name": "tornado", "version": "1.0", "vulns": [{"id": "CVE-1"}]}
SKIPPED = {"name": "numba", "skip_reason": "not found"}


@pytest.mark.parametrize(
    ("packages", "code", "said"),
    [
        ([SOUND], 0, "0 known vulnerabilities in 1 audited packages"),
        ([SOUND, SKIPPED], 0, "WARNING: not all packages were audited"),
        ([SOUND, FLAWED], 1, "tornado 1.0: CVE-1"),
        ([SKIPPED], 2, "in 0 audited packages"),
        (None, 2, "in 0 audited packages"),
    ],
    ids=["sound", "one not audited", "a vulnerability", "none audited", "no answer"],
)
def test_the_audit_fails_if_it_finds_a_vulnerability_or_audits_nothing(
    packages: list[Any] | None, code: int, said: str, tmp_path: Path
) -> None:
    output = "" if packages is None else json.dumps({"dependencies": packages})
    program = tmp_path / "pip-audit"
    program.write_text(f"#!{sys.executable}\nprint({output!r})\n")
    program.chmod(0o755)
    run = subprocess.run([sys.executable, AUDIT], env={"PATH": str(tmp_path)}, capture_output=True, text=True, check=False)
    assert (run.returncode, said in run.stdout) == (code, True), run


def test_without_pip_audit_nothing_is_audited(tmp_path: Path) -> None:
    run = subprocess.run([sys.executable, AUDIT], env={"PATH": str(tmp_path)}, capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr, "pip-audit is not installed" in run.stdout) == (2, "", True), run
