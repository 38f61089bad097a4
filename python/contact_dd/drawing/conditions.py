"""Supports and loads of a result, from the problem file that it was solved of, where that is still there."""

from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np

from contact_dd.drawing.integrals import integrals

# Share of the largest force below which a difference of forces is round-off.
NOTHING = 1e-6
# Exceptions of h5py and NumPy for a file that isn't a problem file, or is damaged.
UNREADABLE = (OSError, LookupError, TypeError, ValueError, AttributeError, RuntimeError)


@dataclass
class Support:
    """Support of a node: its unit vectors, and whether it is moved along them, or held by springs."""

    node: int
    axes: np.ndarray
    is_moved: bool
    is_spring: bool = False


@dataclass
class Conditions:
    """Supports of nodes, forces on nodes (surface loads and point forces), and body forces: the body's centre and the
    direction, each a vector."""

    supports: list[Support] = field(default_factory=list)
    nodes: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=int))
    forces: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    bodies: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)

    def seen(self, nodes, bodies=None):
        """The conditions of the `nodes` and `bodies` that are shown, flags for each; without `bodies` of all bodies."""
        is_loaded = nodes[self.nodes]
        supports = [support for support in self.supports if nodes[support.node]]
        shown = range(len(self.bodies)) if bodies is None else np.flatnonzero(bodies)
        return Conditions(supports, self.nodes[is_loaded], self.forces[is_loaded], [self.bodies[k] for k in shown])

    def centres(self):
        """The centres of bodies with body forces, a row each."""
        return np.array([centre for centre, _ in self.bodies]).reshape(-1, 3)


def conditions_of(result, surface):
    """Supports and loads of the bodies that are active in the result's step; empty where the problem file isn't beside
    the result, or is of another mesh. `surface` are the rows of nodes on the surface of bodies."""
    for path in candidates(result):
        try:
            with h5py.File(path) as problem:
                found = Problem(result, problem)
                return Conditions(found.supports(), *found.loads(surface))
        except UNREADABLE:
            continue
    return Conditions()


def candidates(result):
    """Candidates for the problem file: the path in the report, and one beside the result."""
    named = Path(str(result.report["settings"]["problem"]))
    beside = [result.path.parent / named.name, result.path.with_suffix(".h5")]
    return [path for path in dict.fromkeys([*beside, named]) if path.is_file()]


class Problem:
    """An open problem file, and the rows that its points have in the result. Raises `ValueError` where it has another
    mesh."""

    def __init__(self, result, file):
        self.result, self.file = result, file
        grid = file["VTKHDF"]
        self.tags = grid["PointData/GlobalNodeId"][:]
        self.row = np.searchsorted(result.nodes, self.tags).clip(max=len(result.nodes) - 1)
        if (result.nodes[self.row] != self.tags).any() or (result.points[self.row] != grid["Points"][:]).any():
            raise ValueError("the problem has another mesh than the result")
        self.dimension = int(file.attrs["dimension"])
        self.first = np.concatenate([[0], np.cumsum(grid["NumberOfPoints"][:])])
        # Rows of one node, separate where stresses jump, are merged.
        self.one = np.searchsorted(result.nodes, result.nodes)
        self.is_there = np.zeros(len(result.nodes), dtype=bool)
        for cells in result.cells:
            self.is_there[self.one[cells.nodes]] = True
        in_cells = np.isin(np.arange(len(self.tags)), self.points_of_cells())
        # Nodes without cells move with a reference point.
        self.is_there[self.row[~in_cells]] = True

    def points_of_cells(self):
        grid = self.file["VTKHDF"]
        sizes = grid["NumberOfConnectivityIds"][:]
        return grid["Connectivity"][:] + np.repeat(self.first[:-1], sizes)

    def rows(self, group):
        """The rows of the nodes of a group, which are counted within their subdomains."""
        offset, node = group["offset"][:], group["node"][:]
        start = np.repeat(self.first[:-1], np.diff(offset))
        return self.row[(node.T + start).T]

    def of_step(self, values):
        """The rows of the result's load step in an array of all steps."""
        return values[:, self.result.step - 1] if "steps" in self.file else values

    def supports(self):
        held = {}
        group = self.file["support"]
        if "node" in group:
            values = self.of_step(group["value"][:])
            for row, axis, value in zip(self.rows(group), group["direction"][:], values, strict=True):
                if self.is_there[row]:
                    held.setdefault(int(row), {})[tuple(np.round(axis, 9))] = value
        found = [Support(row, np.array(list(of)), any(of.values())) for row, of in sorted(held.items())]
        if "spring" in self.file:
            group = self.file["spring"]
            start = np.repeat(self.first[:-1], np.diff(group["offset"][:]))
            row = self.row[group["node"][:, 0] + start]
            for k in np.unique(row[self.is_there[row]]):
                block = np.abs(group["stiffness"][:][(row == k) & (np.diff(group["node"][:])[:, 0] == 0)]).sum(axis=0)
                axes = np.eye(self.dimension)[np.diag(block) > 0] if len(block) else np.zeros((0, self.dimension))
                found.append(Support(int(k), axes, False, is_spring=True))
        return found

    def loads(self, surface):
        """Loaded nodes, their forces, and body forces, without the forces of initial stress and thermal strain."""
        nothing = Conditions()
        if "force" not in self.file or "node" not in self.file["force"]:
            return nothing.nodes, nothing.forces, nothing.bodies
        group = self.file["force"]
        total = np.zeros((len(self.result.nodes), self.dimension))
        np.add.at(total, self.rows(group), self.of_step(group["value"][:]))
        total[~self.is_there] = 0
        largest = np.abs(total).max(initial=0.0)
        bodies = self.bodies(total)
        total[~self.is_there] = 0
        is_inside = np.ones(len(total), dtype=bool)
        is_inside[self.one[surface]] = False
        found = []
        for body in bodies:
            force = body_force(body, total, is_inside, NOTHING * largest)
            if np.abs(force).max() > NOTHING * largest:
                total[body.nodes] -= force
                found.append((body.centre, force.sum(axis=0)))
        rows = np.flatnonzero(np.abs(total).max(axis=1) > NOTHING * largest)
        return rows, total[rows], found

    def bodies(self, total):
        """The bodies of the result's step. What initial stresses exert on nodes is taken out of their forces."""
        result, dimension = self.result, self.dimension
        stress = self.stress()
        of_body = self.file["subdomains/body"][:]
        material = result.cell_data["Material"]
        parts = {}
        for cells in result.cells:
            corners = result.points[cells.nodes][..., :dimension]
            at_nodes = None if stress is None else stress(cells)
            found = integrals(cells.kind, corners, at_nodes, result.plane == "axisymmetric")
            nodes = self.one[cells.nodes]
            if found.forces is not None:
                np.add.at(total, nodes, found.forces)
            body = of_body[result.cell_data["Subdomain"][cells.members]]
            for number in np.unique(body):
                of = body == number
                columns = np.broadcast_to(material[cells.members[of], None], nodes[of].shape)
                part = nodes[of].ravel(), columns.ravel(), found.shares[of].ravel()
                parts.setdefault(int(number), []).append(part)
        return [self.body(*(np.concatenate(of) for of in zip(*found, strict=True))) for found in parts.values()]

    def body(self, nodes, material, shares):
        rows, place = np.unique(nodes, return_inverse=True)
        column = np.unique(material, return_inverse=True)[1]
        columns = np.zeros((len(rows), column.max() + 1))
        np.add.at(columns, (place, column), shares)
        return Body(rows, columns, np.average(self.result.points[rows], axis=0, weights=columns.sum(axis=1)))

    def mean_stress(self):
        """The mean of initial stress and that of thermal strain over cells; none where there is none."""
        if "initial_stress" not in self.file or "cell" not in self.file["initial_stress"]:
            return None
        return self.of_step(self.file["initial_stress/cell"][:])

    def stress(self):
        """Initial stress and that of thermal strain at the nodes of cells; none where there is none."""
        of_cell = self.mean_stress()
        if of_cell is None:
            return None
        of_point = self.of_step(self.file["initial_stress/node"][:])
        at_rows = np.zeros((len(self.result.nodes), 6))
        at_rows[self.row] = of_point

        def at_nodes(cells):
            # Nodes have the stress of one of the materials around them: of each cell the mean is its own.
            varying = at_rows[self.one[cells.nodes]]
            return of_cell[cells.members][:, None] + varying - varying.mean(axis=1, keepdims=True)

        return at_nodes


@dataclass
class Body:
    """The nodes of a body, how much of each material's volume is theirs, and the body's centre."""

    nodes: np.ndarray
    columns: np.ndarray
    centre: np.ndarray


def body_force(body, total, is_inside, round_off):
    """Nodal forces of a uniform body force, determined from the inner nodes of a body; zeros if no uniform body force
    explains the forces there, or those of all nodes in a body without inner ones."""
    inside = is_inside[body.nodes]
    if not inside.any() or np.abs(total[body.nodes[inside]]).max() <= round_off:
        inside = np.ones(len(body.nodes), dtype=bool)
    density = np.linalg.lstsq(body.columns[inside], total[body.nodes[inside]], rcond=None)[0]
    force = body.columns @ density
    left = np.abs(total[body.nodes[inside]] - force[inside]).max()
    return force if left <= round_off else np.zeros_like(force)
