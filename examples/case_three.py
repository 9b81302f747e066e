# ruff: noqa: D100

# %% [markdown]
# # Escapes in case III
#
# The potential V = ½(x² + y²) − x² y² is a well with four exit channels. Below the escape energy h = 1/4 all channels are closed.
# Slightly above h = 1/4 they are narrow, and the channel and the escape time of an orbit depend sensitively on its start. This
# example computes which orbits escape, through which channel and when, which pixels of a map are reliable, and how predictable
# the channel is.
#
# The file is a script (`python examples/case_three.py`) and a notebook: open it in VS Code, or in Jupyter with Jupytext. It
# writes a NetCDF file, which needs the extra `files`, and three pictures to the working directory. The maps are small, and the
# example runs within seconds. For figures increase `SIDE` to 500 and `T_MAX` to 1e5.

# %%
import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.colors import BoundaryNorm, ListedColormap

from escape_explorer import (
    CASES,
    Fate,
    MapSpec,
    Plane,
    SweepSpec,
    compute_map,
    compute_regularity,
    compute_sweep,
    compute_trust,
    find_lyapunov_orbits,
    integrate_orbit,
    judge_orbit,
    start_states,
)

CASE, ENERGY = CASES["III"], 0.36
SIDE, T_MAX = 120, 1e4

# %% [markdown]
# ## Exits
#
# Each open channel contains one unstable periodic orbit, the Lyapunov orbit. An orbit that crosses the Lyapunov orbit outward
# never returns, so this crossing defines the escape.

# %%
print(f"escape energy: {CASE.escape_energy}")
for exit_orbit in find_lyapunov_orbits(CASE, ENERGY):
    x = exit_orbit.x
    print(f"channel {exit_orbit.channel}: period {exit_orbit.period:.4f}, from x = {x.min():+.3f} to {x.max():+.3f}")

# %% [markdown]
# ## Escape map
#
# Each pixel of the (x, px) plane is an initial condition with y = 0 and py > 0 from the energy. `fractions` gives shares of the
# interior: starts that are allowed by the energy and do not lie beyond an exit.
#
# A bounded pixel has not escaped by `T_MAX`, or there is evidence that it never escapes (`docs/trust.md`). SALI classifies
# the bounded orbits as regular or chaotic.

# %%
escape_map = compute_map(MapSpec(CASE, Plane.X_PX, ENERGY, (SIDE, SIDE), t_max=T_MAX))
shares = escape_map.fractions()
print("bounded:", f"{shares[Fate.BOUNDED]:.4f}")
for channel in range(1, CASE.channels + 1):
    print(f"channel {channel}: {shares[channel]:.4f}")
print(f"worst energy error: {escape_map.worst_energy_error:.1e}")
print(f"chaotic among the bounded: {compute_regularity(escape_map).chaotic_share:.4f}")

# %% [markdown]
# The potential is even in x, so orbits from (x, px) and (−x, −px) are mirror images. Channels 1 and 2 therefore have exactly the
# same share, and so have channels 3 and 4. All starts have py > 0, which favours the upper channels 1 and 2.
#
# ## Reliable pixels
#
# Near a fractal basin boundary the fate changes when the start moves by much less than a pixel, or with the tolerance. Shares
# of such pixels are meaningful, single pixels are not. `compute_trust` integrates every boundary pixel twice more and marks the
# pixels whose fate changes.

# %%
trust = compute_trust(escape_map)
print(f"doubtful pixels: {trust.doubtful_share:.4f}")

# %% [markdown]
# ## Two orbits
#
# We compare a bounded orbit and the orbit with the longest escape time. SALI, the smaller alignment index, stays of order one on
# a torus and decreases exponentially along a chaotic orbit. Along a sticky orbit this begins only when the orbit leaves the
# surroundings of an island. An escaping orbit is called neither regular nor chaotic. Its SALI shows whether neighbouring orbits
# diverge.

# %%
rows, columns = np.nonzero(escape_map.fate == Fate.BOUNDED)
x, px = escape_map.x[columns], escape_map.ordinate[rows]
central = np.argmin(np.hypot(x - x.mean(), px - px.mean()))
longest = np.unravel_index(np.nanargmax(escape_map.escape_time), escape_map.fate.shape)
pixels = {"bounded": (rows[central], columns[central]), "late": longest}
orbits = {}
for name, (row, column) in pixels.items():
    start = start_states(CASE, Plane.X_PX, ENERGY, escape_map.x[[column]], escape_map.ordinate[[row]])[0]
    orbits[name] = integrate_orbit(CASE, start, T_MAX)
    print(f"{name} orbit: SALI {orbits[name].sali[-1]:.2e}. {judge_orbit(orbits[name]).describe()}")

figure, (path, index) = plt.subplots(1, 2, figsize=(10, 4.5), layout="constrained")
for (name, orbit), colour in zip(orbits.items(), ("teal", "firebrick"), strict=True):
    part = slice(0, 3000)
    path.plot(orbit.x[part], orbit.y[part], lw=0.4, color=colour, label=name)
    index.loglog(orbit.t[1:], np.maximum(orbit.sali[1:], 1e-16), lw=0.8, color=colour)
path.set(xlabel="x", ylabel="y", aspect="equal", title=f"III, h = {ENERGY}")
path.legend(loc="upper right")
index.axhline(1e-7, color="grey", lw=0.8)
index.set(xlabel="t", ylabel="SALI", title="SALI; chaotic below the line")
figure.savefig("orbits.png", dpi=120)
plt.close(figure)

# %% [markdown]
# ## Escapes against energy
#
# Zotos (2014) fits the escaping share by ½[1 + tanh(15.85 h − 4.93)]. We count this share at nine energies, and the share of
# direct escapes, which do not cross y = 0. The counts differ from the fit for three reasons. The paper counts some starts outside
# the exits as escaped, while the shares here refer to the interior. The function is only a convention. This grid is coarse.

# %%
energies = np.linspace(0.27, 0.67, 9)
sweep = compute_sweep(SweepSpec(CASE, Plane.X_PX, energies, (100, 100), t_max=T_MAX, measures=("shares", "basin_entropy")))
escaped = sweep["share"][:, 1:].sum(axis=1)
published = 0.5 * (1.0 + np.tanh(15.85 * energies - 4.93))
print(f"published fit: at most {100.0 * np.abs(published - escaped).max():.1f} percentage points from the counts")

# %% [markdown]
# ## Predictability of the channel
#
# Basin entropy measures the predictability by one number, S_b: the mean entropy of the fates in boxes of 5 × 5 starts. S_b is
# 0 if every box has a single fate, and ln 5 if four channels and bounded motion are equally likely everywhere. S_bb is the mean
# over boxes with several fates. S_bb > ln 2 means that the boundary is not smooth at this scale (`docs/measures.md`). The sweep
# above has measured both.

# %%
for h, s_b, s_bb in zip(energies, sweep["s_b"], sweep["s_bb"], strict=True):
    print(f"h = {h:.2f}: S_b {s_b:.4f}, S_bb {s_bb:.4f}{', above ln 2' if s_bb > np.log(2.0) else ''}")

figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
left.plot(energies, escaped, "ko", label="counted")
left.plot(energies, published, "--", color="grey", label="published fit")
left.plot(energies, sweep["direct_share"], "s", mfc="none", color="firebrick", label="direct")
left.set(xlabel="h", ylabel="share of the starts")
left.legend()
right.errorbar(energies, sweep["s_b"], sweep["s_b_error"], fmt="o-", label="S_b")
right.errorbar(energies, sweep["s_bb"], sweep["s_bb_error"], fmt="s-", label="S_bb")
right.axhline(np.log(2.0), color="grey", ls=":", label="ln 2")
right.set(xlabel="h", ylabel="basin entropy, nats")
right.legend()
figure.savefig("against-energy.png", dpi=120)
plt.close(figure)

# %% [markdown]
# ## Save and load
#
# `save` writes a NetCDF file with named axes and the provenance of the map: potential, window, integrator and version. xarray
# reads the file as a dataset, and `open_result` reads it as the map.

# %%
escape_map.save("case-three.nc")

with xr.open_dataset("case-three.nc") as loaded:
    dataset = loaded.load()
print(f"loaded: h = {dataset.attrs['energy']}, {dict(dataset.sizes)}, {dataset.attrs['integrator']}")

colours = ["white", "lightgrey", "tab:green", "tab:red", "tab:blue", "tab:orange"]
shown = dataset["fate"].where(dataset["fate"] >= 0, -1)
figure, (basins, times) = plt.subplots(1, 2, figsize=(11, 4.8), layout="constrained")
shown.plot.imshow(
    ax=basins,
    cmap=ListedColormap(colours),
    norm=BoundaryNorm(np.arange(-1.5, 5.0), len(colours)),
    cbar_kwargs={"ticks": range(-1, 5), "label": "−1 no start, 0 bounded, k channel"},
)
xr.ufuncs.log10(dataset["escape_time"]).plot.imshow(ax=times, cmap="magma_r", cbar_kwargs={"label": "log10 of the escape time"})
basins.set(title=f"basins of escape, III, h = {ENERGY}", aspect="equal")
times.set(title="escape times", aspect="equal")
figure.savefig("basins.png", dpi=120)
plt.close(figure)

# %% [markdown]
# ## More functions
#
# - `find_divergent_start` finds the nearest start with another fate.
# - `compute_separation` computes the distance of two orbits against time.
# - `find_stable_manifolds` computes the curves that bound the basins.
# - `compute_wada_test` tests whether the boundaries are Wada.
# - `fit_decay_laws` tells exponential from algebraic decay.
# - `compute_sweep` with a store computes maps at hundreds of energies, and resumes after an interruption (`docs/sweeps.md`).
