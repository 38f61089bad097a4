"""A result in the plane, its cells cut into triangles fine enough to show curved edges."""

import numpy as np

from contact_dd.drawing import shapes
from contact_dd.drawing.carried import pressing
from contact_dd.drawing.units import units_of
from contact_dd.errors import InputError


class Plane:
    """A result in the plane, as it is drawn."""

    def __init__(self, result):
        if len(result.stress) == 0:
            raise InputError(f"{result.path}: there are no stresses; expected a run without --no-stress")
        if not result.cells:
            raise InputError(f"{result.path}: there are no cells to draw")
        self.result, self.units = result, units_of(result)
        self.step, self.steps = result.step, result.steps
        self.points, self.tags = result.points[:, :2], result.nodes
        self.displacement, self.stress = result.displacement[:, :2], result.stress
        self.since, self.deformation = result.since, result.deformation[:, :2]
        self.cells, self.cell_stress = result.cells, result.cell_data["Stress"]
        self.contacts = pressing(result)
        for kind, _, _ in self.cells:
            if kind not in shapes.CELLS:
                raise InputError(f"{result.path}: VTK cell type {kind} can't be drawn; plane cells can")
        self.size = max(np.ptp(self.points, axis=0))
        self.facets, owner = self.all_facets(result.cell_data["Subdomain"])
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
        """Values of nodes at the points of the triangles, by the cells' shape functions."""
        return np.einsum("pk,pk...->p...", self.weights, values[self.nodes])

    def normals(self):
        """The mean of the outward normals of the facets around each node on the surface, 0 elsewhere."""
        normals, count = np.zeros((len(self.points), 2)), np.zeros(len(self.points))
        along = self.points[self.outline[:, 2]] - self.points[self.outline[:, 0]]
        # Cells lie to the left of their facets.
        outward = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
        one = np.searchsorted(self.tags, self.tags)
        for nodes in self.outline.T:
            np.add.at(normals, one[nodes[nodes >= 0]], outward[nodes >= 0])
            np.add.at(count, one[nodes[nodes >= 0]], 1)
        return normals / np.maximum(count, 1)[:, None]

    def lengths(self, nodes):
        """The length of the surface that belongs to each of these nodes: of facets between them; around an axis times
        the radius."""
        share = np.zeros(len(self.points))
        one = np.searchsorted(self.tags, self.tags)
        is_meant = np.isin(np.arange(len(one)), nodes)
        for ends, weights in (([0, 2], [1 / 2, 1 / 2]), ([0, 1, 2], [1 / 6, 2 / 3, 1 / 6])):
            facets = one[self.outline[(self.outline[:, 1] < 0) == (len(ends) == 2)][:, ends]]
            facets = facets[is_meant[facets].all(axis=1)]
            length = np.linalg.norm(self.points[facets[:, -1]] - self.points[facets[:, 0]], axis=1)
            if self.result.plane == "axisymmetric":
                length = length * self.points[facets, 0].mean(axis=1)
            np.add.at(share, facets, length[:, None] * weights)
        return share[nodes]

    def deformed(self, scale):
        return self.points + scale * self.deformation

    def centers(self):
        """Centre of each cell, the mean of its triangles'."""
        sums = np.zeros((len(self.cell_stress), 2))
        middle = self.at_points(self.points)[self.triangles].mean(axis=1)
        np.add.at(sums, self.cell_of_triangle, middle)
        return sums / np.maximum(np.bincount(self.cell_of_triangle, minlength=len(sums)), 1)[:, None]


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
