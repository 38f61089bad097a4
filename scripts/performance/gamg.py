"""Conjugate gradients with PETSc's GAMG, rigid modes as its near null space, on the boxes of boxes.py.

    mpirun -n 2 python3 gamg.py CELLS [tied]

Tied it solves the linear problem to 1e-10; else that is inside an active set, which starts where all is closed, each step
from the solution before. Prints a line of JSON: seconds from the matrix in memory to the solution in memory, iterations,
steps and the largest displacement.
"""

import json
import sys
import time

import boxes
import numpy as np
import petsc4py
import scipy.sparse as sp

petsc4py.init(sys.argv[:1])
from petsc4py import PETSc  # noqa: E402

OPTIONS = {
    "ksp_type": "cg", "pc_type": "gamg", "pc_gamg_type": "agg", "pc_gamg_square_graph": 1, "pc_gamg_threshold": 0.01,
    "mg_levels_ksp_type": "chebyshev", "mg_levels_pc_type": "jacobi",
}
# Forces and gaps, relative to the largest, that are none.
ROUND_OFF = 1e-9


class Boxes:
    """K u = f of the boxes, nodes sorted along x so that ranks have slabs, and both nodes of a pair on one rank."""

    def __init__(self, cells, tied):
        points, parts = boxes.groups(cells, tied, first=0)
        self.count = len(points)
        order = np.lexsort(points.T)
        order = order[np.argsort(points[order, 0], kind="stable")]
        place = np.empty(self.count, dtype=np.int64)
        place[order] = np.arange(self.count)
        self.points = points[order]
        of_group = {name: place[nodes] for _, name, nodes in parts}
        solids = np.concatenate([of_group[name] for dim, name, _ in parts if dim == 3])
        self.K = sum(self.stiffness(part) for part in np.array_split(solids, max(1, len(solids) // 200_000)))
        self.f = np.zeros(3 * self.count)
        prescribed = np.zeros(3 * self.count)
        fixed = np.zeros(3 * self.count, dtype=bool)
        bottom, top = np.unique(of_group["bottom"]), of_group["top"]
        for axis in range(3):
            fixed[3 * bottom + axis] = True
        if tied:
            at = self.points[top]
            area = np.linalg.norm(np.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]), axis=1) / 2
            for i in range(3):
                for j in range(3):
                    value = boxes.PRESSURE * (1 - 1.6 * at[:, j, 0])
                    np.add.at(self.f, 3 * top[:, i] + 2, -area / 12 * (1 + (i == j)) * value)
            self.pairs = np.zeros((2, 0), dtype=np.int64)
        else:
            moved = np.unique(top)
            for axis in range(3):
                fixed[3 * moved + axis] = True
            prescribed[3 * moved + 2] = -boxes.PUSH * (1 - 1.6 * self.points[moved, 0])
            # Both sides' nodes follow each other in the same order along x and y.
            self.pairs = np.stack([np.unique(of_group[side]) for side in ("upper bottom", "lower top")])
        self.f -= self.K @ prescribed
        self.f[fixed] = 0
        self.prescribed = prescribed
        self.diagonal = self.K.diagonal()
        free = sp.diags((~fixed).astype(float))
        self.K = (free @ self.K @ free + sp.diags(np.where(fixed, self.diagonal, 0.0))).tocsr()
        self.K.eliminate_zeros()

    def stiffness(self, cells):
        shear = boxes.YOUNG / (2 * (1 + boxes.POISSON))
        lame = 2 * shear * boxes.POISSON / (1 - 2 * boxes.POISSON)
        edges = self.points[cells[:, 1:]] - self.points[cells[:, :1]]
        volume = np.abs(np.linalg.det(edges)) / 6
        gradient = np.linalg.inv(edges)
        gradient = np.concatenate([-gradient.sum(axis=2, keepdims=True), gradient], axis=2).transpose(0, 2, 1)
        # λ ∂_i N_a ∂_j N_b + μ (∂_j N_a ∂_i N_b + δ_ij ∇N_a·∇N_b)
        outer = np.einsum("mai,mbj->maibj", gradient, gradient)
        local = lame * outer + shear * outer.transpose(0, 1, 4, 3, 2)
        both = shear * np.einsum("mai,mbi->mab", gradient, gradient)
        for axis in range(3):
            local[:, :, axis, :, axis] += both
        local = (local * volume[:, None, None, None, None]).reshape(len(cells), -1)
        dofs = (3 * cells[:, :, None] + np.arange(3)).reshape(len(cells), 12)
        at = (np.repeat(dofs, 12, axis=1).ravel(), np.tile(dofs, (1, 12)).ravel())
        return sp.csr_matrix((local.ravel(), at), shape=(3 * self.count, 3 * self.count))


class Solver:
    """CG + GAMG on the rows of this rank."""

    def __init__(self, problem):
        self.comm = PETSc.COMM_WORLD
        self.points = problem.points
        cut = np.linspace(0, problem.count, self.comm.size + 1).astype(int)
        for rank in range(1, self.comm.size):
            # Whole slabs: nodes of a pair aren't parted.
            x = problem.points[:, 0]
            while cut[rank] < problem.count and x[cut[rank]] == x[cut[rank] - 1]:
                cut[rank] += 1
        self.first, self.end = cut[self.comm.rank], cut[self.comm.rank + 1]
        options = PETSc.Options()
        for name, value in OPTIONS.items():
            options[name] = value

    def vector(self, matrix, values):
        vector = matrix.createVecRight()
        vector.setArray(values[3 * self.first:3 * self.end])
        return vector

    def solve(self, K, f, start=None):
        """The solution on all ranks, and the iterations."""
        rows, own = K[3 * self.first:3 * self.end], 3 * (self.end - self.first)
        csr = (rows.indptr.astype(np.int32), rows.indices.astype(np.int32), rows.data)
        A = PETSc.Mat().createAIJ(((own, K.shape[0]), (own, K.shape[0])), bsize=3, csr=csr, comm=self.comm)
        A.setOption(PETSc.Mat.Option.SPD, True)
        at = A.createVecRight()
        at.setBlockSize(3)
        at.setArray(self.points[self.first:self.end].ravel())
        A.setNearNullSpace(PETSc.NullSpace().createRigidBody(at))
        krylov = PETSc.KSP().create(self.comm)
        krylov.setOperators(A)
        krylov.setTolerances(rtol=1e-10, max_it=10_000)
        krylov.setFromOptions()
        x = A.createVecRight() if start is None else self.vector(A, start)
        krylov.setInitialGuessNonzero(start is not None)
        krylov.solve(self.vector(A, f), x)
        if krylov.getConvergedReason() <= 0:
            sys.exit(f"gamg: CG ends with reason {krylov.getConvergedReason()}")
        scatter, whole = PETSc.Scatter.toAll(x)
        scatter.scatter(x, whole)
        return whole.getArray().copy(), krylov.getIterationNumber()


def active_set(problem, solver):
    """Displacement, steps and iterations."""
    above, below = 3 * problem.pairs + 2
    closed = np.ones(len(above), dtype=bool)
    x, size, iterations = None, 3 * problem.count, 0
    for step in range(1, 100):
        # Of a closed pair the upper node goes with the lower one.
        to = np.arange(size)
        to[above[closed]] = below[closed]
        tie = sp.csr_matrix((np.ones(size), (np.arange(size), to)), shape=(size, size))
        gone = np.zeros(size)
        gone[above[closed]] = problem.diagonal[above[closed]]
        K = (tie.T @ problem.K @ tie + sp.diags(gone)).tocsr()
        start = None if x is None else np.where(gone > 0, 0, x)
        y, taken = solver.solve(K, tie.T @ problem.f, start)
        x, iterations = y[to], iterations + taken
        force, gap = (problem.K @ x - problem.f)[above], x[above] - x[below]
        opens = closed & (force < -ROUND_OFF * np.abs(force).max())
        closes = ~closed & (gap < -ROUND_OFF * np.abs(x).max())
        if not (opens | closes).any():
            return x, step, iterations, int(closed.sum())
        closed = closed & ~opens | closes
    sys.exit("gamg: the active set isn't found")


def main():
    tied = "tied" in sys.argv
    problem = Boxes(int(sys.argv[1]), tied)
    solver = Solver(problem)
    solver.comm.barrier()
    began = time.perf_counter()
    if tied:
        x, iterations = solver.solve(problem.K, problem.f)
        steps, closed = 1, 0
    else:
        x, steps, iterations, closed = active_set(problem, solver)
    taken = time.perf_counter() - began
    if solver.comm.rank == 0:
        u = (x + problem.prescribed).reshape(-1, 3)
        largest = float(np.linalg.norm(u, axis=1).max())
        print(json.dumps({"total": taken, "iterations": iterations, "steps": steps, "closed": closed, "largest": largest,
                          "dofs": 3 * problem.count, "conditions": problem.pairs.shape[1]}))


main()
