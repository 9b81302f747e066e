"""Memory of a server after many visitors have come and gone.

Run: uv run python -m benchmarks.visitors --visitors 200
"""

from __future__ import annotations

import argparse
import asyncio
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.load import CACHE_SENTENCE, Server, resident_megabytes, served
from benchmarks.simulated_sessions import Record, SimulatedSession

FIRST = 10
"""Memory is compared with the value after as many visitors."""

LARGEST_GROWTH = 0.15
"""Permitted growth of the memory from then on, as a share."""

ENVIRONMENT = {
    "ESCAPE_EXPLORER_CACHE_BYTES": str(32 * 2**20),
}
"""Settings of the server: its cache of results is full after the first visitors."""

AT_ONCE = 4
_STAY_SECONDS = 6.0
# Sessions end some time after their sockets are closed.
_END_SECONDS = 60.0


async def visit(server: Server, count: int, seed: int, record: Record) -> None:
    """Let visitors come, click, drag and choose at random, and leave; a few at once."""
    for begin in range(0, count, AT_ONCE):
        numbers = range(begin, min(begin + AT_ONCE, count))
        await asyncio.gather(*(_stay(SimulatedSession(server.address, seed + number, record)) for number in numbers))
    deadline = time.perf_counter() + _END_SECONDS
    while await asyncio.to_thread(server.sessions) and time.perf_counter() < deadline:
        await asyncio.sleep(0.5)


async def _stay(visitor: SimulatedSession) -> None:
    await visitor.open()
    visitor.click(0.1, 0.05)
    await visitor.run(time.perf_counter() + _STAY_SECONDS)
    await visitor.close()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--visitors", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    record = Record()
    with tempfile.TemporaryDirectory() as folder, served(Path(folder) / "log", **ENVIRONMENT) as server:
        asyncio.run(visit(server, FIRST, options.seed, record))
        first = resident_megabytes(server.process)
        asyncio.run(visit(server, options.visitors - FIRST, options.seed + FIRST, record))
        last = resident_megabytes(server.process)
        sessions, errors = server.sessions(), [*record.errors, *server.error_lines()]
    growth = last / first - 1.0
    print(CACHE_SENTENCE)
    print(f"Resident memory after {FIRST} visitors {first:.0f} MB, after {options.visitors} {last:.0f} MB: {growth:+.1%}.")
    print(f"Sessions that have not ended: {sessions}. Errors: {errors[:5] or 'none'}.")
    return 1 if growth > LARGEST_GROWTH or sessions or errors else 0


if __name__ == "__main__":
    sys.exit(main())
