"""Waits of one visitor while another one keeps the server as busy as the page allows, in several ways.

Run: uv run python -m benchmarks.hostile --seconds 60
     uv run python -m benchmarks.hostile --seconds 60 --processes 2
     uv run python -m benchmarks.hostile --seconds 60 --proxy

Each process has a visitor of either kind. With ``--proxy`` there are two processes behind nginx with `deploy/nginx.conf`, and
the cookies of the visitors choose the process.
"""

from __future__ import annotations

import argparse
import asyncio
import itertools
import random
import sys
import tempfile
import time
from collections.abc import AsyncIterator, Callable, Iterator, Sequence
from contextlib import ExitStack, asynccontextmanager, contextmanager, suppress
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote, urlsplit

from benchmarks.load import Server, served, summary
from benchmarks.simulated_sessions import NO_OPTIONS, Options, Record, SimulatedSession
from tests.deploy.proxy import Proxy, authorization, free_port, nginx, proxied

LONGEST_WAIT_SECONDS = 3.0
"""Longest permitted time to the first frame of the other visitor's map."""

REST_SECONDS = 5.0
"""Between two attacks."""

_WORST_MAP = "?case=III&h=0.3&plane=x_px&t_max=1000000&resolution=900&judge=yes&trust=yes&manifolds=yes&origins=yes"

Attack = Callable[[SimulatedSession, random.Random], AsyncIterator[None]]
"""The actions of a visitor; each step is one action, and the pause after it."""


async def do_nothing(visitor: SimulatedSession, choice: random.Random) -> AsyncIterator[None]:
    """For comparison."""
    while True:
        await asyncio.sleep(1.0)
        yield


async def compute_worst_map(visitor: SimulatedSession, choice: random.Random) -> AsyncIterator[None]:
    """The map that takes longest, with all layers, at slightly different energies."""
    for number in itertools.count():
        visitor.follow_link(_WORST_MAP.replace("h=0.3", f"h={0.3 + 1e-6 * number!r}"))
        await asyncio.sleep(10.0)
        yield


async def sweep_energies(visitor: SimulatedSession, choice: random.Random) -> AsyncIterator[None]:
    """Curves against energy, with the largest map in view."""
    for case in itertools.cycle(["III", "II", "I"]):
        visitor.follow_link(f"?case={case}&resolution=900&t_max=1000000&analysis=energies")
        await asyncio.sleep(2.0)
        visitor.press("Compute the curves")
        await asyncio.sleep(13.0)
        yield


async def type_potentials(visitor: SimulatedSession, choice: random.Random) -> AsyncIterator[None]:
    """A potential of new powers each second, so that its integrator must be compiled."""
    while True:
        powers = [(i, degree - i) for degree in range(3, 9) for i in range(degree + 1)]
        terms = " + ".join(f"{choice.uniform(-0.2, 0.2):.3f}*x^{i}*y^{j}" for i, j in choice.sample(powers, 6))
        visitor.follow_link(f"?case=typed&V={quote(f'x^2/2 + y^2/2 - x^3/3 + {terms}')}&resolution=112")
        await asyncio.sleep(1.0)
        yield


async def click(visitor: SimulatedSession, choice: random.Random) -> AsyncIterator[None]:
    """Twenty clicks a second on long orbits, removed when there are five."""
    for number in itertools.count():
        if number % 5 == 0:
            visitor.follow_link("?case=III&h=0.3&t_max=1000000&resolution=112")
        visitor.click(choice.uniform(-0.3, 0.3), choice.uniform(-0.3, 0.3))
        await asyncio.sleep(0.05)
        yield


async def flip_choices(visitor: SimulatedSession, choice: random.Random) -> AsyncIterator[None]:
    """Resolution and colours, as fast as messages are accepted."""
    for resolution, palette in itertools.cycle(itertools.product((112, 224, 450, 900), ("paper", "safe"))):
        visitor.follow_link(f"?case=III&h=0.3&resolution={resolution}&palette={palette}")
        await asyncio.sleep(0.005)
        yield


ATTACKS: dict[str, Attack] = {
    "nothing": do_nothing,
    "largest map, all layers": compute_worst_map,
    "against energy": sweep_energies,
    "a new potential each second": type_potentials,
    "clicks": click,
    "resolution and colours": flip_choices,
}


class Place(NamedTuple):
    """Where a page is found: its address, and options of requests that reach one process."""

    address: str
    options: Options = NO_OPTIONS


@asynccontextmanager
async def visiting(place: Place, seed: int, record: Record) -> AsyncIterator[SimulatedSession]:
    """A session with its page open."""
    session = SimulatedSession(place.address, seed, record, place.options)
    await session.open()
    try:
        yield session
    finally:
        await session.close()


async def attack(places: Sequence[Place], name: str, seconds: float, seed: int) -> Record:
    """The waits of one visitor of each process while another one attacks it."""
    record, ignored = Record(), Record()

    async def run_attack(place: Place, number: int) -> None:
        async with visiting(place, seed + 100 + number, ignored) as visitor:
            async for _ in ATTACKS[name](visitor, random.Random(seed + number)):
                # A refused visitor comes back, as a person would.
                if not visitor.is_open:
                    await visitor.open()

    loop = asyncio.get_running_loop()
    tasks = [loop.create_task(run_attack(place, number)) for number, place in enumerate(places)]
    await asyncio.sleep(1.0)
    try:
        async with asyncio.TaskGroup() as group:
            for number, place in enumerate(places):
                group.create_task(_visit(place, seed + number, record, time.perf_counter() + seconds))
    finally:
        for task in tasks:
            task.cancel()
        for task in tasks:
            with suppress(asyncio.CancelledError):
                await task
    await asyncio.sleep(REST_SECONDS)
    return record


async def _visit(place: Place, seed: int, record: Record, end: float) -> None:
    async with visiting(place, seed, record) as visitor:
        await visitor.run(end)


@contextmanager
def behind_proxy(servers: Sequence[Server], folder: Path) -> Iterator[list[Place]]:
    """Run nginx in front of two servers; one place for each of them."""
    program = nginx()
    if program is None:
        raise RuntimeError("nginx is not installed")
    first, second = (urlsplit(server.address).port or 0 for server in servers)
    with proxied(program, folder, free_port(), (first, second)) as proxy:
        yield asyncio.run(_find_places(proxy, servers))


async def _find_places(proxy: Proxy, servers: Sequence[Server]) -> list[Place]:
    found: dict[int, Place] = {}
    for number in itertools.count():
        headers = {**authorization(), "Cookie": f"explorer_visitor={number}"}
        place = Place(f"{proxy.origin}/app", {"headers": headers, "ssl_options": proxy.ssl_context()})
        async with visiting(place, number, Record()):
            found |= {index: place for index, server in enumerate(servers) if await asyncio.to_thread(server.sessions)}
        while sum([await asyncio.to_thread(server.sessions) for server in servers]):
            await asyncio.sleep(0.1)
        if len(found) == len(servers):
            break
    return list(found.values())


def waits(record: Record) -> list[float]:
    """All waits, those in vain included."""
    return [*(wait for times in record.waits.values() for wait in times), *record.replaced, *record.opening]


def count_delayed_messages(servers: Sequence[Server]) -> int:
    """Messages of all processes that waited because their page took more than its share."""
    return sum(server.delayed_messages() for server in servers)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--proxy", action="store_true", help="two processes behind nginx")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--attack", choices=list(ATTACKS), action="append")
    options = parser.parse_args()
    problems = []
    with tempfile.TemporaryDirectory() as folder, ExitStack() as end:
        processes = 2 if options.proxy else options.processes
        servers = [end.enter_context(served(Path(folder) / f"log {n}")) for n in range(processes)]
        places = [Place(server.address) for server in servers]
        if options.proxy:
            places = end.enter_context(behind_proxy(servers, Path(folder)))
        print("\n| attack | waits | minimum | median | 95 % | 99 % | maximum | delayed messages |")
        print("|---|---|---|---|---|---|---|---|")
        for name in options.attack or ATTACKS:
            before = count_delayed_messages(servers)
            record = asyncio.run(attack(places, name, options.seconds, options.seed))
            delayed = count_delayed_messages(servers) - before
            print(f"| {name} | {summary(waits(record))} | {delayed} |", flush=True)
            problems += [f"{delayed} messages delayed without an attack"] if delayed and ATTACKS[name] is do_nothing else []
            late = [wait for wait in waits(record) if wait > LONGEST_WAIT_SECONDS]
            problems += [f"{name}: {len(late)} waits longer than {LONGEST_WAIT_SECONDS:g} s"] if late else []
            problems += [f"{name}: {error}" for error in dict.fromkeys(record.errors)]
        problems += list(dict.fromkeys(line for server in servers for line in server.error_lines()))[:5]
    print("\nPassed." if not problems else "\nFailed: " + "; ".join(problems) + ".")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
