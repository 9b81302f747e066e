"""Measure how long one visitor waits while another keeps the server as busy as the page allows, in several ways.

Run: uv run python -m benchmarks.hostile --seconds 60
     uv run python -m benchmarks.hostile --seconds 60 --processes 2
     uv run python -m benchmarks.hostile --seconds 60 --proxy
     uv run python -m benchmarks.hostile --seconds 600 --attack everything
     uv run python -m benchmarks.hostile --seconds 90 --attack "sessions opened and dropped" --attack "slow readers"

Each process has an attacker and a normal visitor, who drags, clicks, chooses, types and opens the page again. With ``--proxy``
there are two processes behind nginx with `deploy/nginx.conf`, and the visitors' cookies choose the process.
"""

from __future__ import annotations

import argparse
import asyncio
import itertools
import random
import sys
import tempfile
import time
from collections.abc import AsyncIterator, Awaitable, Iterator, Mapping, Sequence
from contextlib import ExitStack, aclosing, asynccontextmanager, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple
from urllib.parse import urlsplit

from benchmarks.attacks import ATTACKS, do_nothing
from benchmarks.load import CACHE_SENTENCE, LONG_WAIT_SECONDS, Server, resident_megabytes, served, shared_by, summary
from benchmarks.simulated_sessions import ACTIONS, ALL_ACTIONS, Record, SimulatedSession, visitor_headers
from tests.browser.served_app import free_port
from tests.deploy.proxy import ADDRESS_HEADER, Proxy, authorization, nginx, proxied
from tests.page_channel import NO_OPTIONS, Options

LONGEST_WAIT_SECONDS = 3.0
"""Longest permitted time to the first frame of the normal visitor's map, and to the answer of ``/liveness``."""

LONGEST_REVIEW_SECONDS = 20.0
"""Longest permitted time until the page shows the review of a formula."""

LONGEST_TURN_MILLISECONDS = 100.0
"""Longest permitted processor time of one iteration of the event loop."""

MOST_LINES = 3.0
"""Largest number of log lines for each formula."""

MOST_LIMITED_MEGABYTES = 1024.0 + 300.0
"""Largest permitted memory of the process for typed formulas: its limit plus its memory at the start."""

REST_SECONDS = 5.0
"""Pause between two attacks."""

PROBE_SECONDS = 0.25
"""Pause between two requests of ``/liveness``."""


class Place(NamedTuple):
    """The address of a page, and options of requests that reach one process."""

    address: str
    options: Options = NO_OPTIONS


@dataclass
class Effect:
    """The effects of an attack on the other visitors and on the processes.

    Attributes
    ----------
    record
        The waits of the other visitors.
    attackers
        The waits of the attackers.
    liveness
        Seconds until each answer of ``/liveness``.
    megabytes
        Largest resident memory of a process before, during and after the attack.
    actions
        Number of the attacker's actions.
    lines
        Number of lines that the attack has added to the logs, without those on late iterations of the event loop.
    turn
        Longest processor time of a late iteration of the event loop, in milliseconds, and its cause.
    limited_megabytes
        Largest resident memory of the process for typed formulas.
    """

    record: Record
    attackers: Record
    liveness: list[float]
    megabytes: tuple[float, float, float]
    actions: int
    lines: int
    turn: tuple[float, str]
    limited_megabytes: float


@asynccontextmanager
async def visiting(
    place: Place, seed: int, record: Record, actions: Mapping[str, int] = MappingProxyType(ACTIONS)
) -> AsyncIterator[SimulatedSession]:
    """Yield a session with an open page, of a visitor with an individual address behind the proxy."""
    session = new_session(place, seed, record, actions)
    await session.open()
    while not session.is_open:
        await asyncio.sleep(1.0)
        await session.open()
    try:
        yield session
    finally:
        await session.close()


def new_session(
    place: Place, seed: int, record: Record, actions: Mapping[str, int] = MappingProxyType(ACTIONS)
) -> SimulatedSession:
    """Return a session that is not open yet, of a visitor with an individual address behind the proxy."""
    headers = place.options.get("headers", {}) | visitor_headers(ADDRESS_HEADER, seed)
    return SimulatedSession(place.address, seed, record, {**place.options, "headers": headers}, actions)


async def observe(servers: Sequence[Server], run: Awaitable[tuple[Record, Record, int]]) -> Effect:
    """Await an attack, and return its effects.

    The attack returns the record of normal visitors, the record of attackers, and the number of actions.
    """
    before, liveness, limited = largest_memory(servers), list[float](), [0.0]
    lines = [len(server.log_lines()) for server in servers]
    for server in servers:
        server.forget_peak()
    probes = [asyncio.create_task(_probe(server, liveness, limited)) for server in servers]
    record, attackers, actions = await run
    for probe in probes:
        probe.cancel()
    peak = max(server.peak_megabytes() for server in servers)
    await asyncio.sleep(REST_SECONDS)
    return Effect(
        record,
        attackers,
        liveness,
        (before, peak, largest_memory(servers)),
        actions,
        sum(server.count_lines(first) for server, first in zip(servers, lines, strict=True)),
        max(server.longest_turn(first) for server, first in zip(servers, lines, strict=True)),
        max(limited),
    )


async def _probe(server: Server, liveness: list[float], limited: list[float]) -> None:
    while True:
        liveness.append(await asyncio.to_thread(server.seconds_until_live))
        limited.append(server.limited_megabytes())
        await asyncio.sleep(PROBE_SECONDS)


def largest_memory(servers: Sequence[Server]) -> float:
    """Return the largest resident memory of a process, in megabytes."""
    return max(resident_megabytes(server.process) for server in servers)


async def attack(places: Sequence[Place], name: str, seconds: float, seed: int) -> tuple[Record, Record, int]:
    """Attack; return the record of one normal visitor per process, the attackers' record, and the number of actions."""
    record, attackers, actions = Record(), Record(), 0

    async def run_attack(place: Place, number: int) -> None:
        nonlocal actions
        async with (
            visiting(place, seed + 100 + number, attackers) as visitor,
            aclosing(ATTACKS[name](visitor, random.Random(seed + number))) as steps,
        ):
            async for _ in steps:
                actions += 1
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
    return record, attackers, actions


async def _visit(place: Place, seed: int, record: Record, end: float) -> None:
    async with visiting(place, seed, record, ALL_ACTIONS) as visitor:
        await visitor.run(end)


@contextmanager
def behind_proxy(servers: Sequence[Server], folder: Path) -> Iterator[list[Place]]:
    """Run nginx in front of two servers, and yield a place for each server."""
    program = nginx()
    if program is None:
        raise RuntimeError("nginx is not installed")
    first, second = (urlsplit(server.address).port or 0 for server in servers)
    with proxied(program, folder, free_port(), (first, second)) as proxy:
        yield asyncio.run(_find_places(proxy, servers))


async def _find_places(proxy: Proxy, servers: Sequence[Server]) -> list[Place]:
    """Try cookies until each server has had a session, and return a place with such a cookie for each server."""
    found: dict[int, Place] = {}
    for number in itertools.count():
        headers = {**authorization(), "Cookie": f"explorer_visitor={number}"}
        place = Place(f"{proxy.origin}/app", {"headers": headers, "ssl_options": proxy.ssl_context()})
        async with visiting(place, 200 + number, Record()):
            found |= {index: place for index, server in enumerate(servers) if await asyncio.to_thread(server.sessions)}
        while sum([await asyncio.to_thread(server.sessions) for server in servers]):
            await asyncio.sleep(0.1)
        if len(found) == len(servers):
            break
    return list(found.values())


def waits(record: Record) -> list[float]:
    """Return all waits, including waits in vain."""
    return [wait for times in waits_by_action(record).values() for wait in times]


def waits_by_action(record: Record) -> dict[str, list[float]]:
    """Return the waits by action, including waits in vain."""
    return record.waits | {"replaced": record.replaced, "open": record.opening, "type": record.reviews}


def count_delayed_messages(servers: Sequence[Server]) -> int:
    """Return the number of messages, of all processes, that waited because their page took more than its share."""
    return sum(server.delayed_messages() for server in servers)


COLUMNS = (
    "attack", "waits", "minimum", "median", "95 %", "99 %", "maximum", "longest by action", "over 2 s, 3 s", "refused",
    "delayed messages", "liveness", "memory before", "peak", "after", "limited process", "actions", "log lines for each",
    "longest turn", "longest review",
)  # fmt: skip


def row(name: str, effect: Effect, delayed_messages: int) -> str:
    """Return a row of the table with `COLUMNS`."""
    megabytes = " | ".join(f"{size:.0f}" for size in (*effect.megabytes, effect.limited_megabytes))
    seconds = waits(effect.record)
    late = ", ".join(str(sum(wait > limit for wait in seconds)) for limit in (LONG_WAIT_SECONDS, LONGEST_WAIT_SECONDS))
    longest = ", ".join(f"{action} {max(times):.2f}" for action, times in waits_by_action(effect.record).items() if times)
    visitor = f"{summary(seconds)} | {longest} | {late} | {effect.record.refused} | {delayed_messages}"
    processes = f"{max(effect.liveness):.2f} | {megabytes}"
    lines, (turn, cause) = effect.lines / max(effect.actions, 1), effect.turn
    review = f"{max(effect.attackers.reviews):.2f}" if effect.attackers.reviews else "–"
    return f"| {name} | {visitor} | {processes} | {effect.actions} | {lines:.1f} | {turn:.0f} ms: {cause} | {review} |"


def find_problems(effect: Effect) -> Iterator[str]:
    """Yield violations of the limits."""
    for what, seconds in (("waits", waits(effect.record)), ("answers of /liveness", effect.liveness)):
        late = [wait for wait in seconds if wait > LONGEST_WAIT_SECONDS]
        if late:
            yield f"{len(late)} {what} later than {LONGEST_WAIT_SECONDS:g} s, the latest after {max(late):.2f} s"
    if effect.attackers.reviews:
        yield from _find_problems_of_formulas(effect)
    if effect.record.refused:
        yield f"the page was refused {effect.record.refused} times"
    yield from dict.fromkeys(effect.record.errors)


def _find_problems_of_formulas(effect: Effect) -> Iterator[str]:
    if max(effect.attackers.reviews) > LONGEST_REVIEW_SECONDS:
        yield f"a formula was answered after {max(effect.attackers.reviews):.2f} s"
    if effect.lines > MOST_LINES * effect.actions:
        yield f"{effect.lines} lines in the log for {effect.actions} formulas"
    if effect.turn[0] > LONGEST_TURN_MILLISECONDS:
        yield f"a turn of the event loop took {effect.turn[0]:.0f} ms: {effect.turn[1]}"
    if effect.limited_megabytes > MOST_LIMITED_MEGABYTES:
        yield f"the process for formulas had {effect.limited_megabytes:.0f} MB"
    yield from (f"the visitor who types: {error}" for error in dict.fromkeys(effect.attackers.errors))


@contextmanager
def running(processes: int, *, proxy: bool) -> Iterator[tuple[list[Server], list[Place]]]:
    """Run servers, print the head of the table, and yield the servers and their places. With a proxy, run two behind nginx."""
    with tempfile.TemporaryDirectory() as folder, ExitStack() as end:
        count = 2 if proxy else processes
        servers = [end.enter_context(served(Path(folder) / f"log {n}", **shared_by(count))) for n in range(count)]
        places = [Place(server.address) for server in servers]
        if proxy:
            places = end.enter_context(behind_proxy(servers, Path(folder)))
        print(f"\n{CACHE_SENTENCE} Largest seconds until /liveness answers; largest memory of a process in MB.\n")
        print(f"| {' | '.join(COLUMNS)} |\n|{'---|' * len(COLUMNS)}")
        yield servers, places


def end_with(servers: Sequence[Server], problems: Sequence[str]) -> int:
    """Print these problems and the errors in the logs; return the exit code."""
    found = [*problems, *list(dict.fromkeys(line for server in servers for line in server.error_lines()))[:10]]
    print("\nPassed." if not found else "\nFailed: " + "; ".join(found) + ".")
    return 1 if found else 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--proxy", action="store_true", help="two processes behind nginx")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--attack", choices=list(ATTACKS), action="append")
    options = parser.parse_args()
    problems = []
    with running(options.processes, proxy=options.proxy) as (servers, places):
        for name in options.attack or ATTACKS:
            before = count_delayed_messages(servers)
            effect = asyncio.run(observe(servers, attack(places, name, options.seconds, options.seed)))
            delayed = count_delayed_messages(servers) - before
            print(row(name, effect, delayed), flush=True)
            problems += [f"{delayed} messages delayed without an attack"] if delayed and ATTACKS[name] is do_nothing else []
            problems += [f"{name}: {problem}" for problem in find_problems(effect)]
        return end_with(servers, problems)


if __name__ == "__main__":
    sys.exit(main())
