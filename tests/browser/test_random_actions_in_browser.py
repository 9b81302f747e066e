"""After any sequence of actions, the page shows the state that its address describes: widgets, pictures and texts."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any
from urllib.parse import parse_qsl, urlsplit

import pytest
from playwright.sync_api import TimeoutError as Late
from playwright.sync_api import expect

from app.state.permalink import preset_view
from app.state.view import Analysis
from app.state.view_state import ViewState
from app.views.panels.analysis_choice import ANALYSIS_LABELS
from engine import CASES, EscapeMap, Fate, MapSpec, Orbit, Plane, compute_map, compute_statistics, judge_orbit
from engine.foundations.execution import DEFAULT_EXECUTION
from engine.foundations.wording import format_share
from engine.jobs.job import Job, run_job
from plots.layers.table import LAYERS
from plots.links.presets import PRESETS
from plots.pictures.image_columns import map_columns
from plots.pictures.time_scale import fitted_scale
from plots.texts.typeset import typeset
from tests.app.state.opened_link import open_link
from tests.browser.explorer_page import ExplorerPage

OPENED = "?case=I&plane=x_px&h=0.19&t_max=100&resolution=112"
LINKS = (
    "?case=II&plane=x_y&h=0.3&t_max=100&resolution=112&orbits=0.1,0.2;0.2,0.1&look=2",
    "?case=III&plane=x_px&h=0.5&t_max=100&resolution=112&manifolds=yes&analysis=statistics",
    "?case=I&plane=x_h&t_max=100&resolution=112&palette=safe&lock_times=50",
)
# Entries of the gallery whose maps are computed in moments.
QUICK = [
    preset
    for preset in PRESETS
    if preset_view(preset).t_max <= 1e4 and preset_view(preset).system.case in CASES and preset_view(preset).resolution <= 224
]
ACTIONS, SEEDS = 50, range(200, 206)
ROUNDS = 20
"""Largest number of states through which the page passes after an action."""

POLL_MS = 100
PLANES = (Plane.X_Y, Plane.X_PX, Plane.X_H)
LEGEND, SHARES, VERDICT = ".legend, .legend [title]", "table[aria-label=statistics]", ".verdict"

# Returns the first difference between the page, including shadow roots, and the expected content; null if there is none.
_DIFFERENCE = """expected => {
    if (window.location.search !== expected.address) return "another address"
    const found = {}, texts = Object.fromEntries(Object.keys(expected.texts).map(place => [place, ""]))
    const walk = root => {
        for (const element of root.querySelectorAll("*")) {
            if (element.shadowRoot) walk(element.shadowRoot)
            const text = `${element.title} ${element.textContent} ${element.shadowRoot?.textContent ?? ""} `
            for (const place in texts) if (element.matches(place)) texts[place] += text
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
    for (const [place, parts] of Object.entries(expected.texts))
        for (const part of parts) if (!texts[place].includes(part)) return `no "${part}" in ${place}: ${texts[place]}`
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

# Goes some steps through the history of the page, and waits until the entry is reached or another entry replaces it.
_GO = """steps => {
    const target = navigation.entries()[navigation.currentEntry.index + steps]
    if (target?.sameDocument) return navigation.traverseTo(target.key).finished.then(() => null, () => null)
}"""

# True for `wait_for_function` when the page agrees with the expected content, or its address has changed.
_AGREEMENT = f"""expected => {{
    const difference = ({_DIFFERENCE})(expected)
    return [null, "another address"].includes(difference) && {{agrees: difference === null}}
}}"""


@dataclass(frozen=True)
class Shown:
    """The complete map of a state and the chosen orbit; None if there is none."""

    frame: EscapeMap | None
    orbit: Orbit | None


def shown_in(state: ViewState) -> Shown:
    """Return what the page has to show. A state without a map leaves the last map on the page."""
    job = None if state.chosen_start is None else state.orbit_job(state.chosen_start)
    orbit = None if job is None else computed_orbit(job)
    try:
        return Shown(computed_map(state.map_spec()), orbit)
    except ValueError:
        return Shown(None, orbit)


@lru_cache(maxsize=100)
def computed_map(spec: MapSpec) -> EscapeMap:
    return compute_map(spec)


@lru_cache(maxsize=100)
def computed_orbit(job: Job[Orbit]) -> Orbit:
    return run_job(job, DEFAULT_EXECUTION, {})


def expected_page(address: str) -> dict[str, Any]:
    """Return what the page has to show at an address."""
    query = urlsplit(address).query
    state, problems = open_link(dict(parse_qsl(query)))
    assert not problems, problems
    shown = shown_in(state)
    layers = {layer.title: name in state.layers for name, layer in LAYERS.items()}
    analyses = {label: state.analysis == analysis for analysis, label in ANALYSIS_LABELS.items()}
    cases = {case: state.system.case == case for case in CASES}
    planes = {plane.title: state.plane is plane for plane in PLANES}
    energy = {} if state.plane.energy_axis is not None else {"Exact h": state.energy}
    jobs = [job for start in state.starts if (job := state.orbit_job(start)) is not None]
    # The picture of the well shows orbits only if their potential is that of the chosen orbit.
    well = None if shown.orbit is None else shown.orbit.potential
    return {
        "address": f"?{query}",
        "widgets": cases | planes | layers | analyses | energy,
        "picture": None if shown.frame is None else expected_picture(shown.frame),
        "texts": expected_texts(state, shown),
        "starts": len(state.starts),
        "orbits": sum(well in (None, computed_orbit(job).potential) for job in jobs),
    }


def expected_picture(frame: EscapeMap) -> dict[str, Any]:
    """Return the pixels and the window of the map."""
    columns = map_columns(frame)
    place = {name: columns[name][0] for name in ("x", "y", "dw", "dh")}
    return {"fate": columns["fate"][0].ravel().tolist(), "place": place}


def expected_texts(state: ViewState, shown: Shown) -> dict[str, list[str]]:
    """Return parts of the legend, of the table of shares and of the verdict, by the selector of their place."""
    texts: dict[str, list[str]] = {}
    if shown.frame is not None:
        channels = [f"exit {k + 1}" for k in range(state.potential.channels)]
        layers = {"bounded and chaotic": "judge" in state.layers, "tones: from": "origins" in state.layers}
        times = state.lock_times or fitted_scale(shown.frame)
        texts[LEGEND] = [typeset(f"≤ {times.low:g}"), *channels, *(name for name, is_on in layers.items() if is_on)]
    if shown.frame is not None and state.analysis == Analysis.STATISTICS:
        statistics = compute_statistics(shown.frame, state.box)
        texts[SHARES] = [typeset(format_share(share, 2)) for fate, share in statistics.shares.items() if fate >= Fate.BOUNDED]
    # The description of a bounded orbit depends on indicators that follow later.
    if shown.orbit is not None and shown.orbit.fate > Fate.BOUNDED and state.analysis == Analysis.ORBIT:
        texts[VERDICT] = [typeset(judge_orbit(shown.orbit).headline())]
    return texts


def check_agreement(explorer: ExplorerPage, done: Sequence[str]) -> None:
    """Wait until the page shows the state of its address, which may still change."""
    page = explorer.page
    for _ in range(ROUNDS):
        expected = expected_page(page.evaluate("() => window.location.href"))
        try:
            if page.wait_for_function(_AGREEMENT, arg=expected, polling=POLL_MS).evaluate("result => result.agrees"):
                return
        except Late:
            break
    pytest.fail(f"after {' / '.join(done[-6:])}: {page.evaluate(_DIFFERENCE, expected)} at {page.url}")


def actions(explorer: ExplorerPage, chance: random.Random) -> Mapping[str, Callable[[], Any]]:
    """Return the actions of a user, by name."""
    page = explorer.page

    def move(steps: int) -> None:
        """Go through the browser's history, without leaving the page."""
        page.evaluate(_GO, steps)

    def click() -> None:
        x_low, x_high, low, high = explorer.ranges("basins")
        share = chance.uniform(0.3, 0.7), chance.uniform(0.3, 0.7)
        explorer.click("basins", x_low + share[0] * (x_high - x_low), low + share[1] * (high - low))

    def show_preset() -> None:
        preset = chance.choice(QUICK)
        explorer.press("Gallery")
        page.locator(".gallery:not(.few)").get_by_role("button", name=preset.title).first.click()
        explorer.press("Close")
        # If the next action pressed the button of the drawer while the drawer is still open, it would only close it.
        expect(explorer.button("Close")).to_be_hidden()

    def type_energy() -> None:
        if page.get_by_label("Exact h", exact=True).is_enabled():
            explorer.type_number("Exact h", f"{chance.uniform(0.13, 0.5):.3f}")
            # Leave the box, in which keys are text.
            page.keyboard.press("Tab")

    def clear() -> None:
        if explorer.button("Clear all").is_visible():
            explorer.press("Clear all")

    def key(name: str) -> Callable[[], None]:
        return lambda: page.keyboard.press(name)

    def switch(label: str) -> Callable[[], None]:
        return lambda: page.get_by_role("checkbox", name=label, exact=True).click()

    plain = {f"case {case}": lambda case=case: explorer.pick(case) for case in CASES}
    plain |= {f"plane {plane.title}": lambda plane=plane: explorer.pick(plane.title) for plane in PLANES}
    plain |= {f"layer {layer.title}": switch(layer.title) for layer in LAYERS.values()}
    plain |= {f"analysis {label}": lambda label=label: explorer.pick(label) for label in ANALYSIS_LABELS.values()}
    plain |= {f"key {name}": key(name) for name in ("+", "-", "h", "ArrowLeft")}
    return plain | {
        "click": click, "clear": clear, "gallery": show_preset,
        "link": lambda: page.goto(page.url.split("?")[0] + chance.choice(LINKS)),
        "energy": type_energy, "drag": lambda: explorer.drag_energy_to(chance.uniform(0.2, 0.8)),
        "back": lambda: move(-1), "far back": lambda: move(-3), "forward": lambda: move(1),
    }  # fmt: skip


@pytest.mark.parametrize(
    "seed",
    [pytest.param(SEEDS[0], marks=pytest.mark.slow), *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in SEEDS[1:])],
)
def test_the_page_shows_the_state_of_its_address(open_explorer: Callable[..., ExplorerPage], seed: int) -> None:
    chance = random.Random(seed)
    explorer = open_explorer(link=OPENED)
    done: list[str] = []
    while len(done) < ACTIONS:
        possible = actions(explorer, chance)
        # Up to three actions follow at once on one another. The next begin when the page is at rest.
        for name in chance.choices(list(possible), k=chance.randint(1, 3)):
            done.append(name)
            possible[name]()
        check_agreement(explorer, done)
