"""The pictures of the paper: deformation, displacements, stresses, principal stresses."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

from contact_dd.drawing.canvas import canvas, deformation_of, legend, lines, round_below
from contact_dd.drawing.units import in_units

# The steps between levels, times a power of ten.
ROUND = [1, 2, 5, 10]
# Half of the longest line of a cross over the distance of crosses.
ARM = 0.48
# Crosses along the larger side.
ACROSS = 18
# Stresses below this part of the largest aren't drawn.
LEAST = 0.02
# Signs of stresses and their colours.
SIGNS = {"tension": (1, "tab:red"), "compression": (-1, "tab:blue")}


def levels(values):
    """Some 20 round levels; the few values at singular points don't stretch them."""
    low, high = np.percentile(values, [0.5, 99.5])
    if high - low <= 1e-9 * max(abs(low), abs(high), 1e-300):
        middle, half = (low + high) / 2, max(abs(low) * 1e-3, 1e-12)
        low, high = middle - half, middle + half
    return MaxNLocator(nbins=20, min_n_ticks=10, steps=ROUND).tick_values(low, high)


def contours(result, values, name, unit):
    values, unit = in_units(values, unit)
    steps = levels(values)
    signed = steps[0] < 0 < steps[-1] and min(-steps[0], steps[-1]) > 0.1 * max(-steps[0], steps[-1])
    figure, axes = canvas(name, result.units, result.points)
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
    figure.colorbar(filled, ax=axes, shrink=0.9, label=unit, ticks=MaxNLocator(nbins=9, steps=ROUND))
    return figure


def deformation(result, scale):
    moved = result.deformed(scale)
    figure, axes = canvas(deformation_of(result, scale).capitalize(), result.units, moved)
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


def grid_of(result):
    """Points of an even grid inside the bodies, the cell around each, and the step between them."""
    low, high = result.points.min(axis=0), result.points.max(axis=0)
    step = max(high - low) / ACROSS
    counts = np.maximum((high - low) / step, 1).astype(int)
    # As far from the edges on the left as on the right.
    axes = [a + (b - a - (n - 1) * step) / 2 + step * np.arange(n) for a, b, n in zip(low, high, counts)]
    points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    mesh = Triangulation(*result.at_points(result.points).T, result.triangles)
    triangle = containing(mesh, points)
    return points[triangle >= 0], result.cell_of_triangle[triangle[triangle >= 0]], step


def containing(mesh, points):
    """The triangle around each point, -1 where there is none.

    Matplotlib's own search doesn't take triangles that meet in points of their own, as these do."""
    corners = np.stack([mesh.x, mesh.y], axis=1)[mesh.triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    found = np.full(len(points), -1)
    (ax, ay), (bx, by), (cx, cy) = (corners[:, k].T for k in range(3))
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    for k, (x, y) in enumerate(points):
        near = np.flatnonzero((low[:, 0] <= x) & (x <= high[:, 0]) & (low[:, 1] <= y) & (y <= high[:, 1]) & (area != 0))
        s = ((x - ax[near]) * (cy - ay)[near] - (cx - ax)[near] * (y - ay[near])) / area[near]
        t = ((bx - ax)[near] * (y - ay[near]) - (x - ax[near]) * (by - ay)[near]) / area[near]
        inside = near[(s >= 0) & (t >= 0) & (s + t <= 1)]
        if len(inside):
            found[k] = inside[0]
    return found


def principal(result):
    centers, chosen, step = grid_of(result)
    xx, yy, _, xy, *_ = result.cell_stress[chosen].T
    mean, radius = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    largest = max(np.percentile(np.abs(mean) + radius, 98), 1e-300)

    figure, axes = canvas("Principal stresses", result.units, result.points)
    lines(axes, result.points, result.outline, colors="k", linewidths=1.0)
    axes.autoscale()
    for value, turn in ((mean + radius, angle), (mean - radius, angle + np.pi / 2)):
        length = ARM * step * np.clip(np.abs(value) / largest, 0, 1)
        arm = length[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        drawn = np.abs(value) > LEAST * largest
        ends = np.stack([centers - arm, centers + arm], axis=1)
        for sign, color in SIGNS.values():
            axes.add_collection(LineCollection(ends[drawn & (sign * value > 0)], colors=color, linewidths=1.8))
    (shown,), unit = in_units(np.array([largest]), result.units.stress)
    long = round_below(shown)
    for name, (_, color) in SIGNS.items():
        axes.plot([], [], color=color, lw=1.8, label=name)
    # Beside the axes on the top, where nothing is.
    axes.add_artist(AnchoredSizeBar(
        axes.transData, 2 * ARM * step * long / shown, f"{long:g} {unit}", loc="lower right", bbox_to_anchor=(1, 1),
        bbox_transform=axes.transAxes, frameon=False, pad=0.1, sep=6, size_vertical=0.04 * step,
    ))
    legend(axes, 2)
    return figure
