"""Options shared by several commands."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from plots.printed.figure_style import FigureStyle

DEFAULT_PLANE = "x_px"

Edges = tuple[float, float, float, float]
"""x_low, x_high, ordinate_low, ordinate_high."""

Case = Annotated[
    str,
    typer.Argument(
        metavar="CASE",
        help="Potential: I, II or III as in Zotos (2014), another name that `potential` lists, or a formula in x and y; "
        "optionally with parameters, as in III@omega_1=1.1,epsilon=0.5; "
        "letters of a formula are parameters, too: 0.5(x^2+y^2)-a x y^2@a=1.5.",
    ),
]
Energy = Annotated[float | None, typer.Option("--energy", help="h, dimensionless.")]
Energies = Annotated[
    tuple[float, float] | None, typer.Option("--energies", metavar="LOW HIGH", help="Range of h, for slices with an axis h.")
]
Plane = Annotated[
    str,
    typer.Option(
        "--plane",
        "--axes",
        metavar="AXES",
        help="Slice of starts: x_px, x_y, x_h, y_py, tangential, or two axes such as x,theta: x, y, px, py, theta (angle of the "
        "velocity), beta (its angle from the radius), h, or a parameter with its range, x,epsilon=0.5:2.",
    ),
]
Fix = Annotated[
    list[str] | None,
    typer.Option(
        "--fix",
        metavar="NAME=VALUE",
        help="Value of another coordinate, 0 by default; py=- for the momentum that the energy decides, and its sign. Repeat for "
        "several.",
    ),
]
Window = Annotated[
    Edges | None,
    typer.Option("--window", metavar="X0 X1 Y0 Y1", help="Window of the plane; by default the whole interior."),
]
Resolution = Annotated[str, typer.Option("--resolution", metavar="N or NxM", help="Columns x rows, each 1 to 4096.")]
TMax = Annotated[float, typer.Option("--t-max", help="Integration time, up to 1e8.")]
OrbitTMax = Annotated[float, typer.Option("--t-max", help="Integration time, up to 1e7.")]
UseEvidence = Annotated[
    bool,
    typer.Option(
        "--evidence/--no-evidence",
        "--certify/--no-certify",
        help="Whether evidence may end the integration of a bounded orbit before t_max.",
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
    typer.Option(
        "--output",
        metavar="STEM",
        help="File names without ending, or the name of one file, whose ending is its format; existing files are replaced.",
    ),
]
DEFAULT_STYLE = FigureStyle()
Width = Annotated[float, typer.Option("--width", metavar="CM", help="Width of the figure in cm, 4 to 100.")]
Dpi = Annotated[float, typer.Option("--dpi", help="Pixels per inch of a PNG file, 50 to 1200.")]
FontSize = Annotated[float, typer.Option("--font-size", metavar="POINTS", help="Font size of the figure in points, 4 to 30.")]
Titles = Annotated[bool, typer.Option("--titles/--no-titles", help="Whether the figure has titles and its provenance.")]
PaletteName = Annotated[str, typer.Option("--palette", help="Colours: paper, or safe for the colour-blind.")]
