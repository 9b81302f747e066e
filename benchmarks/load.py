"""Many visitors at once, who drag sliders for some minutes: how long they wait, what the server needs, what stays behind.

Run: ESCAPE_EXPLORER_ONLY_IDLE=yes uv run python -m benchmarks.load --processes 2 --sessions 50 --seconds 300
"""

from __future__ import annotations

import argparse
import asyncio
import json
import re
import socket
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from benchmarks.visitors import JobClient, Record

LONGEST_WAIT_SECONDS = 2.0
"""Nobody may wait longer for the first frame of a map."""

REST_SECONDS = 60.0
"""By then after the last visitor has left, no session may be there any more."""

SERVER_OPTIONS = (
    "--log-format=%(asctime)s %(levelname)s %(message)s",
    "--rest-session-info",
    "--session-history=-1",
    "--unused-session-lifetime=2000",
    "--check-unused-sessions=1000",
)
START_SECONDS = 240.0
_ROOT = Path(__file__).parents[1]
_ERROR_LINE = re.compile(r"\b(ERROR|CRITICAL)\b|^Traceback|Task exception was never retrieved")


@dataclass
class Server:
    """The server under load, looked at once a second."""

    address: str
    process: int
    log: Path
    megabytes: list[float] = field(default_factory=list)

    def sessions(self) -> int:
        """How many sessions it has now."""
        with urllib.request.urlopen(self.address.removesuffix("/app") + "/session_info", timeout=30) as answer:
            sessions = json.load(answer)["sessions"]
        return sum(session["ended"] is None for session in sessions.values())

    def cpu_seconds(self) -> float:
        """Processor time of all its threads until now."""
        fields = Path(f"/proc/{self.process}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / 100.0

    def error_lines(self) -> list[str]:
        """What its log complains of."""
        return [line for line in self.log.read_text().splitlines() if _ERROR_LINE.search(line)]

    async def watch(self) -> None:
        """Note its resident memory."""
        while True:
            pages = int(Path(f"/proc/{self.process}/statm").read_text().split()[1])
            self.megabytes.append(pages * 4096 / 2**20)
            await asyncio.sleep(1.0)


@contextmanager
def served(log: Path) -> Iterator[Server]:
    """The app as the README starts it, at a port that the system picks, until it is left."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        place = f"127.0.0.1:{probe.getsockname()[1]}"
    command = [sys.executable, "-m", "panel", "serve", "app", "--address=127.0.0.1", f"--port={place.split(':')[1]}"]
    command += [f"--allow-websocket-origin={place}", *SERVER_OPTIONS]
    with log.open("w") as output:
        process = subprocess.Popen(command, cwd=_ROOT, stdout=output, stderr=subprocess.STDOUT)
    try:
        wait_until_ready(f"http://{place}/readiness", process)
        yield Server(f"http://{place}/app", process.pid, log)
    finally:
        process.terminate()
        process.wait(30)


def wait_until_ready(address: str, process: subprocess.Popen[bytes]) -> None:
    last = time.monotonic() + START_SECONDS
    while process.poll() is None and time.monotonic() < last:
        try:
            with urllib.request.urlopen(address, timeout=60):
                return
        except OSError:
            time.sleep(0.3)
    raise RuntimeError(f"the server was not ready within {START_SECONDS:g} s, or ended: {process.poll()}")


@dataclass(frozen=True)
class Outcome:
    """What else there is to say of a load: sessions while visitors were there and after, and processors kept busy."""

    there: int
    left: int
    busy: float


async def load(servers: Sequence[Server], record: Record, sessions: int, seconds: float, seed: int) -> Outcome:
    """Let visitors come, dealt out to the processes in turn, stay and leave."""
    watching = [asyncio.create_task(server.watch()) for server in servers]
    visitors = [JobClient(servers[place % len(servers)].address, seed + place, record) for place in range(sessions)]
    for visitor in visitors:
        await visitor.open()
    there, used, begin = count_sessions(servers), count_cpu_seconds(servers), time.perf_counter()
    await asyncio.gather(*(visitor.stay(begin + seconds) for visitor in visitors))
    busy = (count_cpu_seconds(servers) - used) / (time.perf_counter() - begin)
    await asyncio.gather(*(visitor.leave() for visitor in visitors))
    last = time.perf_counter() + REST_SECONDS
    while (left := await asyncio.to_thread(count_sessions, servers)) and time.perf_counter() < last:
        await asyncio.sleep(1.0)
    for task in watching:
        task.cancel()
    return Outcome(there, left, busy)


def count_sessions(servers: Sequence[Server]) -> int:
    """Of all processes together."""
    return sum(server.sessions() for server in servers)


def count_cpu_seconds(servers: Sequence[Server]) -> float:
    """Of all processes together."""
    return sum(server.cpu_seconds() for server in servers)


def summary(times: list[float]) -> str:
    """Count, minimum, median, 95th and 99th percentile, and the worst."""
    if not times:
        return "0 | – | – | – | – | –"
    hundredths = statistics.quantiles(times, n=100, method="inclusive") if len(times) > 1 else times * 99
    figures = (min(times), hundredths[49], hundredths[94], hundredths[98], max(times))
    return " | ".join([str(len(times)), *(f"{figure:.2f}" for figure in figures)])


def report(servers: Sequence[Server], record: Record, outcome: Outcome) -> None:
    print("| seconds to the first frame after | times | least | median | 95 % | 99 % | worst |\n|---|---|---|---|---|---|---|")
    for name, times in record.waits.items():
        print(f"| {name} | {summary(times)} |")
    print(f"| overtaken by the next wish, so far | {summary(record.overtaken)} |")
    print(f"| opening the page, one visitor at a time | {summary(record.opening)} |")
    print(f"\nQuick looks: {record.looks}. Clicks: {record.clicks}, pictures of orbits: {record.drawn}.")
    print(f"Processors kept busy by the server: {outcome.busy:.2f}.")
    for server in servers:
        tenth = max(len(server.megabytes) // 10, 1)
        sizes = ", ".join(f"{size:.0f}" for size in server.megabytes[::tenth])
        print(f"Resident memory of a process, MB: {sizes}; most {max(server.megabytes):.0f}.")
    print(f"Sessions: {outcome.there} at once, {outcome.left} after all had left.")


def faults(servers: Sequence[Server], record: Record, left: int, ceiling: float) -> Iterator[str]:
    """What may not be."""
    waits = [*(wait for times in record.waits.values() for wait in times), *record.overtaken]
    late = [wait for wait in waits if wait > LONGEST_WAIT_SECONDS]
    if not waits:
        yield "nobody asked for anything"
    if late:
        yield f"{len(late)} of {len(waits)} waits longer than {LONGEST_WAIT_SECONDS:g} s, the worst {max(late):.2f} s"
    errors = [*record.errors, *(line for server in servers for line in server.error_lines())]
    if errors:
        yield f"{len(errors)} errors, as: " + " / ".join(list(dict.fromkeys(errors))[:5])
    most = max(max(server.megabytes) for server in servers)
    if most > 1024 * ceiling:
        yield f"{most:.0f} MB of memory in a process, more than {ceiling:g} GiB"
    if left:
        yield f"{left} sessions stay behind"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sessions", type=int, default=50)
    parser.add_argument("--seconds", type=float, default=300.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--ceiling", type=float, default=2.0, help="of the resident memory of a process, GiB")
    parser.add_argument("--processes", type=int, default=1, help="among which visitors are dealt out in turn")
    wanted = parser.parse_args()
    record = Record()
    with tempfile.TemporaryDirectory() as folder, ExitStack() as end:
        servers = [end.enter_context(served(Path(folder) / f"log {place}")) for place in range(wanted.processes)]
        who = f"{wanted.sessions} visitors of {wanted.processes} processes"
        print(f"\n{who} for {wanted.seconds:g} s, seed {wanted.seed}\n", flush=True)
        outcome = asyncio.run(load(servers, record, wanted.sessions, wanted.seconds, wanted.seed))
        report(servers, record, outcome)
        problems = list(faults(servers, record, outcome.left, wanted.ceiling))
    print("\nPassed." if not problems else "\nFailed: " + "; ".join(problems) + ".")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
