"""The pictures of the paper: deformation, displacements, stresses, principal stresses."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation

from contact_dd.drawing.canvas import canvas, legend, lines
from contact_dd.drawing.units import in_units


def levels(values):
    """Some 20 round levels; the few values at singular points don't stretch them."""
    low, high = np.percentile(values, [0.5, 99.5])
    if high - low <= 1e-9 * max(abs(low), abs(high), 1e-300):
        middle, half = (low + high) / 2, max(abs(low) * 1e-3, 1e-12)
        low, high = middle - half, middle + half
    return MaxNLocator(nbins=20, min_n_ticks=10).tick_values(low, high)


def contours(result, values, name, unit):
    values, unit = in_units(values, unit)
    steps = levels(values)
    signed = steps[0] < 0 < steps[-1] and min(-steps[0], steps[-1]) > 0.1 * max(-steps[0], steps[-1])
    figure, axes = canvas(f"{name} [{unit}]", result.units)
    style = {"cmap": "viridis"}
    if signed:
        bound, step = max(-steps[0], steps[-1]), steps[1] - steps[0]
        norm, cmap = plt.Normalize(-bound, bound), plt.get_cmap("RdBu_r")
        # Beyond the levels the colours go on, they don't jump to the ends of the map.
        below, above = cmap(norm(steps[0] - step)), cmap(norm(steps[-1] + step))
        style = {"cmap": cmap.with_extremes(under=below, over=above), "norm": norm}
    mesh = Triangulation(*result.at_points(result.points).T, result.triangles)
    values = result.at_points(values)
    filled = axes.tricontourf(mesh, values, steps, extend="both", antialiased=False, **style)
    axes.tricontour(mesh, values, steps, colors="k", linewidths=0.25, alpha=0.5, linestyles="solid")
    lines(axes, result.points, result.outline, colors="k", linewidths=1.0)
    figure.colorbar(filled, ax=axes, shrink=0.9, label=unit)
    return figure


def deformation(result, scale):
    figure, axes = canvas(f"Deformation, enlarged {scale:g} times", result.units)
    moved = result.deformed(scale)
    fine = len(result.facets) > 60_000
    facets = result.borders if fine else result.facets
    lines(axes, moved, facets, colors="0.45", linewidths=0.5 if fine else 0.3)
    lines(axes, result.points, result.outline, colors="tab:blue", linewidths=0.8)
    lines(axes, moved, result.outline, colors="k", linewidths=1.1)
    axes.plot([], [], color="tab:blue", lw=0.8, label="undeformed")
    axes.plot([], [], color="k", lw=1.1, label="deformed")
    axes.autoscale()
    legend(axes, 2)
    return figure


def thinned(centers, size, across):
    """Of each square of a grid the cell that is nearest to the square's middle."""
    step = size / across
    square = np.floor((centers - centers.min(axis=0)) / step)
    middle = (square + 0.5) * step + centers.min(axis=0)
    order = np.argsort(np.linalg.norm(centers - middle, axis=1), kind="stable")
    _, first = np.unique(square[order], axis=0, return_index=True)
    return order[first], step


def principal(result):
    all_centers = result.centers()
    chosen, step = thinned(all_centers, result.size, across=22)
    centers = all_centers[chosen]
    xx, yy, _, xy, *_ = result.cell_stress[chosen].T
    mean, radius = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    largest = max(np.percentile(np.abs(mean) + radius, 98), 1e-300)

    figure, axes = canvas("Principal stresses", result.units)
    lines(axes, result.points, result.outline, colors="k", linewidths=1.0)
    axes.autoscale()
    for value, turn in ((mean + radius, angle), (mean - radius, angle + np.pi / 2)):
        length = 0.6 * step * np.clip(np.abs(value) / largest, 0, 1)
        along = np.stack([np.cos(turn), np.sin(turn)], axis=1)
        for sign, pivot, color in ((1, "tail", "tab:red"), (-1, "tip", "tab:blue")):
            drawn = (sign * value > 0) & (np.abs(value) > 0.03 * largest)
            for side in (1, -1):
                # Tension starts in the middle, compression ends a little before it.
                foot = centers + side * (0.02 if sign > 0 else 0.07) * step * along
                axes.quiver(
                    *foot[drawn].T, *(sign * side * length[:, None] * along)[drawn].T, color=color,
                    pivot=pivot, angles="xy", scale_units="xy", scale=1, units="xy",
                    width=0.035 * step, headwidth=3.6, headlength=4, headaxislength=3.6, minlength=0.1,
                )
    shown, unit = in_units(np.array([largest]), result.units.stress)
    axes.plot([], [], color="tab:red", label="tension ←→")
    axes.plot([], [], color="tab:blue", label="compression →←")
    axes.plot([], [], " ", label=f"longest arm: {shown[0]:.3g} {unit}")
    legend(axes, 3)
    return figure
