"""The actions of attackers in `benchmarks.hostile`. Each way to keep the server busy is an entry of `ATTACKS`."""

from __future__ import annotations

import asyncio
import functools
import importlib.util
import itertools
import pkgutil
import random
import time
from collections.abc import AsyncGenerator, Callable
from contextlib import aclosing
from urllib.parse import quote, urlencode

from bokeh.core.types import ID
from bokeh.util.token import generate_jwt_token

from benchmarks.simulated_sessions import SimulatedSession
from tests.fuzz.random_formulas import random_link

# Link to the map that takes longest, with all layers.
_WORST_MAP = "?case=III&h=0.3&plane=x_px&t_max=1000000&resolution=900&judge=yes&trust=yes&manifolds=yes&origins=yes"
# Seconds between requests that follow one another.
_REQUEST_PAUSE = 0.05
# Number of pages that `read_nothing` opens.
_SLOW_PAGES = 10
# Seconds for each attack when all follow one another.
_TURN_SECONDS = 15.0

Attack = Callable[[SimulatedSession, random.Random], AsyncGenerator[None]]
"""The actions of an attacker. Each step is one action and the pause after it."""


async def do_nothing(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Do nothing, for comparison."""
    while True:
        await asyncio.sleep(1.0)
        yield


async def compute_worst_map(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Request the map that takes longest at slightly different energies, so that no result is cached."""
    for number in itertools.count():
        visitor.follow_link(_WORST_MAP.replace("h=0.3", f"h={0.3 + 1e-6 * number!r}"))
        await asyncio.sleep(10.0)
        yield


async def sweep_energies(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Request curves against energy, with the largest map in view."""
    for case in itertools.cycle(["III", "II", "I"]):
        visitor.follow_link(f"?case={case}&resolution=900&t_max=1000000&analysis=energies")
        await asyncio.sleep(2.0)
        visitor.press("Compute the curves")
        await asyncio.sleep(13.0)
        yield


async def type_potentials(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Follow a link to a potential of new powers each second, so that an integrator must be compiled."""
    while True:
        powers = [(i, degree - i) for degree in range(3, 9) for i in range(degree + 1)]
        terms = " + ".join(f"{choice.uniform(-0.2, 0.2):.3f}*x^{i}*y^{j}" for i, j in choice.sample(powers, 6))
        visitor.follow_link(f"?case=typed&V={quote(f'x^2/2 + y^2/2 - x^3/3 + {terms}')}&resolution=112")
        await asyncio.sleep(1.0)
        yield


async def open_formulas(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Open pages with formulas of every kind, one after another."""
    while True:
        await visitor.open_formula(formula_link(choice))
        await asyncio.sleep(_REQUEST_PAUSE if visitor.is_open else 1.0)
        yield


async def follow_formulas(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Follow links with formulas of every kind in one page."""
    while True:
        await visitor.follow_formula(formula_link(choice))
        yield


async def type_formulas(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Type formulas of every kind in one page."""
    while True:
        await visitor.type_formula(random_link(choice)["V"])
        yield


async def click(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Click twenty long orbits a second, and remove them when there are five."""
    for number in itertools.count():
        if number % 5 == 0:
            visitor.follow_link("?case=III&h=0.3&t_max=1000000&resolution=112")
        visitor.click(choice.uniform(-0.3, 0.3), choice.uniform(-0.3, 0.3))
        await asyncio.sleep(0.05)
        yield


async def flip_choices(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Change resolution and colours as fast as messages are accepted."""
    for resolution, palette in itertools.cycle(itertools.product((112, 224, 450, 900), ("paper", "safe"))):
        visitor.follow_link(f"?case=III&h=0.3&resolution={resolution}&palette={palette}")
        await asyncio.sleep(0.005)
        yield


async def link_to_radial_potentials(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Open pages with a radial potential of new coefficients, one after another."""
    while True:
        powers = "".join(f"{sign}{choice.uniform(0.5, 1.5):.6f}*r^{2 * n}" for n, sign in zip(range(2, 7), "-+-+-", strict=True))
        await visitor.fetch(f"/app?case=typed&V={quote(f'r^2/2{powers}')}")
        await asyncio.sleep(_REQUEST_PAUSE)
        yield


async def name_modules(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Request a resource of a component in each module of large packages. The page needs few of these modules."""
    names = _module_names()
    choice.shuffle(names)
    for name in itertools.cycle(names):
        await visitor.fetch(f"/components/{name}/Component/__css__/file.css")
        await asyncio.sleep(_REQUEST_PAUSE)
        yield


async def send_zlib_bombs(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Open WebSockets with a token of 53 kB, close to the limit of a header, that decompresses to 30 MB."""
    token = await asyncio.to_thread(_large_token)
    while True:
        await visitor.connect(token)
        await asyncio.sleep(_REQUEST_PAUSE)
        yield


async def drop_sessions(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Open pages and close their connections at once."""
    while True:
        await visitor.drop()
        await asyncio.sleep(_REQUEST_PAUSE)
        yield


async def read_nothing(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Open pages that ask for maps and do not read them."""
    pages = [visitor.another() for _ in range(_SLOW_PAGES)]
    for page in pages:
        await page.open()
    opened = [page for page in pages if page.is_open]
    for page in opened:
        await page.stop_reading()
    try:
        while True:
            for page in opened:
                page.follow_link(f"?case=III&resolution=450&h={choice.uniform(0.4, 0.9):.6f}")
            await asyncio.sleep(2.0)
            yield
    finally:
        for page in opened:
            await page.close()


async def do_everything(visitor: SimulatedSession, choice: random.Random) -> AsyncGenerator[None]:
    """Make all attacks in turn, without a pause."""
    for name in itertools.cycle(name for name, attack in ATTACKS.items() if attack not in (do_nothing, do_everything)):
        end = time.perf_counter() + _TURN_SECONDS
        async with aclosing(ATTACKS[name](visitor, choice)) as actions:
            async for _ in actions:
                yield
                if time.perf_counter() > end:
                    break


def formula_link(choice: random.Random) -> str:
    """Return a link to a small and short map of a formula of a random kind."""
    return "?" + urlencode({"case": "typed", "resolution": "112", "t_max": "100", **random_link(choice)}, errors="replace")


def _module_names() -> list[str]:
    """Return the names of all modules of the packages, without importing them."""
    specs = [importlib.util.find_spec(package) for package in ("bokeh", "matplotlib", "numba", "panel", "scipy", "tornado")]
    folders = [(list(spec.submodule_search_locations or ()), spec.name) for spec in specs if spec is not None]
    return [module.name for paths, package in folders for module in pkgutil.iter_modules(paths, f"{package}.")]


@functools.cache
def _large_token() -> str:
    return generate_jwt_token(ID("attack"), extra_payload={"zeros": "0" * 30_000_000})


ATTACKS: dict[str, Attack] = {
    "nothing": do_nothing,
    "largest map, all layers": compute_worst_map,
    "against energy": sweep_energies,
    "a new potential each second": type_potentials,
    "pages of formulas": open_formulas,
    "links to formulas": follow_formulas,
    "typed formulas": type_formulas,
    "clicks": click,
    "resolution and colours": flip_choices,
    "links to radial potentials": link_to_radial_potentials,
    "resources of any module": name_modules,
    "compressed tokens": send_zlib_bombs,
    "sessions opened and dropped": drop_sessions,
    "slow readers": read_nothing,
    "everything": do_everything,
}
