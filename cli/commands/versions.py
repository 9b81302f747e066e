"""Print the versions of the program and its dependencies, the processor, threads and cache folder, for reports of errors.

Examples:

escape-explorer versions

escape-explorer versions --json
"""

from __future__ import annotations

from cli.options import with_options
from cli.printing import AsJson, Table, print_result
from engine.foundations.versions import list_versions


@with_options
def run(*, as_json: AsJson = False) -> None:
    """Print the versions."""
    versions = list_versions()
    print_result(as_json, versions, Table(("name", "version"), list(versions.items())))
