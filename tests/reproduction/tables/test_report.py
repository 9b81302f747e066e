"""The report counts agreements, lists differences and states its quality."""

from __future__ import annotations

import csv
import io
from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, MapSpec, Plane
from reproduction.map_cache import MapCache
from reproduction.notation import write_rows
from reproduction.numbers.comparisons import Comparison, compare_all
from reproduction.numbers.stated_numbers import Counting, Quantity, Relation, StatedNumber
from reproduction.paper_ranges import nine_energies
from reproduction.quality import Quality
from reproduction.super_sticky import SuperStickySearch
from reproduction.tables.late_sections import write_late_escapes
from reproduction.tables.report import describe_verdict, write_report, write_table

SMALL = Quality(
    "small", resolution=16, t_max=300.0, curve_points=7, search_resolution=9,
    search_t_max=400.0, classified_resolution=10, exponent_work=1e4,
)  # fmt: skip
HALF = StatedNumber("I", Plane.X_PX, (0.3, 0.5), "high", Quantity.ESCAPED_BY, Relation.ABOUT, 60.0, (1,))
IN_A_WINDOW = replace(HALF, case="II", energies=(0.5,), counting=Counting.WINDOW, value=70.0)
SADDLE = StatedNumber("III", None, (), "", Quantity.ESCAPE_ENERGY, Relation.EXACTLY, 0.25)


def make_search() -> SuperStickySearch:
    spec = MapSpec(CASES["III"], Plane.X_PX, 0.26, (9, 9))
    fate, times, zeros = np.array([2, 0], np.int8), np.array([8.2e5, np.nan]), np.zeros(2)
    return SuperStickySearch(spec, 40, zeros, zeros, np.zeros((2, 4)), fate, times, np.array([7, 9]), True, t_max=4e6)


def test_the_summary_counts_agreements_and_lists_differences() -> None:
    rows = [Comparison(HALF, (61.0, 59.0)), Comparison(HALF, (61.0, 55.0), reason="Because."), Comparison(SADDLE, (0.25,))]
    verdict = describe_verdict(rows)
    assert "**Of the 2 percentages that do not depend on a window, 1 agree within 2 percentage points.**" in verdict
    assert "Of the 1 other numbers, 1 agree within 2 %." in verdict
    assert "- I, (x, px), h high: escape through 1: about 60 % stated, 55.0 to 61.0 % computed. Because." in verdict


def test_the_table_has_one_line_per_energy() -> None:
    rows = compare_all(MapCache(SMALL), make_search(), (HALF, IN_A_WINDOW, SADDLE))
    lines = list(csv.DictReader(io.StringIO(write_table(rows))))
    assert [(line["case"], line["h"]) for line in lines] == [("I", "0.3"), ("I", "0.5"), ("II", "0.5"), ("III", "")]
    assert float(lines[1]["computed"]) == pytest.approx(rows[0].computed[1], rel=1e-5)
    assert float(lines[2]["half_side"]) == rows[1].windows[0].half_side
    assert float(lines[2]["counted"]) == pytest.approx(rows[1].counted_shares[0], rel=1e-5)
    assert [line["half_side"] for line in lines if line["case"] != "II"] == ["", "", ""]


def test_the_report_states_its_quality_and_has_every_section() -> None:
    cache, search = MapCache(SMALL), make_search()
    rows = compare_all(cache, search, (replace(HALF, derivation="the rest to 100"), IN_A_WINDOW, SADDLE))
    page = write_report(cache, search, rows)
    assert "at small quality: 16 × 16 starts per map, integrated to t = 300;" in " ".join(page.split())
    headings = [line for line in page.splitlines() if line.startswith("## ")]
    assert headings == [
        "## Summary",
        "## Case I: 2 channels",
        "## Case II: 3 channels",
        "## Case III: 4 channels",
        "## Fits",
        "## Late escapes",
        "## Chaotic bounded orbits",
        "## Super-sticky orbits",
        "## Open points of the paper",
    ]
    assert "| I, Ne/N0 | a | 30 |" in page
    assert "| about 60 % (derived: the rest to 100) |" in page
    assert "| 820000 | 2 | 7 |" in page
    assert "1 have not escaped by then" in page


def test_late_escapes_are_counted_at_each_energy_with_bounded_starts() -> None:
    cache = MapCache(SMALL)
    counts = [cache.late_escapes("I", h) for h in nine_energies("I")]
    rows = [line.split(" | ") for line in write_late_escapes(cache).splitlines() if line.startswith("| I |")]
    assert [(row[2], row[3], row[5]) for row in rows] == [
        (str(s.bounded_count), str(s.fate.size), str(s.escapers.size)) for s in counts if s.bounded_count
    ]


def test_bars_in_cells_are_escaped() -> None:
    table = write_rows(("a", "b"), [("|x|", "1"), ("", "2")])
    assert table.splitlines() == ["| a | b |", "| --- | --- |", "| \\|x\\| | 1 |", "|  | 2 |"]
