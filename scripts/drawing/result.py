"""A result file, and its cells cut into triangles fine enough to show curved edges."""

import sys

import h5py
import numpy as np

from drawing import shapes
from drawing.cells import cells_of
from drawing.units import units_of

# What of a contact table changes from step to step.
STATES = ("gap", "force", "pressure", "status", "tangential_force", "slip")


class Result:
    """What a result file holds, in its units, with the partitions joined; nodes keep their subdomain."""

    def __init__(self, path, step=None):
        with h5py.File(path) as file:
            self.units = units_of(file)
            grid = file["VTKHDF"]
            self.steps = int(grid["Steps"].attrs["NSteps"]) if "Steps" in grid else 1
            self.step = self.steps if step is None else step
            if not 1 <= self.step <= self.steps:
                sys.exit(f"figures: {path}: there is no step {step}; expected 1 to {self.steps}")
            if "Displacement" not in grid["PointData"]:
                sys.exit(f"figures: {path}: is a problem file; contact-dd-mpi {path} solves it")
            if "Stress" not in grid["PointData"]:
                sys.exit(f"figures: {path}: there are no stresses; expected a run without --no-stress")
            self.points = grid["Points"][:, :2]
            self.tags = grid["PointData/GlobalNodeId"][:]
            self.displacement = of_step(grid, "PointData/Displacement", self.step)[:, :2]
            self.stress = of_step(grid, "PointData/Stress", self.step)
            self.cell_stress = of_step(grid, "CellData/Stress", self.step)
            subdomain = grid["CellData/Subdomain"][:]
            self.cells = list(cells_of(grid))
            self.contacts = {
                name: {key: state(table, key, self.step) for key in table}
                for name, table in file.get("contact", {}).items()
            }
        if not self.cells:
            sys.exit(f"figures: {path}: there are no cells to draw")
        for kind, _, _ in self.cells:
            if kind not in shapes.CELLS:
                sys.exit(f"figures: {path}: VTK cell type {kind} can't be drawn; plane cells can")
        self.size = max(np.ptp(self.points, axis=0))
        self.facets, owner = self.all_facets(subdomain)
        self.outline, self.borders = self.outline_and_borders(owner)
        # Linear cells don't bend, and that many quadratic ones show no kinks.
        steps = 3 if len(self.cell_stress) < 20_000 else 2
        self.weights, self.nodes, self.triangles, self.cell_of_triangle = self.cut(steps)

    def all_facets(self, subdomain):
        """Facets of all cells from corner to corner, three nodes each, and the subdomain of each.

        In the middle of a facet with two nodes stands -1."""
        facets, owner = [], []
        for kind, members, nodes in self.cells:
            for facet in shapes.CELLS[kind].facets:
                if len(facet) == 2:
                    a, b = nodes[:, facet].T
                    facets.append(np.stack([a, np.full_like(a, -1), b], axis=1))
                else:
                    facets.append(nodes[:, facet])
                owner.append(subdomain[members])
        return np.concatenate(facets), np.concatenate(owner)

    def outline_and_borders(self, owner):
        """Facets of one cell only, crack faces among them, and facets between two subdomains."""
        key = np.sort(self.tags[self.facets[:, [0, 2]]], axis=1)
        _, first, inverse, count = np.unique(
            key, axis=0, return_index=True, return_inverse=True, return_counts=True
        )
        inverse = inverse.ravel()
        least = np.full(len(count), owner.max())
        most = np.zeros(len(count), dtype=least.dtype)
        np.minimum.at(least, inverse, owner)
        np.maximum.at(most, inverse, owner)
        return self.facets[first[count == 1]], self.facets[first[least != most]]

    def cut(self, steps):
        """Cells as triangles between points that are sums of nodes by weights."""
        weights, nodes, triangles, owner = [], [], [], []
        count = 0
        for kind, members, of_cell in self.cells:
            cell = shapes.CELLS[kind]
            at, corners = cell.pattern(steps)
            values = cell.values(at)
            wide = np.zeros((len(members), len(at), shapes.MOST))
            wide[:, :, : values.shape[1]] = values
            padded = np.zeros((len(members), len(at), shapes.MOST), dtype=of_cell.dtype)
            padded[:, :, : values.shape[1]] = of_cell[:, None, :]
            weights.append(wide.reshape(-1, shapes.MOST))
            nodes.append(padded.reshape(-1, shapes.MOST))
            starts = count + len(at) * np.arange(len(members))
            triangles.append((starts[:, None, None] + corners).reshape(-1, 3))
            owner.append(np.repeat(members, len(corners)))
            count += len(at) * len(members)
        return tuple(np.concatenate(part) for part in (weights, nodes, triangles, owner))

    def at_points(self, values):
        """What nodes have, at the points of the triangles, by the cells' shape functions."""
        return np.einsum("pk,pk...->p...", self.weights, values[self.nodes])

    def deformed(self, scale):
        return self.points + scale * self.displacement

    def centers(self):
        """Centre of each cell, the mean of its triangles'."""
        sums = np.zeros((len(self.cell_stress), 2))
        middle = self.at_points(self.points)[self.triangles].mean(axis=1)
        np.add.at(sums, self.cell_of_triangle, middle)
        return sums / np.bincount(self.cell_of_triangle, minlength=len(sums))[:, None]


def of_step(grid, name, step):
    """The rows of a step; those of all steps follow each other."""
    steps = int(grid["Steps"].attrs["NSteps"]) if "Steps" in grid else 1
    rows = len(grid[name]) // steps
    return grid[name][(step - 1) * rows : step * rows]


def state(table, key, step):
    """What a contact table has in a step: of what changes there is a row for every step."""
    changes = table["status"].ndim == 2 and key in STATES
    return table[key][step - 1] if changes else table[key][:]


def curves(points, facets):
    """Lines along facets, curved where they have a node in the middle."""
    straight = facets[facets[:, 1] < 0]
    bent = facets[facets[:, 1] >= 0]
    lines = list(points[straight[:, [0, 2]]])
    s = np.linspace(0.0, 1.0, 7)[:, None]
    a, m, b = (points[bent[:, k], None] for k in range(3))
    lines.extend((1 - s) * (1 - 2 * s) * a + 4 * s * (1 - s) * m + s * (2 * s - 1) * b)
    return lines


def von_mises(stress):
    xx, yy, zz, xy, yz, xz = stress.T
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.sqrt(normal / 2 + 3 * (xy**2 + yz**2 + xz**2))
