"""Draws the pictures of a result file; run it by scripts/figures.

The seven pictures of the paper: deformation, u_x, u_y, tau_x, tau_y, tau_xy, principal stresses;
and an overview: the deformed shape by von Mises stress with the contact pressures on it.
"""

import argparse
import pathlib
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation
from PIL import Image

LARGEST_PNG = 300_000

# By VTK's number of the cell: its triangles, and its facets from corner to corner.
TRIANGLES = {
    5: [(0, 1, 2)],
    9: [(0, 1, 2), (0, 2, 3)],
    22: [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
    23: [(0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 6), (4, 6, 7)],
    28: [(0, 4, 8), (0, 8, 7), (4, 1, 5), (4, 5, 8), (8, 5, 2), (8, 2, 6), (7, 8, 6), (7, 6, 3)],
}
FACETS = {
    5: [(0, 1), (1, 2), (2, 0)],
    9: [(0, 1), (1, 2), (2, 3), (3, 0)],
    22: [(0, 3, 1), (1, 4, 2), (2, 5, 0)],
    23: [(0, 4, 1), (1, 5, 2), (2, 6, 3), (3, 7, 0)],
    28: [(0, 4, 1), (1, 5, 2), (2, 6, 3), (3, 7, 0)],
}


class Result:
    """What a result file holds, with the partitions joined; nodes keep their subdomain."""

    def __init__(self, path):
        with h5py.File(path) as file:
            grid = file["VTKHDF"]
            self.points = grid["Points"][:, :2]
            self.tags = grid["PointData/GlobalNodeId"][:]
            self.displacement = grid["PointData/Displacement"][:, :2]
            self.stress = grid["PointData/Stress"][:]
            self.cell_stress = grid["CellData/Stress"][:]
            subdomain = grid["CellData/Subdomain"][:]
            cells = list(cells_of(grid))
            self.contacts = {
                name: {key: table[key][:] for key in table}
                for name, table in file.get("contact", {}).items()
            }
        if not cells:
            sys.exit(f"figures: {path}: there are no cells to draw")
        self.size = max(np.ptp(self.points, axis=0))
        self.triangles, self.cell_of_triangle, facets, owner = [], [], [], []
        for kind, members, nodes in cells:
            if kind not in TRIANGLES:
                sys.exit(f"figures: {path}: VTK cell type {kind} can't be drawn; plane cells can")
            for triangle in TRIANGLES[kind]:
                self.triangles.append(nodes[:, triangle])
                self.cell_of_triangle.append(members)
            for facet in FACETS[kind]:
                for a, b in zip(facet, facet[1:]):
                    facets.append(nodes[:, [a, b]])
                    owner.append(subdomain[members])
        self.triangles = np.concatenate(self.triangles)
        self.cell_of_triangle = np.concatenate(self.cell_of_triangle)
        self.edges = np.concatenate(facets)
        self.outline, self.borders = self.outline_and_borders(np.concatenate(owner))

    def outline_and_borders(self, owner):
        """Edges of one cell only, crack faces among them, and edges between two subdomains."""
        key = np.sort(self.tags[self.edges], axis=1)
        _, first, inverse, count = np.unique(
            key, axis=0, return_index=True, return_inverse=True, return_counts=True
        )
        inverse = inverse.ravel()
        least = np.full(len(count), owner.max())
        most = np.zeros(len(count), dtype=least.dtype)
        np.minimum.at(least, inverse, owner)
        np.maximum.at(most, inverse, owner)
        return self.edges[first[count == 1]], self.edges[first[least != most]]

    def deformed(self, scale):
        return self.points + scale * self.displacement

    def centers(self):
        """Centre of each cell, the mean of its triangles'."""
        sums = np.zeros((len(self.cell_stress), 2))
        np.add.at(sums, self.cell_of_triangle, self.points[self.triangles].mean(axis=1))
        return sums / np.bincount(self.cell_of_triangle, minlength=len(sums))[:, None]


def cells_of(grid):
    """Cells of every kind: VTK's number, indices of the cells, their nodes among all nodes."""
    types = grid["Types"][:]
    offsets, connectivity = grid["Offsets"][:], grid["Connectivity"][:]
    starts, ends, nodes = [], [], []
    at = {"point": 0, "cell": 0, "id": 0}
    sizes = (grid[f"NumberOf{name}"][:] for name in ("Points", "Cells", "ConnectivityIds"))
    for partition, (points, cells, ids) in enumerate(zip(*sizes)):
        # Each partition has an offset more than cells.
        own = offsets[at["cell"] + partition :][: cells + 1] + at["id"]
        starts.append(own[:-1])
        ends.append(own[1:])
        nodes.append(connectivity[at["id"] :][:ids] + at["point"])
        at = {"point": at["point"] + points, "cell": at["cell"] + cells, "id": at["id"] + ids}
    starts, ends, nodes = (np.concatenate(part) for part in (starts, ends, nodes))
    for kind in np.unique(types):
        members = np.flatnonzero(types == kind)
        width = ends[members[0]] - starts[members[0]]
        yield int(kind), members, nodes[starts[members, None] + np.arange(width)]


def canvas(title):
    figure, axes = plt.subplots(figsize=(6.8, 5.8), layout="constrained")
    axes.set_aspect("equal")
    axes.set_title(title)
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def lines(axes, points, edges, **style):
    axes.add_collection(LineCollection(points[edges], capstyle="round", **style))


def legend(axes, columns):
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncol=columns, frameon=False)


def save(figure, path):
    """Saves a PNG; where it would be too large with fewer colours, then with fewer pixels."""
    for dpi in (150, 120, 100, 80, 60):
        figure.savefig(path, dpi=dpi)
        if path.stat().st_size > LARGEST_PNG:
            Image.open(path).convert("RGB").quantize(64).save(path, optimize=True)
        if path.stat().st_size <= LARGEST_PNG:
            break
    plt.close(figure)
    print(path)


def in_units(values, unit):
    """Values and unit with the prefix that suits them."""
    largest = np.abs(values).max(initial=0.0)
    for factor, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m")):
        if largest >= factor:
            return values / factor, prefix + unit
    return (values / 1e-6, "µ" + unit) if largest > 0 else (values, unit)


def levels(values):
    """Some 20 round levels; the few values at singular points don't stretch them."""
    low, high = np.percentile(values, [0.5, 99.5])
    if high - low <= 1e-9 * max(abs(low), abs(high), 1e-300):
        middle, half = (low + high) / 2, max(abs(low) * 1e-3, 1e-12)
        low, high = middle - half, middle + half
    return MaxNLocator(nbins=20, min_n_ticks=10).tick_values(low, high)


def contours(result, values, name, unit, path):
    values, unit = in_units(values, unit)
    steps = levels(values)
    signed = steps[0] < 0 < steps[-1] and min(-steps[0], steps[-1]) > 0.1 * max(-steps[0], steps[-1])
    figure, axes = canvas(f"{name} [{unit}]")
    style = {"cmap": "viridis"}
    if signed:
        bound, step = max(-steps[0], steps[-1]), steps[1] - steps[0]
        norm, cmap = plt.Normalize(-bound, bound), plt.get_cmap("RdBu_r")
        # Beyond the levels the colours go on, they don't jump to the ends of the map.
        below, above = cmap(norm(steps[0] - step)), cmap(norm(steps[-1] + step))
        style = {"cmap": cmap.with_extremes(under=below, over=above), "norm": norm}
    mesh = Triangulation(*result.points.T, result.triangles)
    filled = axes.tricontourf(mesh, values, steps, extend="both", antialiased=False, **style)
    axes.tricontour(mesh, values, steps, colors="k", linewidths=0.25, alpha=0.5, linestyles="solid")
    lines(axes, result.points, result.outline, colors="k", linewidths=1.0)
    figure.colorbar(filled, ax=axes, shrink=0.9, label=unit)
    save(figure, path)


def deformation(result, scale, path):
    figure, axes = canvas(f"Deformation, enlarged {scale:g} times")
    moved = result.deformed(scale)
    fine = len(result.edges) > 60_000
    edges = result.borders if fine else result.edges
    lines(axes, moved, edges, colors="0.45", linewidths=0.5 if fine else 0.3)
    lines(axes, result.points, result.outline, colors="tab:blue", linewidths=0.8)
    lines(axes, moved, result.outline, colors="k", linewidths=1.1)
    axes.plot([], [], color="tab:blue", lw=0.8, label="undeformed")
    axes.plot([], [], color="k", lw=1.1, label="deformed")
    axes.autoscale()
    legend(axes, 2)
    save(figure, path)


def thinned(centers, size, across):
    """Of each square of a grid the cell that is nearest to the square's middle."""
    step = size / across
    square = np.floor((centers - centers.min(axis=0)) / step)
    middle = (square + 0.5) * step + centers.min(axis=0)
    order = np.argsort(np.linalg.norm(centers - middle, axis=1), kind="stable")
    _, first = np.unique(square[order], axis=0, return_index=True)
    return order[first], step


def principal(result, path):
    chosen, step = thinned(result.centers(), result.size, across=22)
    centers = result.centers()[chosen]
    xx, yy, _, xy, *_ = result.cell_stress[chosen].T
    mean, radius = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    largest = max(np.percentile(np.abs(mean) + radius, 98), 1e-300)

    figure, axes = canvas("Principal stresses")
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
    shown, unit = in_units(np.array([largest]), "Pa")
    axes.plot([], [], color="tab:red", label="tension ←→")
    axes.plot([], [], color="tab:blue", label="compression →←")
    axes.plot([], [], " ", label=f"longest arm: {shown[0]:.3g} {unit}")
    legend(axes, 3)
    save(figure, path)


def von_mises(stress):
    xx, yy, zz, xy, yz, xz = stress.T
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.sqrt(normal / 2 + 3 * (xy**2 + yz**2 + xz**2))


def overview(result, scale, path):
    values, unit = in_units(von_mises(result.stress), "Pa")
    figure, axes = canvas(f"Von Mises stress and contact pressure, deformation × {scale:g}")
    moved = result.deformed(scale)
    colors = axes.tripcolor(
        Triangulation(*moved.T, result.triangles), values, shading="gouraud", cmap="viridis",
        vmin=0, vmax=np.percentile(values, 99.5),
    )
    lines(axes, moved, result.borders, colors="w", linewidths=0.4, alpha=0.8)
    lines(axes, moved, result.outline, colors="k", linewidths=0.8)
    figure.colorbar(colors, ax=axes, shrink=0.9, label=f"von Mises stress [{unit}]", extend="max")
    pressures(axes, result, scale)
    axes.autoscale()
    save(figure, path)


def pressures(axes, result, scale):
    """A stick for each closed contact condition, along the normal that side a has there."""
    tables = [table for table in result.contacts.values() if len(table["gap"])]
    if not tables:
        return
    position, normal, pressure, node = (
        np.concatenate([table[key] for table in tables])
        for key in ("position", "normal", "pressure", "node_a")
    )
    order = np.argsort(result.tags, kind="stable")
    found = order[np.searchsorted(result.tags[order], node).clip(max=len(order) - 1)]
    known = (result.tags[found] == node)[:, None]
    foot = position[:, :2] + np.where(known, scale * result.displacement[found], 0.0)
    largest = pressure.max()
    if largest > 0:
        tip = foot + 0.1 * result.size * (pressure / largest)[:, None] * normal[:, :2]
        sticks = np.stack([foot, tip], axis=1)[pressure > 0]
        axes.add_collection(LineCollection(sticks, colors="tab:red", linewidths=1.3))
    opened = pressure <= 0
    axes.plot(*foot[opened].T, "o", ms=3, mfc="w", mec="tab:red", mew=0.7)
    (shown,), unit = in_units(np.array([largest]), "Pa")
    axes.plot([], [], color="tab:red", label=f"contact pressure, at most {shown:.3g} {unit}")
    if opened.any():
        axes.plot([], [], "o", ms=3, mfc="w", mec="tab:red", mew=0.7, label="open contact")
    legend(axes, 2)


def automatic_scale(result):
    """The round factor with which the largest displacement is about a twentieth of the size."""
    largest = np.linalg.norm(result.displacement, axis=1).max()
    if largest == 0:
        return 1.0
    wanted = 0.05 * result.size / largest
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(power * max(step for step in (1, 2, 5) if step * power <= wanted * (1 + 1e-9)))


def factor(text):
    return None if text == "auto" else float(text)


def main():
    parser = argparse.ArgumentParser(prog="figures", description=__doc__.splitlines()[0])
    parser.add_argument("result", type=pathlib.Path, help="result file of contact-dd-mpi")
    parser.add_argument("outdir", type=pathlib.Path, nargs="?", help="folder (default: figures beside the result)")
    parser.add_argument("--scale", type=factor, default=50.0, help="enlargement of the deformation, or auto (default: 50)")
    arguments = parser.parse_args()
    try:
        result = Result(arguments.result)
    except (OSError, KeyError) as error:
        sys.exit(f"figures: {arguments.result}: not a result file: {error}")
    scale = arguments.scale or automatic_scale(result)
    outdir = arguments.outdir or arguments.result.parent / "figures"
    outdir.mkdir(parents=True, exist_ok=True)

    deformation(result, scale, outdir / "deformation.png")
    for component, name in enumerate(("x", "y")):
        values = result.displacement[:, component]
        contours(result, values, f"Displacement $u_{name}$", "m", outdir / f"u_{name}.png")
    for component, name in ((0, "x"), (1, "y"), (3, "xy")):
        values = result.stress[:, component]
        title = f"Stress $\\tau_{{{name}}}$"
        contours(result, values, title, "Pa", outdir / f"tau_{name}.png")
    principal(result, outdir / "principal.png")
    overview(result, scale, outdir / "overview.png")


if __name__ == "__main__":
    main()
