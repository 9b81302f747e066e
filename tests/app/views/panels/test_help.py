"""The table of the page is updated while it is open."""

from __future__ import annotations

from app.job_clients.orbit_requests import StartOrbit
from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.panels.help import AccessibleTable, help_panes
from engine import CASES, MapSpec, Plane, System, compute_map
from tests.disc import disc_map


def test_help_begins_with_the_tour_and_the_meaning_of_the_pictures_and_ends_with_the_keys() -> None:
    tours: list[str] = []
    tour, first, *_, last = help_panes(ViewState(), ShownResults(), lambda: tours.append("begun"))
    assert tour.label == "Take the tour"
    tour.clicks += 1
    assert tours == ["begun"]
    assert first.object.startswith("<h3>How to read the pictures</h3><p><b>The well.</b> The zero-velocity curve")
    assert first.object.count("<p>") == 4
    assert last.object.startswith("<h3>Keys</h3>")


def test_the_table_is_written_while_it_is_open() -> None:
    results = ShownResults()
    table = AccessibleTable(ViewState(system=System("I"), energy=0.19), results)
    results.orbits = (StartOrbit((0.1, 0.1)),)
    assert table.text.object == ""
    table.fold.button.clicks += 1
    assert "Case I" in table.text.object
    assert "exit 1" not in table.text.object
    results.frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (15, 15), t_max=100.0))
    assert "escape through exit 1" in table.text.object
    table.fold.button.clicks += 1
    results.frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.25, (15, 15), t_max=100.0))
    assert "exit 3" not in table.text.object
    table.fold.button.clicks += 1
    assert "escape through exit 3" in table.text.object


def test_a_map_without_escapes_has_no_times() -> None:
    results = ShownResults()
    table = AccessibleTable(ViewState(system=System("I"), energy=0.1), results)
    table.fold.button.clicks += 1
    results.frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.1, (15, 15), t_max=100.0))
    assert "nothing escaped" in table.text.object
    assert "nan" not in table.text.object


def test_collisions_have_a_row() -> None:
    results = ShownResults()
    table = AccessibleTable(ViewState(system=System("I"), energy=0.19), results)
    table.fold.button.clicks += 1
    results.frame = disc_map()
    assert "<th scope=row>collide with a disc</th>" in table.text.object
