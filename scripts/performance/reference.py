"""What the solver is compared with: the same problem as one sparse system, and PARDISO, CHOLMOD and
a primal-dual active set on PARDISO that solve it in memory."""

import ctypes
import json
import os
import pathlib
import subprocess
import sys
import time

import h5py
import numpy as np
import scipy.sparse as sp

TRIANGLE = 5
# Residual of the linear problem, relative to its terms, of what counts as a solution.
LARGEST_RESIDUAL = 1e-10


class System:
    """K u = f of a problem file's mesh with the supported dofs taken out, and its contact
    conditions B u <= g. `upper` is K's upper triangle."""

    def __init__(self, path):
        with h5py.File(path) as file:
            self.read(file)

    def read(self, file):
        grid = file["VTKHDF"]
        start = np.concatenate([[0], np.cumsum(grid["NumberOfPoints"][:])])
        if np.any(grid["Types"][:] != TRIANGLE):
            sys.exit("bench: the reference knows triangles of three nodes only")
        # Copies of a node have one name, which is one number in `node`.
        self.names, node = np.unique(grid["PointData/GlobalNodeId"][:], return_inverse=True)
        points = np.empty((len(self.names), 2))
        points[node] = grid["Points"][:, :2]
        partition = np.repeat(np.arange(len(start) - 1), grid["NumberOfCells"][:])
        cells = node[grid["Connectivity"][:].reshape(-1, 3) + start[partition, None]]

        def nodes(group, of="node"):
            offset = group["offset"][:]
            return node[group[of][:] + np.repeat(start[:-1], np.diff(offset))]

        size = 2 * len(self.names)
        load = np.zeros(size)
        if "force" in file:
            at = nodes(file["force"])
            for axis in range(2):
                np.add.at(load, 2 * at + axis, file["force/value"][:, axis])
        self.u = np.zeros(size)
        fixed = np.zeros(size, dtype=bool)
        if "support" in file:
            at, direction = nodes(file["support"]), file["support/direction"][:]
            axis = np.abs(direction).argmax(axis=1)
            sign = direction[np.arange(len(axis)), axis]
            if np.any(np.abs(sign) != 1):
                sys.exit("bench: the reference knows supports along the axes only")
            fixed[2 * at + axis] = True
            self.u[2 * at + axis] = file["support/value"][:] * sign
        self.free = np.flatnonzero(~fixed)
        self.number = np.full(size, -1, dtype=np.int32)
        self.number[self.free] = np.arange(len(self.free), dtype=np.int32)

        material = grid["CellData/Material"][:]
        self.load = load[self.free]
        self.upper = self.assemble(points, cells, file["materials/stiffness"][:][material])
        self.read_contact(file, lambda subdomain, at: node[start[subdomain] + at])

    def assemble(self, points, cells, stiffness):
        """Upper triangle of K; what the supported dofs prescribe goes to the load."""
        x, y = points[cells][..., 0], points[cells][..., 1]
        b = np.stack([y[:, 1] - y[:, 2], y[:, 2] - y[:, 0], y[:, 0] - y[:, 1]], axis=1)
        c = np.stack([x[:, 2] - x[:, 1], x[:, 0] - x[:, 2], x[:, 1] - x[:, 0]], axis=1)
        twice_area = b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0]
        strain = np.zeros((len(cells), 3, 6))
        strain[:, 0, 0::2] = strain[:, 2, 1::2] = b
        strain[:, 1, 1::2] = strain[:, 2, 0::2] = c
        local = np.einsum("nki,nkl,nlj->nij", strain, stiffness, strain, optimize=True)
        local /= 2 * np.abs(twice_area)[:, None, None]

        dofs = np.stack([2 * cells, 2 * cells + 1], axis=2).reshape(-1, 6)
        numbers = self.number[dofs]
        count = len(self.free)
        parts = []
        for i in range(6):
            prescribed = numbers[:, i] >= 0
            prescribed = prescribed[:, None] & (numbers < 0)
            for cell, j in zip(*np.nonzero(prescribed)):
                self.load[numbers[cell, i]] -= local[cell, i, j] * self.u[dofs[cell, j]]
            keep = (numbers[:, i, None] >= 0) & (numbers >= numbers[:, i, None])
            row = np.broadcast_to(numbers[:, i, None], numbers.shape)[keep]
            triplets = (local[:, i, :][keep], (row, numbers[keep]))
            parts.append(sp.csr_matrix(triplets, shape=(count, count)))
        upper = sum(parts[1:], parts[0])
        upper.sort_indices()
        return upper

    def read_contact(self, file, node_of):
        self.conditions = 0
        if "contact" not in file:
            return
        table = file["contact"]
        offset = table["entry_offset"][:]
        at = node_of(table["entry_subdomain"][:], table["entry_node"][:])
        row = np.repeat(np.arange(len(offset) - 1), np.diff(offset))
        coefficient = table["entry_weight"][:][:, None] * table["normal"][:][row]
        dofs = 2 * at[:, None] + np.arange(2)
        B = sp.csr_matrix(
            (coefficient.ravel(), (np.repeat(row, 2), dofs.ravel())),
            shape=(len(offset) - 1, len(self.u)),
        )
        self.gap = table["gap"][:] - B @ self.u
        self.B = B[:, self.free].tocsr()
        self.B.eliminate_zeros()
        self.conditions = len(self.gap)

    def whole(self, u):
        """Displacement of every node, from that of the dofs that aren't supported."""
        result = self.u.copy()
        result[self.free] = u
        return result.reshape(-1, 2)

    def residual(self, u):
        """Of the linear problem: largest residual, relative to its terms."""
        diagonal = sp.diags(self.upper.diagonal())
        K = self.upper + self.upper.T - diagonal
        terms = abs(K) @ np.abs(u) + np.abs(self.load)
        return np.abs(K @ u - self.load).max() / terms.max()

    def difference(self, u, result):
        """Largest difference of the displacements to a result file's, relative to the largest."""
        own = self.whole(u)
        with h5py.File(result) as file:
            names = file["VTKHDF/PointData/GlobalNodeId"][:]
            theirs = file["VTKHDF/PointData/Displacement"][:, :2]
        return np.abs(theirs - own[np.searchsorted(self.names, names)]).max() / np.abs(own).max()


class Pardiso:
    """MKL's PARDISO for a symmetric positive definite matrix, given by its upper triangle, called
    without pypardiso's copies and checks of it."""

    # Of iparm, from 0: values are given, no iterative refinement, indices count from 0.
    OPTIONS = {0: 1, 7: 0, 34: 1}
    # Variants of which `fastest` takes the best: ordering by minimum degree, nested dissection, the same
    # in parallel; factorization classic, two-level, improved two-level.
    CHOICES = {
        "nested dissection, classic": {1: 2, 23: 0},
        "nested dissection, two-level": {1: 2, 23: 1},
        "nested dissection, improved two-level": {1: 2, 23: 10},
        "parallel nested dissection, classic": {1: 3, 23: 0},
        "parallel nested dissection, two-level": {1: 3, 23: 1},
        "parallel nested dissection, improved two-level": {1: 3, 23: 10},
        "minimum degree, two-level": {1: 0, 23: 1},
        "minimum degree, improved two-level": {1: 0, 23: 10},
    }

    library = None

    def __init__(self, upper, threads, choice):
        if Pardiso.library is None:
            import pypardiso

            Pardiso.library = pypardiso.PyPardisoSolver(mtype=2).libmkl
        self.library.MKL_Set_Dynamic(0)
        self.library.MKL_Set_Num_Threads(threads)
        self.rows = upper.indptr.astype(np.int32)
        self.columns = upper.indices.astype(np.int32)
        self.values = upper.data
        self.handle = np.zeros(64, dtype=np.int64)
        self.iparm = np.zeros(64, dtype=np.int32)
        for at, value in {**self.OPTIONS, **self.CHOICES[choice]}.items():
            self.iparm[at] = value
        self.seconds = {"symbolic": 0.0, "factor": 0.0, "solve": 0.0}
        self.memory = 0

    def phase(self, number, name=None, b=None, x=None):
        def word(value):
            return ctypes.byref(ctypes.c_int32(value))

        def array(of):
            return None if of is None else ctypes.c_void_p(of.ctypes.data)

        error = ctypes.c_int32(0)
        start = time.perf_counter()
        self.library.pardiso(
            self.handle.ctypes.data_as(ctypes.POINTER(ctypes.c_int64)), word(1), word(1), word(2),
            word(number), word(len(self.rows) - 1), array(self.values),
            self.rows.ctypes.data_as(ctypes.POINTER(ctypes.c_int32)),
            self.columns.ctypes.data_as(ctypes.POINTER(ctypes.c_int32)), None, word(1),
            self.iparm.ctypes.data_as(ctypes.POINTER(ctypes.c_int32)), word(0), array(b), array(x),
            ctypes.byref(error),
        )
        if name:
            self.seconds[name] += time.perf_counter() - start
        if error.value != 0:
            sys.exit(f"bench: PARDISO's phase {number} ends with error {error.value}")

    def analyse(self):
        self.phase(11, "symbolic")

    def factorize(self):
        self.phase(22, "factor")
        # kB; at the peak of the analysis, or held and used since.
        self.memory = 1024 * max(int(self.iparm[14]), int(self.iparm[15]) + int(self.iparm[16]))

    def solve(self, b):
        x = np.empty_like(b)
        self.phase(33, "solve", np.ascontiguousarray(b), x)
        return x

    def free(self):
        self.phase(-1)

    def result(self):
        return {**self.seconds, "total": sum(self.seconds.values()), "memory": self.memory}


def tried(system, threads):
    """What the linear problem needs by each of PARDISO's choices that solve it, after a try that
    starts the threads; where it is short, the best of three."""
    linear(system, threads, next(iter(Pardiso.CHOICES)))
    results = {}
    for choice in Pardiso.CHOICES:
        # Its ways to factorize differ with several threads only.
        if threads == 1 and "two-level" in choice and choice != "minimum degree, two-level":
            continue
        tries = [linear(system, threads, choice)]
        if tries[0][0]["total"] < 1:
            tries += [linear(system, threads, choice) for _ in range(2)]
        # Some ways end without an error and without a solution.
        if all(system.residual(u) < LARGEST_RESIDUAL for _, u in tries):
            results[choice] = min((result for result, _ in tries), key=lambda result: result["total"])
    return results


def fastest(results, steps=1):
    """The choice that is soonest done with so many factorizations of one pattern."""
    return min(
        results,
        key=lambda choice: results[choice]["symbolic"]
        + steps * (results[choice]["factor"] + results[choice]["solve"]),
    )


def linear(system, threads, choice):
    """The linear problem of the mesh, all contacts open."""
    solver = Pardiso(system.upper, threads, choice)
    solver.analyse()
    solver.factorize()
    u = solver.solve(system.load)
    solver.free()
    return solver.result(), u


class Conditions:
    """The problem in other unknowns: of every condition one displacement gives way to z = B u, so
    that the condition is z <= g, a closed one prescribes a dof, the matrix stays positive definite
    and its pattern the same, whatever is closed: one symbolic factorization serves all steps, and
    every step has a Cholesky factorization instead of an indefinite one."""

    def __init__(self, system):
        B, count = system.B, len(system.free)
        used = np.bincount(B.indices, minlength=count)
        pivots = np.empty(system.conditions, dtype=np.int32)
        value = np.empty(system.conditions)
        for row in range(system.conditions):
            own = slice(B.indptr[row], B.indptr[row + 1])
            weight = np.abs(B.data[own]) * (used[B.indices[own]] == 1)
            if not weight.any():
                sys.exit("bench: the reference needs a dof that is in one condition only")
            best = own.start + weight.argmax()
            pivots[row], value[row] = B.indices[best], B.data[best]
        # u = T y: y is u but for the pivots, where it is z.
        scaled = (sp.diags(-1 / value) @ B).tocoo()
        unit = np.ones(count)
        unit[pivots] = 0
        self.T = (
            sp.diags(unit)
            + sp.csr_matrix((scaled.data, (pivots[scaled.row], scaled.col)), shape=(count, count))
            + sp.csr_matrix((1 / value + 1, (pivots, pivots)), shape=(count, count))
        ).tocsr()
        K = system.upper + sp.triu(system.upper, 1).T
        K = (self.T.T @ K @ self.T).tocsr()
        self.load = self.T.T @ system.load
        self.pivots, self.gap = pivots, system.gap
        self.rows = K[pivots]
        self.upper = sp.triu(K, format="csr")
        self.upper.sort_indices()
        self.values = self.upper.data.copy()
        row = np.repeat(np.arange(count, dtype=np.int32), np.diff(self.upper.indptr))
        column = self.upper.indices
        z = np.zeros(count, dtype=bool)
        z[pivots] = True
        self.touched = np.flatnonzero((z[row] | z[column]) & (row != column))
        self.touched_row, self.touched_column = row[self.touched], column[self.touched]

    def prescribe(self, closed):
        """Puts the matrix with these conditions closed into `upper`; returns the right-hand side."""
        fixed = np.zeros(len(self.load), dtype=bool)
        fixed[self.pivots[closed]] = True
        self.upper.data[:] = self.values
        off = fixed[self.touched_row] | fixed[self.touched_column]
        self.upper.data[self.touched[off]] = 0
        b = self.load - self.rows[closed].T @ self.gap[closed]
        at = self.pivots[closed]
        b[at] = self.upper.diagonal()[at] * self.gap[closed]
        return b

    def next_set(self, y, closed):
        """Closed next: what is closed and pressed, and what is open and penetrates."""
        force = (self.load[self.pivots] - self.rows @ y)
        return np.where(closed, force > 0, y[self.pivots] > self.gap)


def active_set(conditions, threads, choice):
    """Primal-dual active set from the open start, a factorization each step."""
    c = conditions
    closed = np.zeros(len(c.gap), dtype=bool)
    c.prescribe(closed)
    solver = Pardiso(c.upper, threads, choice)
    start = time.perf_counter()
    solver.analyse()
    for steps in range(1, 101):
        b = c.prescribe(closed)
        solver.factorize()
        y = solver.solve(b)
        before, closed = closed, c.next_set(y, closed)
        if np.array_equal(before, closed):
            break
    else:
        sys.exit("bench: the active set on PARDISO doesn't end")
    seconds = time.perf_counter() - start
    solver.free()
    return {**solver.result(), "total": seconds, "steps": steps, "closed": int(closed.sum())}, c.T @ y


class Cholmod:
    """CHOLMOD's supernodal factorization, in a program of its own; the matrix goes through a file,
    the program times its work in memory."""

    def __init__(self, system, folder):
        self.program, self.matrix = folder / "cholmod", folder / "matrix"
        source = pathlib.Path(__file__).with_name("cholmod.c")
        if not self.program.exists() or self.program.stat().st_mtime < source.stat().st_mtime:
            command = ["gcc", "-O2", "-Wall", "-I/usr/include/suitesparse", source]
            subprocess.run([*command, "-o", self.program, "-lcholmod", "-lblas", "-ldl"], check=True)
        self.solution = folder / "solution"
        upper = system.upper
        with open(self.matrix, "wb") as file:
            np.array([upper.shape[0], upper.nnz], dtype=np.int64).tofile(file)
            upper.indptr.astype(np.int32).tofile(file)
            upper.indices.astype(np.int32).tofile(file)
            upper.data.tofile(file)
            system.load.tofile(file)

    def linear(self):
        """The linear problem with one thread; `blas` is the library that did the dense part."""
        threads = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
        ran = subprocess.run(
            [self.program, self.matrix, self.solution], check=True, capture_output=True, text=True,
            env={**os.environ, **threads},
        )
        result = json.loads(ran.stdout)
        result["blas"] = str(pathlib.Path(result["blas"]).resolve())
        return result, np.fromfile(self.solution)

    def nested_dissection(self):
        """Flops of a factorization in the order of METIS_NodeND: of every column of the factor, the
        square of its entries."""
        ran = subprocess.run([self.program, self.matrix], check=True, capture_output=True, text=True)
        return float(ran.stdout)

    def free(self):
        self.matrix.unlink()
        self.solution.unlink(missing_ok=True)
