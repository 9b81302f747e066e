"""Count what was compared, and keep wrong answers with what is needed to reproduce them."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

COMPARED, UNDECIDED, REFUSED, WRONG, TOO_LONG = "compared", "undecided", "refused", "wrong", "too long"


@dataclass
class Report:
    """Counts by (check, result, reason), and wrong answers as plain values."""

    counts: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    wrong: list[dict[str, Any]] = field(default_factory=list)

    def add(self, check: str, result: str, reason: str = "", number: int = 1) -> None:
        if number:
            self.counts[check, result, _without_numbers(reason)] += number

    def add_wrong(self, check: str, kind: str, **reproduction: Any) -> None:
        self.counts[check, WRONG, kind] += 1
        self.wrong.append({"check": check, "kind": kind, **reproduction})

    def judge(self, check: str, kind: str, right: bool, **reproduction: Any) -> None:
        """Count a comparison, and keep it if the answer is wrong."""
        self.add(check, COMPARED)
        if not right:
            self.add_wrong(check, kind, **reproduction)

    def merge(self, other: Report) -> None:
        self.counts.update(other.counts)
        self.wrong += other.wrong

    def describe(self) -> str:
        """Return a line for each check and result, and below it the reasons, the most frequent first."""
        totals: Counter[tuple[str, str]] = Counter()
        for (check, result, _), number in self.counts.items():
            totals[check, result] += number
        lines = []
        for (check, result), total in sorted(totals.items()):
            lines.append(f"{check:12} {result:10} {total:7}")
            reasons = [(n, why) for (c, r, why), n in self.counts.items() if (c, r) == (check, result) and why]
            lines += [f"{'':12} {'':10} {n:7}  {why}" for n, why in sorted(reasons, reverse=True)]
        return "\n".join(lines)


def _without_numbers(reason: str) -> str:
    """Return a reason in which numbers and formulas in brackets at the end do not distinguish it from equal reasons."""
    reason = re.sub(r"\(potential .*\)$", "", reason)
    return re.sub(r"[-−+]?\d+(\.\d+)?(e[-+]?\d+)?", "#", reason).strip()[:160]
