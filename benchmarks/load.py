"""Measure waits, processor time, memory and remaining sessions while simulated sessions drag the energy slider for minutes.

Run: uv run python -m benchmarks.load --processes 2 --sessions 50 --seconds 300
     uv run python -m benchmarks.load --processes 2 --sessions 50 --seconds 150 --busy-cores 1
     uv run python -m benchmarks.load --sessions 6 --seconds 30

Visitors refused by a full server try again, as their page does. Waits count while a visitor has a page.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import re
import socket
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import psutil

from app.runtime.capacity import WINDOW_SECONDS
from app.runtime.settings import variable_name
from benchmarks.simulated_sessions import Record, SimulatedSession
from engine.foundations.cache_files import CACHE_VARIABLE

LONG_WAIT_SECONDS = 2.0
"""Longer waits for the first frame of a map are counted."""

LONGEST_WAIT_SECONDS = 3.0
"""Longest permitted time to the first frame of a map."""

REST_SECONDS = 60.0
"""Longest permitted time from the closing of the sockets to the end of all sessions."""

SERVER_OPTIONS = (
    "--use-xheaders",
    "--log-format=%(asctime)s %(levelname)s %(message)s",
    "--unused-session-lifetime=2000",
    "--check-unused-sessions=1000",
)

CACHE_SENTENCE = "Kernel cache: empty when the first process started, shared by all."
# Longest time until the kernels of a server are compiled.
START_SECONDS = 240.0
WARM_SESSIONS = 6
"""Number of sessions that do not count for the memory of a page, because they load what all sessions share."""
_ROOT = Path(__file__).parents[1]
# Lines of errors, except answers 503: these are refused pages, which the visitors count.
_ERROR_LINE = re.compile(r"\b(ERROR|CRITICAL)\b(?!.*tornado.access: 503 )|^\s*Traceback|Task exception was never retrieved")
# Words of the lines on late iterations of the event loop.
_LATE = "event loop "
_TURN = re.compile(_LATE + r"\d+ ms late, (\d+) ms of its own, with (\d+) ms of garbage collection; cause: (.*)")


@dataclass
class Server:
    """One server process under load; `megabytes` is its resident memory once per second."""

    address: str
    process: int
    log: Path
    megabytes: list[float] = field(default_factory=list)

    def sessions(self) -> int:
        """Return the number of open sessions."""
        return self._count("sessions_open")

    def delayed_messages(self) -> int:
        """Return the number of messages that waited because their page took more than its share."""
        return self._count("messages_delayed_total")

    def _count(self, metric: str) -> int:
        with urllib.request.urlopen(self.address.removesuffix("/app") + "/metrics", timeout=30) as answer:
            [count] = re.findall(rf"^escape_explorer_{metric} (\S+)$", answer.read().decode(), re.MULTILINE)
        return int(float(count))

    def log_lines(self) -> list[str]:
        """Return all lines of the log."""
        return self.log.read_text().splitlines()

    def count_lines(self, first_line: int) -> int:
        """Return the number of log lines after the first `first_line`, without those on late iterations of the event loop."""
        return sum(_LATE not in line for line in self.log_lines()[first_line:])

    def longest_turn(self, first_line: int) -> tuple[float, str]:
        """Return the longest processor time in ms of a late iteration of the event loop after `first_line` lines, and its cause.

        The time of garbage collections is left out, because it grows with the number of pages.
        """
        found = _TURN.findall("\n".join(self.log_lines()[first_line:]))
        return max(((float(own) - float(collected), cause) for own, collected, cause in found), default=(0.0, ""))

    def seconds_until_live(self) -> float:
        """Return seconds until ``/liveness`` answers."""
        begin = time.perf_counter()
        with urllib.request.urlopen(self.address.removesuffix("/app") + "/liveness", timeout=60):
            return time.perf_counter() - begin

    def forget_peak(self) -> None:
        """Measure the peak of the resident memory from now on: Linux resets it when 5 is written to this file."""
        Path(f"/proc/{self.process}/clear_refs").write_text("5")

    def peak_megabytes(self) -> float:
        """Return the peak of the resident memory."""
        return peak_megabytes(self.process)

    def limited_megabytes(self) -> float:
        """Return the peak of the resident memory of the running process for typed formulas."""
        with suppress(psutil.Error):
            # A process that is just beginning is not counted, because it is still a copy of the server.
            children = [child for child in psutil.Process(self.process).children() if "loky" in " ".join(child.cmdline())]
            return max((peak_megabytes(child.pid) for child in children), default=0.0)
        return 0.0

    def cpu_seconds(self) -> float:
        """Return the processor time of the process so far."""
        # User and system time, in ticks of 10 ms, are fields 14 and 15, that is 11 and 12 after the name in brackets.
        fields = Path(f"/proc/{self.process}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / 100.0

    def error_lines(self) -> list[str]:
        """Return the lines of the log with errors, and the last line of each traceback."""
        found, indent = list[str](), None
        for line in self.log_lines():
            depth = len(line) - len(line.lstrip())
            # Frames are indented further than the beginning of their traceback, and the error follows them.
            is_error = indent is not None and depth <= indent
            if is_error or _ERROR_LINE.search(line):
                found.append(line.strip())
            if is_error:
                indent = None
            if "Traceback" in line:
                indent = depth
        return found

    async def watch(self) -> None:
        """Record the resident memory once per second, until cancelled."""
        while True:
            self.megabytes.append(resident_megabytes(self.process))
            await asyncio.sleep(1.0)


@contextmanager
def busy_cores(count: int) -> Iterator[None]:
    """Run other programs, each of which occupies a core. Yield when servers have had time to measure them."""
    programs = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        time.sleep(WINDOW_SECONDS if programs else 0.0)
        yield
    finally:
        for program in programs:
            program.terminate()
            program.wait(30)


def shared_by(processes: int) -> dict[str, str]:
    """Return the environment of one of several server processes on this machine."""
    return {variable_name("processes"): str(processes)}


@contextmanager
def served(log: Path, **environment: str) -> Iterator[Server]:
    """Run the app on a free port, with additional environment variables; yield when its kernels are compiled."""
    with started(log, **environment) as (server, process):
        wait_until_ready(server, process)
        yield server


@contextmanager
def started(log: Path, **environment: str) -> Iterator[tuple[Server, subprocess.Popen[bytes]]]:
    """Start the app on a free port, with additional environment variables; yield before it answers.

    Compiled kernels are stored beside the log, so that the user's kernel cache does not affect the measurement.
    """
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        host = f"127.0.0.1:{probe.getsockname()[1]}"
    command = [sys.executable, "-m", "panel", "serve", "app", "--address=127.0.0.1", f"--port={host.split(':')[1]}"]
    command += [f"--allow-websocket-origin={host}", *SERVER_OPTIONS]
    variables = {**os.environ, CACHE_VARIABLE: str(log.parent / "kernel cache"), **environment}
    with log.open("w") as output:
        process = subprocess.Popen(command, cwd=_ROOT, stdout=output, stderr=subprocess.STDOUT, env=variables)
    try:
        yield Server(f"http://{host}/app", process.pid, log), process
    finally:
        process.terminate()
        process.wait(30)


def wait_until_ready(server: Server, process: subprocess.Popen[bytes]) -> None:
    """Wait until all kernels are compiled."""
    address = server.address.removesuffix("/app") + "/readiness"
    deadline = time.monotonic() + START_SECONDS
    while process.poll() is None and time.monotonic() < deadline:
        try:
            with urllib.request.urlopen(address, timeout=60):
                return
        except OSError:
            time.sleep(0.3)
    raise RuntimeError(f"the server was not ready within {START_SECONDS:g} s, or ended: {process.poll()}")


@dataclass(frozen=True)
class Outcome:
    """Result of a load test apart from the waiting times.

    Attributes
    ----------
    open_sessions
        Sessions on the server before the first action.
    refused
        Number of visitors refused before the first action, and number of visitors never admitted.
    remaining_sessions
        Sessions on the server after all pages are closed.
    busy_cores
        Mean number of cores that the server used.
    page_megabytes
        Resident memory per open page before the first action.
    """

    open_sessions: int
    refused: tuple[int, int]
    remaining_sessions: int
    busy_cores: float
    page_megabytes: float


async def load(servers: Sequence[Server], record: Record, sessions: int, seconds: float, seed: int) -> Outcome:
    """Open the sessions, on the servers in turn, run them for some time, and close them."""
    monitors = [asyncio.create_task(server.watch()) for server in servers]
    simulated = [SimulatedSession(servers[n % len(servers)].address, seed + n, record) for n in range(sessions)]
    for session in simulated[:WARM_SESSIONS]:
        await session.open()
    megabytes = count_megabytes(servers)
    for session in simulated[WARM_SESSIONS:]:
        await session.open()
    page_megabytes = (count_megabytes(servers) - megabytes) / max(sessions - WARM_SESSIONS, 1)
    open_sessions, used, begin = count_sessions(servers), count_cpu_seconds(servers), time.perf_counter()
    refused = [session for session in simulated if not session.is_open]
    await asyncio.gather(*(session.run_when_admitted(begin + seconds) for session in simulated))
    still_refused = sum(not session.is_open for session in refused)
    busy_cores = (count_cpu_seconds(servers) - used) / (time.perf_counter() - begin)
    await asyncio.gather(*(session.close() for session in simulated))
    deadline = time.perf_counter() + REST_SECONDS
    while (remaining := await asyncio.to_thread(count_sessions, servers)) and time.perf_counter() < deadline:
        await asyncio.sleep(1.0)
    for task in monitors:
        task.cancel()
    return Outcome(open_sessions, (len(refused), still_refused), remaining, busy_cores, page_megabytes)


def count_sessions(servers: Sequence[Server]) -> int:
    """Return the number of open sessions of all processes."""
    return sum(server.sessions() for server in servers)


def count_cpu_seconds(servers: Sequence[Server]) -> float:
    """Return the processor time of all processes."""
    return sum(server.cpu_seconds() for server in servers)


def count_megabytes(servers: Sequence[Server]) -> float:
    """Return the resident memory of all processes."""
    return sum(resident_megabytes(server.process) for server in servers)


def resident_megabytes(process: int) -> float:
    """Return the resident memory of a process with pages of 4 kB."""
    pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    return pages * 4096 / 2**20


def peak_megabytes(process: int) -> float:
    """Return the peak of the resident memory of a process; 0 if it has ended."""
    try:
        status = Path(f"/proc/{process}/status").read_text()
    except OSError:
        return 0.0
    return sum(int(kilobytes) for kilobytes in re.findall(r"^VmHWM:\s+(\d+) kB$", status, re.MULTILINE)) / 1024


def summary(times: list[float]) -> str:
    """Return count, minimum, median, 95th and 99th percentile, and maximum as text."""
    if not times:
        return "0 | – | – | – | – | –"
    # `quantiles` needs two values. With a single value, all percentiles are equal to it.
    percentiles = statistics.quantiles(times, n=100, method="inclusive") if len(times) > 1 else times * 99
    values = (min(times), percentiles[49], percentiles[94], percentiles[98], max(times))
    return " | ".join([str(len(times)), *(f"{value:.2f}" for value in values)])


def report(servers: Sequence[Server], record: Record, outcome: Outcome) -> None:
    """Print the measurements."""
    print(
        "| seconds to the first frame after | count | minimum | median | 95 % | 99 % | maximum |\n|---|---|---|---|---|---|---|"
    )
    for name, times in record.waits.items():
        print(f"| {name} | {summary(times)} |")
    print(f"| replaced by the next action, until then | {summary(record.replaced)} |")
    print(f"| opening the page, one session at a time | {summary(record.opening)} |")
    print(f"\nClicks: {record.clicks}, plots of orbits: {record.orbit_plots}.")
    print(f"Busy cores: {outcome.busy_cores:.2f}. Memory per open page: {outcome.page_megabytes:.1f} MB.")
    for server in servers:
        tenth = max(len(server.megabytes) // 10, 1)
        sizes = ", ".join(f"{size:.0f}" for size in server.megabytes[::tenth])
        print(f"Resident memory of a process, MB: {sizes}; maximum {max(server.megabytes):.0f}, end {server.megabytes[-1]:.0f}.")
        turn, cause = server.longest_turn(0)
        print(
            f"Longest turn of the event loop: {turn:.0f} ms of processor time, {cause}; {server.count_lines(0)} other log lines."
        )
    waits = all_waits(record)
    late = ", ".join(
        f"{sum(wait > limit for wait in waits)} over {limit:g} s" for limit in (LONG_WAIT_SECONDS, LONGEST_WAIT_SECONDS)
    )
    print(f"Waits: {len(waits)}, {late}, the longest {max(waits, default=0.0):.2f} s.")
    print("Visitors refused by a full server: {}, {} of them until the end.".format(*outcome.refused))
    print(f"Sessions: {outcome.open_sessions} at once, {outcome.remaining_sessions} after all were closed.")


def all_waits(record: Record) -> list[float]:
    """Return all waits for maps, including waits in vain."""
    return [*(wait for times in record.waits.values() for wait in times), *record.replaced]


def find_problems(servers: Sequence[Server], record: Record, remaining: int, ceiling: float) -> Iterator[str]:
    """Yield violations of the limits."""
    waits = all_waits(record)
    late = [wait for wait in waits if wait > LONGEST_WAIT_SECONDS]
    if not waits:
        yield "no map was requested"
    if late:
        yield f"{len(late)} of {len(waits)} waits longer than {LONGEST_WAIT_SECONDS:g} s, the longest {max(late):.2f} s"
    errors = [*record.errors, *(line for server in servers for line in server.error_lines())]
    if errors:
        yield f"{len(errors)} errors, for example: " + " / ".join(list(dict.fromkeys(errors))[:5])
    most = max(max(server.megabytes) for server in servers)
    if most > 1024 * ceiling:
        yield f"{most:.0f} MB of memory in a process, more than {ceiling:g} GiB"
    if remaining:
        yield f"{remaining} sessions did not end"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sessions", type=int, default=50)
    parser.add_argument("--seconds", type=float, default=300.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--ceiling", type=float, default=2.0, help="largest permitted resident memory of a process, GiB")
    parser.add_argument("--processes", type=int, default=1, help="server processes")
    parser.add_argument("--busy-cores", type=int, default=0, help="other programs, each of which occupies a core")
    options = parser.parse_args()
    record = Record()
    with tempfile.TemporaryDirectory() as folder, ExitStack() as end:
        servers = [
            end.enter_context(served(Path(folder) / f"log {n}", **shared_by(options.processes))) for n in range(options.processes)
        ]
        end.enter_context(busy_cores(options.busy_cores))
        setup = f"{options.sessions} sessions on {options.processes} processes beside {options.busy_cores} busy cores"
        print(f"\n{setup} for {options.seconds:g} s, seed {options.seed}. {CACHE_SENTENCE}\n", flush=True)
        outcome = asyncio.run(load(servers, record, options.sessions, options.seconds, options.seed))
        report(servers, record, outcome)
        problems = list(find_problems(servers, record, outcome.remaining_sessions, options.ceiling))
    print("\nPassed." if not problems else "\nFailed: " + "; ".join(problems) + ".")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
