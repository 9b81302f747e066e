"""Send thousands of random formulas, in links and typed, from several addresses; measure answers, event loop, memory and log.

Run: uv run python -m benchmarks.formulas --count 20000
     uv run python -m benchmarks.formulas --count 20000 --proxy

Most options and the printed table are those of `benchmarks.hostile`, but there is no normal visitor.
"""

from __future__ import annotations

import argparse
import asyncio
import random
import sys
import time
from collections.abc import Awaitable, Callable, Iterator, Sequence
from urllib.parse import urljoin

from benchmarks.attacks import formula_link
from benchmarks.hostile import (
    LONGEST_REVIEW_SECONDS,
    Place,
    count_delayed_messages,
    end_with,
    find_problems,
    new_session,
    observe,
    row,
    running,
    visiting,
)
from benchmarks.simulated_sessions import Record, SimulatedSession
from tests.fuzz.random_formulas import random_link

FIRST_ADDRESS = 1000
"""Number of the first address that opens a page for one formula. A proxy limits the pages of each address."""

REOPEN_SECONDS = 1.0
"""Pause before a closed page is opened again, in seconds."""

PROGRESS = 1000
"""Number of formulas after which a line is printed."""


async def open_page(visitor: SimulatedSession, other: SimulatedSession, choice: random.Random) -> None:
    """Open and connect a page from another address, and close it when its formula is reviewed."""
    await other.open_formula(formula_link(choice))
    await other.close()


async def request_page(visitor: SimulatedSession, other: SimulatedSession, choice: random.Random) -> None:
    """Request a page from another address without a connection."""
    await other.fetch(urljoin("/app", formula_link(choice)))


async def follow_link(visitor: SimulatedSession, other: SimulatedSession, choice: random.Random) -> None:
    """Follow a link in the open page."""
    await visitor.follow_formula(formula_link(choice))


async def type_formula(visitor: SimulatedSession, other: SimulatedSession, choice: random.Random) -> None:
    """Type a formula in the open page, with Enter, so that its integrator is compiled and its map is computed."""
    await visitor.type_formula(random_link(choice)["V"])


async def begin_formula(visitor: SimulatedSession, other: SimulatedSession, choice: random.Random) -> None:
    """Type a formula in the open page without Enter, so that it is only reviewed."""
    await visitor.type_formula(random_link(choice)["V"], done=False)


# Sends a random formula from the page of a visitor or from another address.
Way = Callable[[SimulatedSession, SimulatedSession, random.Random], Awaitable[None]]

WAYS: dict[Way, int] = {open_page: 2, request_page: 4, follow_link: 12, type_formula: 12, begin_formula: 70}
"""Weights of the ways by which formulas reach the server.

A formula without Enter takes a fifth of the time of a formula with a map, and a new page takes as much as five with maps.
"""


async def send_formulas(places: Sequence[Place], visitors: int, numbers: range, seed: int) -> tuple[Record, Record, int]:
    """Send the formulas with these numbers from visitors of each place.

    Return an empty record of normal visitors, the record of the senders, and the number of formulas.
    """
    remaining, record = iter(numbers), Record()
    senders = [(place, seed + number) for number, place in enumerate([*places] * visitors)]
    await asyncio.gather(*(_send(place, address, remaining, record) for place, address in senders))
    return Record(), record, len(numbers)


async def _send(place: Place, address: int, numbers: Iterator[int], record: Record) -> None:
    async with visiting(place, address, record) as visitor:
        for number in numbers:
            if number and not number % PROGRESS:
                print(f"{number} formulas", file=sys.stderr, flush=True)
            choice = random.Random(number)
            [way] = choice.choices(list(WAYS), list(WAYS.values()))
            begin = time.perf_counter()
            await way(visitor, new_session(place, FIRST_ADDRESS + number, record), choice)
            seconds = time.perf_counter() - begin
            if way is request_page:
                record.reviews.append(seconds)
            if seconds > LONGEST_REVIEW_SECONDS:
                print(f"formula {number} by {way.__name__}: {seconds:.1f} s", file=sys.stderr, flush=True)
            while not visitor.is_open:
                await asyncio.sleep(REOPEN_SECONDS)
                await visitor.open()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--proxy", action="store_true", help="two processes behind nginx")
    parser.add_argument("--count", type=int, default=20_000, help="formulas")
    parser.add_argument("--first", type=int, default=0, help="number of the first formula, on which alone each formula depends")
    parser.add_argument("--visitors", type=int, default=4, help="addresses for each process")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    numbers = range(options.first, options.first + options.count)
    with running(options.processes, proxy=options.proxy) as (servers, places):
        begin, before = time.perf_counter(), count_delayed_messages(servers)
        effect = asyncio.run(observe(servers, send_formulas(places, options.visitors, numbers, options.seed)))
        print(row("formulas", effect, count_delayed_messages(servers) - before))
        print(f"\n{options.count} formulas in {time.perf_counter() - begin:.0f} s, {effect.attackers.refused} pages refused.")
        return end_with(servers, list(find_problems(effect)))


if __name__ == "__main__":
    sys.exit(main())
