"""After any sequence of actions, the page shows the state that its address describes: widgets, pictures and texts."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from typing import Any
from urllib.parse import parse_qsl, urlsplit

import pytest
from playwright.sync_api import TimeoutError as Late

from app.state.permalink import read_link
from app.state.presets import PRESETS
from app.state.view_state import ViewState
from app.views.components.analysis_choice import ANALYSIS_LABELS, LAYER_LABELS
from engine import CASES, Plane, compute_map
from plots.image_columns import map_columns
from tests.browser.explorer_page import ExplorerPage

OPENED = "?case=I&plane=x_px&h=0.19&t_max=100&resolution=112"
LINKS = (
    "?case=II&plane=x_y&h=0.3&t_max=100&resolution=112&orbits=0.1,0.2;0.2,0.1&look=2",
    "?case=III&plane=x_px&h=0.5&t_max=100&resolution=112&manifolds=yes&analysis=statistics",
    "?case=I&plane=x_h&t_max=100&resolution=112&palette=safe&lock_times=50",
)
# Only entries of the gallery whose maps take moments.
QUICK = [preset for preset in PRESETS if preset.t_max <= 1e4 and preset.case in CASES and preset.resolution <= 224]
ROUNDS = 20
"""A state may be replaced while it is read: by the last request of a gesture, or by a limit of the server."""

# What the page shows, and what has to be equal; the first difference, or null. The parts of shadow roots count.
_DIFFERENCE = """expected => {
    if (window.location.search !== expected.address) return "another address"
    const found = {}
    const walk = root => {
        for (const element of root.querySelectorAll("*")) {
            if (element.shadowRoot) walk(element.shadowRoot)
            if (!(element instanceof HTMLInputElement)) continue
            const label = (element.labels?.[0]?.innerText || element.getAttribute("aria-label") || "").trim()
            if (["radio", "checkbox"].includes(element.type)) found[label] = element.checked
            else if (label === "Exact h") found[label] = Number(element.value)
        }
    }
    walk(document)
    for (const [label, value] of Object.entries(expected.widgets))
        if (found[label] !== value) return `${label}: ${found[label]}`
    const model = name => Bokeh.documents[0].get_model_by_name(name)
    if (expected.picture) {
        const {fate, place} = expected.picture, {data} = model("maps")
        if (!data.complete[0]) return "the map is not complete"
        const pixels = [...data.fate[0]]
        if (pixels.length !== fate.length) return `${pixels.length} pixels`
        const wrong = pixels.filter((code, k) => code !== fate[k]).length
        if (wrong) return `${wrong} wrong pixels`
        for (const [name, value] of Object.entries(place))
            if (data[name][0] !== value) return `${name} of the map: ${data[name][0]}`
    }
    const starts = model("starts")?.data.x.length ?? 0
    if (starts !== expected.starts) return `${starts} starts are marked`
    const paths = model("paths")?.data.xs.length ?? 0
    if (paths !== expected.orbits) return `${paths} paths`
    return null
}"""


def expected_page(address: str) -> dict[str, Any]:
    """What the page has to show at an address."""
    query = urlsplit(address).query
    values, problems = read_link(dict(parse_qsl(query)))
    assert not problems, problems
    state = ViewState(**values)
    picture = expected_picture(state)
    layers = {label: bool(getattr(state, name)) for name, label in LAYER_LABELS.items()}
    analyses = {label: state.analysis is analysis for analysis, label in ANALYSIS_LABELS.items()}
    cases = {case: state.case == case for case in CASES}
    planes = {plane.value: state.plane is plane for plane in Plane}
    energy = {} if state.plane is Plane.X_H else {"Exact h": state.energy}
    orbits = [state.orbit_spec(start) for start in state.starts]
    return {
        "address": f"?{query}",
        "widgets": cases | planes | layers | analyses | energy,
        "picture": picture,
        "starts": len(state.starts),
        "orbits": sum(orbit is not None for orbit in orbits),
    }


def expected_picture(state: ViewState) -> dict[str, Any] | None:
    """Pixels and place of the map; None for a state without a map, in which the last picture stays."""
    try:
        columns = map_columns(compute_map(state.map_spec()))
    except ValueError:
        return None
    place = {name: columns[name][0] for name in ("x", "y", "dw", "dh")}
    return {"fate": columns["fate"][0].ravel().tolist(), "place": place}


def check_agreement(explorer: ExplorerPage, done: Sequence[str]) -> None:
    """Wait until the page shows the state of its address; the address may still change."""
    difference = ""
    for _ in range(ROUNDS):
        expected = expected_page(explorer.page.url)
        try:
            explorer.page.wait_for_function(f"expected => ({_DIFFERENCE})(expected) === null", arg=expected, timeout=5000)
            return
        except Late:
            difference = explorer.page.evaluate(_DIFFERENCE, expected)
    pytest.fail(f"after {' / '.join(done[-6:])}: {difference} at {explorer.page.url}")


def actions(explorer: ExplorerPage, chance: random.Random) -> Mapping[str, Callable[[], Any]]:
    """What a user does, by name."""
    page = explorer.page

    def move(steps: int) -> None:
        """Go through the browser's history, without leaving the page."""
        if page.evaluate("() => history.state?.entry ?? 0") + steps >= 0:
            page.evaluate("steps => history.go(steps)", steps)

    def click() -> None:
        x_low, x_high, low, high = explorer.ranges("basins")
        share = chance.uniform(0.3, 0.7), chance.uniform(0.3, 0.7)
        explorer.click("basins", x_low + share[0] * (x_high - x_low), low + share[1] * (high - low))

    def show_preset() -> None:
        preset = chance.choice(QUICK)
        explorer.press("Gallery")
        page.get_by_role("button", name=preset.title).first.click()
        explorer.press("Close")

    def type_energy() -> None:
        if page.get_by_label("Exact h", exact=True).is_enabled():
            explorer.type_number("Exact h", f"{chance.uniform(0.13, 0.5):.3f}")

    def clear() -> None:
        if explorer.button("Clear all").is_visible():
            explorer.press("Clear all")

    def key(name: str) -> Callable[[], None]:
        return lambda: page.keyboard.press(name)

    def switch(label: str) -> Callable[[], None]:
        return lambda: page.get_by_label(label, exact=True).click()

    plain = {f"case {case}": lambda case=case: explorer.pick(case) for case in CASES}
    plain |= {f"plane {plane.value}": lambda plane=plane: explorer.pick(plane.value) for plane in Plane}
    plain |= {f"layer {label}": switch(label) for label in LAYER_LABELS.values()}
    plain |= {f"analysis {label}": lambda label=label: explorer.pick(label) for label in ANALYSIS_LABELS.values()}
    plain |= {f"key {name}": key(name) for name in ("+", "-", "h", "ArrowLeft")}
    return plain | {
        "click": click, "clear": clear, "gallery": show_preset,
        "link": lambda: page.goto(page.url.split("?")[0] + chance.choice(LINKS)),
        "energy": type_energy, "drag": lambda: explorer.drag_energy_to(chance.uniform(0.2, 0.8)),
        "back": lambda: move(-1), "far back": lambda: move(-3), "forward": lambda: move(1),
    }  # fmt: skip


@pytest.mark.parametrize("count", [pytest.param(20, marks=pytest.mark.slow), pytest.param(200, marks=pytest.mark.exhaustive)])
def test_the_page_shows_the_state_of_its_address(open_explorer: Callable[..., ExplorerPage], count: int) -> None:
    chance = random.Random(count)
    explorer = open_explorer(link=OPENED)
    done: list[str] = []
    while len(done) < count:
        possible = actions(explorer, chance)
        # Some actions follow at once on others, some when the page is at rest.
        for name in chance.choices(list(possible), k=chance.randint(1, 3)):
            done.append(name)
            possible[name]()
        check_agreement(explorer, done)
