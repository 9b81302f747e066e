# ruff: noqa: D100, T201

# %% [markdown]
# # A day with case III
#
# The potential V = ½(x² + y²) − x² y² is a bowl with four passes. Below h = 1/4 nothing gets out. A little above, the passes are
# open but narrow, and where an orbit leaves, and when, depends on its start in a way that no short formula tells. This page asks
# what one asks first: who leaves, through which pass, how fast, which answers can be trusted, and how hard it is to predict
# the pass.
#
# It is a script (`python examples/a_day_with_case_three.py`) and a notebook: VS Code, or Jupyter with Jupytext, opens it cell
# by cell. It writes a NetCDF file and three pictures into the folder that it is run in, and wants matplotlib. Maps are small
# here, so that all of it takes seconds; for a figure raise `SIDE` to 500, and `T_MAX` to 1e5.

# %%
import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.colors import BoundaryNorm, ListedColormap

from engine import (
    CASES,
    ENTROPY_COUNTS_BOUNDED,
    PAPER_FITS,
    Fate,
    MapSpec,
    Plane,
    compute_basin_entropy,
    compute_crossing_statistics,
    compute_map,
    compute_regularity,
    compute_trust,
    exit_labels,
    find_lyapunov_orbits,
    fit_escape_shares,
    integrate_orbit,
    measure_deviation,
    start_states,
)

CASE, ENERGY = CASES["III"], 0.36
SIDE, T_MAX = 120, 1e4

# %% [markdown]
# ## Where is out?
#
# Over each pass runs one unstable periodic orbit, the Lyapunov orbit. Who crosses it outward never comes back, so that it is
# the exit by which escape is defined. Its period is the only time scale that the pass has of its own.

# %%
print(f"escape energy: {CASE.escape_energy}")
for ring in find_lyapunov_orbits(CASE, ENERGY):
    print(f"exit {ring.channel}: period {ring.period:.4f}, from x = {ring.x.min():+.3f} to {ring.x.max():+.3f}")

# %% [markdown]
# ## A map of escapes
#
# Each pixel of the plane (x, px) is a start with y = 0 and py > 0, as the energy demands. `fractions` are shares of the interior:
# starts that exist and do not lie beyond an exit already.
#
# A bounded pixel has not left by `T_MAX`, or holds a certificate that it never will (`docs/certificates.md`). Among these SALI
# tells regular motion from chaos.

# %%
frame = compute_map(MapSpec(CASE, Plane.X_PX, ENERGY, (SIDE, SIDE), t_max=T_MAX))
shares = frame.fractions()
print("bounded:", f"{shares[Fate.BOUNDED]:.4f}")
for channel in range(1, CASE.channels + 1):
    print(f"channel {channel}: {shares[channel]:.4f}")
print(f"worst energy error: {frame.worst_energy_error:.1e}")
print(f"chaotic among the bounded: {compute_regularity(frame).chaotic_share:.4f}")

# %% [markdown]
# The potential is even in x, so that (x, px) and (−x, −px) are starts of mirror images. Exits 1 and 2 have the same share, to
# the last orbit, and so have 3 and 4. All starts go upward, which favours the upper exits 1 and 2.
#
# ## Which pixels to trust
#
# Near a fractal boundary a start moved by far less than a pixel, or followed with another tolerance, ends elsewhere. Such pixels
# are right on average, never one by one. `compute_trust` follows every boundary pixel twice more and marks those that change.

# %%
trust = compute_trust(frame)
print(f"doubtful pixels: {trust.doubtful_share:.4f}")

# %% [markdown]
# ## Two orbits
#
# One that stays and one that wanders long before it leaves. SALI, the smaller alignment index, stays of order one on a torus
# and falls exponentially to rounding along chaotic motion; not before a sticky orbit has let go of the island that it clings
# to. Whether an orbit that leaves is "chaotic" is another question, which has no answer in infinite time; its SALI merely shows
# that neighbours part.

# %%
rows, columns = np.nonzero(frame.fate == Fate.BOUNDED)
deepest = np.argmin(np.hypot(frame.x[columns] - frame.x[columns].mean(), frame.ordinate[rows] - frame.ordinate[rows].mean()))
longest = np.unravel_index(np.nanargmax(frame.escape_time), frame.fate.shape)
places = {"bounded": (rows[deepest], columns[deepest]), "late": longest}
orbits = {}
for name, (row, column) in places.items():
    start = start_states(CASE, Plane.X_PX, ENERGY, frame.x[[column]], frame.ordinate[[row]])[0]
    orbits[name] = integrate_orbit(CASE, start, T_MAX)
    print(f"{name} orbit: SALI {orbits[name].sali[-1]:.2e}. {orbits[name].describe()}")

figure, (path, index) = plt.subplots(1, 2, figsize=(10, 4.5), layout="constrained")
for (name, orbit), colour in zip(orbits.items(), ("teal", "firebrick"), strict=True):
    few = slice(0, 3000)
    path.plot(orbit.x[few], orbit.y[few], lw=0.4, color=colour, label=name)
    index.loglog(orbit.t[1:], np.maximum(orbit.sali[1:], 1e-16), lw=0.8, color=colour)
path.set(xlabel="x", ylabel="y", aspect="equal", title=f"III, h = {ENERGY}")
path.legend(loc="upper right")
index.axhline(1e-7, color="grey", lw=0.8)
index.set(xlabel="t", ylabel="SALI", title="below the line: chaotic")
figure.savefig("orbits.png", dpi=120)
plt.close(figure)

# %% [markdown]
# ## Against energy, beside the paper
#
# Zotos (2014) describes the share that escapes by ½[1 + tanh(a h − b)]. We count at nine energies, fit the same form, and see how
# far either curve is from the counts. The paper's percentages count starts outside as escaped in some places; here the interior
# alone counts, which depends on no window. That, the coarse grid and the few energies are reasons to differ.

# %%
energies = np.linspace(0.27, 0.67, 9)
table = compute_crossing_statistics(CASE, Plane.X_PX, energies, (50, 50), T_MAX)
fitted = fit_escape_shares(table["h"], table["escaped"], table["starts"])
paper = PAPER_FITS["III"].escaped
print(f"paper: {paper.formula}; ours: {fitted.curve.formula}")
print(f"paper's curve: {measure_deviation(paper, table['h'], table['escaped'], table['starts']).describe()}")
print(f"our curve: {fitted.deviation.describe()}")

# %% [markdown]
# ## How hard is it to predict the exit?
#
# Basin entropy asks it in one number: cut the map into boxes of 5 × 5 starts, and take the mean entropy of the exits in a box.
# S_b = 0 where each box has one fate, ln 5 if all four exits and staying were equally likely everywhere. On boundaries alone,
# S_bb > ln 2 means that the boundary is not smooth at this scale (`docs/basin-entropy.md`). Orbits are followed for a tenth of
# `T_MAX` here: later escapes count as staying, which matters at the lowest energies only.

# %%
entropies = []
for h in energies:
    coarse = compute_map(MapSpec(CASE, Plane.X_PX, float(h), (100, 100), t_max=T_MAX / 10.0))
    entropies.append(compute_basin_entropy(*exit_labels(coarse.fate, bounded=ENTROPY_COUNTS_BOUNDED)))
for h, entropy in zip(energies, entropies, strict=True):
    print(f"h = {h:.2f}: S_b {entropy.s_b:.4f}, S_bb {entropy.s_bb:.4f}{', beyond ln 2' if entropy.beyond_ln2 else ''}")

figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
fine = np.linspace(energies[0], energies[-1], 200)
left.plot(table["h"], table["escaped_share"], "ko", label="counted")
left.plot(fine, paper(fine), "--", color="grey", label="paper's fit")
left.plot(fine, fitted.curve(fine), color="teal", label="our fit")
left.plot(table["h"], table["direct_share"], "s", mfc="none", color="firebrick", label="direct")
left.set(xlabel="h", ylabel="share of the starts")
left.legend()
right.errorbar(energies, [e.s_b for e in entropies], [e.s_b_error for e in entropies], fmt="o-", label="S_b")
right.errorbar(energies, [e.s_bb for e in entropies], [e.s_bb_error for e in entropies], fmt="s-", label="S_bb")
right.axhline(np.log(2.0), color="grey", ls=":", label="ln 2")
right.set(xlabel="h", ylabel="basin entropy, nats")
right.legend()
figure.savefig("against-energy.png", dpi=120)
plt.close(figure)

# %% [markdown]
# ## Take it along
#
# `to_xarray` names the axes and carries what made the map: potential, window, tolerances, version. A year later the file
# still says what it is. What follows needs xarray alone.

# %%
frame.to_xarray().to_netcdf("case-three.nc", engine="h5netcdf")

with xr.open_dataset("case-three.nc", engine="h5netcdf") as loaded:
    dataset = loaded.load()
print(f"read back: h = {dataset.attrs['energy']}, {dict(dataset.sizes)}, {dataset.attrs['integrator']}")

colours = ["white", "lightgrey", "tab:green", "tab:red", "tab:blue", "tab:orange"]
shown = dataset["fate"].where(dataset["fate"] >= 0, -1)
figure, (basins, times) = plt.subplots(1, 2, figsize=(11, 4.8), layout="constrained")
shown.plot.imshow(
    ax=basins,
    cmap=ListedColormap(colours),
    norm=BoundaryNorm(np.arange(-1.5, 5.0), len(colours)),
    cbar_kwargs={"ticks": range(-1, 5), "label": "−1 no start, 0 bounded, k exit"},
)
np.log10(dataset["escape_time"]).plot.imshow(ax=times, cmap="magma_r", cbar_kwargs={"label": "log10 of the escape time"})
basins.set(title=f"basins of escape, III, h = {ENERGY}", aspect="equal")
times.set(title="escape times", aspect="equal")
figure.savefig("basins.png", dpi=120)
plt.close(figure)

# %% [markdown]
# ## Where to go from here
#
# - `find_twin`: the nearest start that leaves elsewhere, and `compute_separation`: how the two part.
# - `find_stable_manifolds`: the curves that the boundaries follow. `compute_wada_test`: are they Wada?
# - `fit_decay_laws`: exponential or algebraic decay? `evaluate_indicators`: second opinions on one orbit.
# - `run_sweep`: the same map at hundreds of energies, into one store, resumed after a kill (`docs/long-runs.md`).
