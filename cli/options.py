"""Options shared by several commands."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class PlaneName(StrEnum):
    """Name of a plane of initial conditions on the command line; names as in `engine.Plane`."""

    X_PX = "x_px"
    X_Y = "x_y"
    X_H = "x_h"
    Y_PY = "y_py"


DEFAULT_PLANE = PlaneName.X_PX

Edges = tuple[float, float, float, float]
"""x_low, x_high, ordinate_low, ordinate_high."""

Case = Annotated[
    str,
    typer.Argument(
        metavar="CASE",
        help="Potential: I, II or III as in Zotos (2014), another name that `potential` lists, or a formula in x and y; "
        "optionally with parameters, as in III@omega_1=1.1,epsilon=0.5.",
    ),
]
Energy = Annotated[float | None, typer.Option("--energy", help="h, dimensionless.")]
Energies = Annotated[
    tuple[float, float] | None, typer.Option("--energies", metavar="LOW HIGH", help="Range of h, for the plane x_h.")
]
Plane = Annotated[PlaneName, typer.Option("--plane", help="Plane of initial conditions.")]
Window = Annotated[
    Edges | None,
    typer.Option("--window", metavar="X0 X1 Y0 Y1", help="Window of the plane; by default the whole interior."),
]
Resolution = Annotated[str, typer.Option("--resolution", metavar="N or NxM", help="Columns x rows, each 1 to 4096.")]
TMax = Annotated[float, typer.Option("--t-max", help="Integration time, up to 1e8.")]
OrbitTMax = Annotated[float, typer.Option("--t-max", help="Integration time, up to 1e7.")]
Certify = Annotated[
    bool,
    typer.Option(
        "--certify/--no-certify",
        help="Whether a certificate may end the integration of a bounded orbit before t_max.",
    ),
]
Backward = Annotated[bool, typer.Option("--backward", help="Integrate backward in time.")]
Threads = Annotated[int | None, typer.Option("--threads", min=1, metavar="N", help="Number of threads; by default one per core.")]
Scheduler = Annotated[
    str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Compute on the Dask cluster of this scheduler.")
]
LocalCluster = Annotated[
    int | None, typer.Option("--local-cluster", min=1, metavar="N", help="Start a Dask cluster of N workers on this machine.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON instead of tables and sentences; missing numbers are null.")]
Output = Annotated[
    Path | None,
    typer.Option("--output", metavar="STEM", help="File names without ending; existing files are replaced."),
]
