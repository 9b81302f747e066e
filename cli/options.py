"""The options that several commands share: each one's type and help text, once."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class PlaneName(StrEnum):
    """A plane of initial conditions as it is typed; the names are those of `engine.Plane`."""

    X_PX = "x_px"
    X_Y = "x_y"
    X_H = "x_h"


Edges = tuple[float, float, float, float]
"""x_low, x_high, ordinate_low, ordinate_high."""

Case = Annotated[
    str,
    typer.Argument(
        metavar="CASE",
        help="Which potential: I, II or III, as in Zotos (2014), another name that `potential` lists, or a formula in x and y; "
        "with parameters after it, as in III@omega_1=1.1,epsilon=0.5.",
    ),
]
Energy = Annotated[float | None, typer.Option("--energy", help="h, dimensionless.")]
Energies = Annotated[
    tuple[float, float] | None, typer.Option("--energies", metavar="LOW HIGH", help="Range of h, for the plane x_h.")
]
Plane = Annotated[PlaneName, typer.Option("--plane", help="Plane of initial conditions.")]
Window = Annotated[
    Edges | None,
    typer.Option("--window", metavar="X0 X1 Y0 Y1", help="Part of the plane; without it, the whole interior."),
]
Resolution = Annotated[str, typer.Option("--resolution", metavar="N or NxM", help="Columns x rows, each 1 to 4096.")]
TMax = Annotated[float, typer.Option("--t-max", help="How long orbits are followed, up to 1e8.")]
OrbitTMax = Annotated[float, typer.Option("--t-max", help="How long the orbit is followed, up to 1e7.")]
Certify = Annotated[
    bool,
    typer.Option(
        "--certify/--no-certify",
        help="Whether an orbit may be called bounded early where there is evidence that it never leaves.",
    ),
]
Backward = Annotated[bool, typer.Option("--backward", help="Follow orbits into the past.")]
Threads = Annotated[
    int | None, typer.Option("--threads", min=1, metavar="N", help="Threads to compute on; without it, one for each core.")
]
Scheduler = Annotated[
    str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Compute on the Dask cluster of this scheduler.")
]
LocalCluster = Annotated[
    int | None, typer.Option("--local-cluster", min=1, metavar="N", help="Start a Dask cluster of N workers on this machine.")
]
AsJson = Annotated[
    bool, typer.Option("--json", help="Print JSON instead of tables and sentences; numbers that are not there are null.")
]
Output = Annotated[
    Path | None,
    typer.Option("--output", metavar="STEM", help="Name of the files without their ending; existing ones are replaced."),
]
