"""Predicts the solver's times on ranks that aren't there; run it by `scripts/scaling predict`.

Takes a problem file, the report of a run of it on one rank, and a network; docs/scaling.md says what
is assumed.
"""

import argparse
import dataclasses
import heapq
import json
import pathlib
import signal
import sys
import time

import h5py
import numpy as np

import runs


@dataclasses.dataclass
class Tree:
    """Leaves come first, a parent after its children, the root last."""

    parent: np.ndarray
    leaves: int
    dofs: np.ndarray          # of a leaf, those on Γ among them
    eliminated: np.ndarray    # e: dofs of Γ that end here
    kept: np.ndarray          # b: dofs of Γ that go on, and the conditions below
    conditions: int
    points: int
    cells: int

    def children(self):
        below = [[] for _ in self.parent]
        for node, parent in enumerate(self.parent):
            if parent >= 0:
                below[parent].append(node)
        return below

    def front_flops(self):
        e, b = self.eliminated.astype(float), self.kept.astype(float)
        return np.where(np.arange(len(e)) < self.leaves, 0, e**3 / 3 + e**2 * b + e * b**2)

    def leaf_flops(self):
        """Nested dissection of a leaf of n dofs (829/84 k³ for k × k nodes, 8 times that for two dofs
        a node), and what its last separator costs with the b dofs behind it."""
        n, b = self.dofs.astype(float), self.kept[: self.leaves].astype(float)
        return 8 * 829 / 84 * (n / 2) ** 1.5 + np.sqrt(2 * n) * b**2

    def message(self):
        """Bytes of the packed S that goes to the parent."""
        b = self.kept.astype(float)
        return 8 * b * (b + 1) / 2


class Unfit(Exception):
    """What was given isn't a problem file and the report of its run; the message says what it is."""


def read_tree(path):
    """The tree of a problem file, and the entries of a report about the problem."""
    try:
        file = h5py.File(path)
    except OSError as error:
        raise Unfit(f"{path}: isn't a problem file of contact-dd-partition; expected PROBLEM REPORT") from error
    with file:
        if "hierarchy/parent" not in file:
            raise Unfit(f"{path}: isn't a problem file of contact-dd-partition; expected PROBLEM REPORT")
        if file.attrs["dimension"] != 2:
            raise Unfit(f"{path}: is a problem in space; the model is of those in the plane")
        grid = file["VTKHDF"]
        points = grid["NumberOfPoints"][:].astype(np.int64)
        dofs = 2 * len(np.unique(grid["PointData/GlobalNodeId"][:]))
        cells = int(grid["NumberOfCells"][:].sum())
        offset = file["interface/offset"][:] if "interface" in file else np.zeros(len(points) + 1, int)
        numbers = file["interface/interface"][:] if "interface" in file else np.zeros(0, int)
        nodes = file["interface/node"][:] if "interface" in file else np.zeros(0, int)
        contact = {key: dataset[:] for key, dataset in file["contact"].items()} if "contact" in file else None
        parent = file["hierarchy/parent"][:]
        names = {
            kind: sorted(map(str, file[f"{kind}/name"].asstr()[:])) if kind in file else []
            for kind in ("contact", "support")
        }

    units = len(points)
    of_unit = np.repeat(np.arange(units), np.diff(offset))
    pairs, conditions = np.stack([of_unit, numbers], 1), np.zeros(units, dtype=np.int64)
    if contact is not None:
        first = contact["entry_offset"][:-1]
        conditions = np.bincount(contact["entry_subdomain"][first], minlength=units)
        pairs = np.concatenate([pairs, of_points(contact, of_unit, nodes, numbers)])
    pairs = np.unique(pairs, axis=0)
    parents = with_one_root(parent)
    tree = fronts(parents, units, pairs, 2 * points, conditions, int(points.sum()), cells)
    counts = {"dofs": dofs, "subdomains": units, "contact_conditions": int(conditions.sum())}
    return tree, {**counts, "contacts": names["contact"], "supports": names["support"], "problem": path.name}


def read_report(path):
    """A report, and its entries about the problem."""
    try:
        report = json.loads(path.read_text())
        printed = {name: report[name] for name in ("dofs", "subdomains", "contact_conditions", "ranks")}
        printed["contacts"] = sorted(contact["name"] for contact in report["contacts"])
        printed["supports"] = sorted(support["support"] for support in report["reactions"])
        printed["problem"] = pathlib.Path(report["settings"]["problem"]).name
    except OSError as error:
        raise Unfit(f"{path}: can't be read: {error.strerror}") from error
    except (ValueError, LookupError, TypeError) as error:
        raise Unfit(f"{path}: isn't a report of contact-dd-mpi; expected PROBLEM REPORT") from error
    return report, printed


def of_points(contact, of_unit, nodes, numbers):
    """The nodes of contact points as nodes of Γ, those of a point in all subdomains that it names."""
    known = dict(zip(zip(of_unit.tolist(), nodes.tolist()), numbers.tolist()))
    entries = list(zip(contact["entry_subdomain"].tolist(), contact["entry_node"].tolist()))
    fresh = int(numbers.max(initial=-1)) + 1
    for entry in entries:
        fresh += known.setdefault(entry, fresh) == fresh
    pairs = []
    for begin, end in zip(contact["entry_offset"][:-1], contact["entry_offset"][1:]):
        point = entries[begin:end]
        pairs += [(subdomain, known[entry]) for subdomain, _ in point for entry in point]
    return np.array(pairs, dtype=np.int64)


def with_one_root(parent):
    """The file's tree with one root above all."""
    roots = int((parent < 0).sum())
    if roots == 1:
        return parent.tolist()
    return [*np.where(parent < 0, len(parent), parent).tolist(), -1]


def fronts(parents, units, pairs, dofs, conditions, points, cells):
    """What every node of the tree eliminates and keeps; `pairs` are (unit, number on Γ)."""
    below = [[] for _ in parents]
    for node, parent in enumerate(parents):
        if parent >= 0:
            below[parent].append(node)
    shared = np.bincount(pairs[:, 1])
    begin = np.searchsorted(pairs[:, 0], np.arange(units + 1))
    eliminated = np.zeros(len(parents), dtype=np.int64)
    kept = np.zeros(len(parents), dtype=np.int64)
    under = np.zeros(len(parents), dtype=np.int64)
    under[:units] = conditions
    open_nodes = {}
    for node in range(len(parents)):
        if node < units:
            nodes = pairs[begin[node] : begin[node + 1], 1]
            seen = np.ones(len(nodes), dtype=np.int64)
        else:
            parts = [open_nodes.pop(child) for child in below[node]]
            nodes, inverse = np.unique(np.concatenate([n for n, _ in parts]), return_inverse=True)
            seen = np.bincount(inverse, np.concatenate([s for _, s in parts]), len(nodes)).astype(np.int64)
            under[node] = under[below[node]].sum()
        done = seen == shared[nodes]
        open_nodes[node] = nodes[~done], seen[~done]
        eliminated[node] = 2 * done.sum()
        kept[node] = 2 * (~done).sum() + under[node]
    return Tree(np.array(parents), units, dofs, eliminated, kept, int(conditions.sum()), points, cells)


@dataclasses.dataclass
class Rates:
    """Seconds of everything, from a run on one rank, a probe of this machine and a network."""

    leaf_flop: float        # s
    front_flop: float
    leaf_dof: float         # assembly
    recover_dof: float
    memory_byte: float
    network_byte: float
    latency: float
    sweeps: float
    read_dof: float
    write_dof: float
    readers: int


def measured_rates(tree, report, arguments, leaf_seconds, front_flop):
    seconds = report["seconds"]
    dofs = report["dofs"]
    leaf_dofs = tree.dofs.sum()
    return Rates(
        leaf_flop=leaf_seconds / tree.leaf_flops().sum(),
        front_flop=front_flop,
        leaf_dof=seconds["assemble"] / leaf_dofs,
        recover_dof=seconds["recover"] / leaf_dofs,
        memory_byte=1 / memory_bandwidth(),
        network_byte=1 / (arguments.bandwidth * 1e9),
        latency=arguments.latency * 1e-6,
        sweeps=seconds["sweeps"],
        read_dof=seconds["read"] / dofs,
        write_dof=seconds["write"] / dofs,
        readers=arguments.readers,
    )


def dense_flop():
    """Seconds of a flop in a dense front of 1000, half of it eliminated, best of 5 (one thread)."""
    e = b = 500
    matrix = np.eye(e) * 1e3 + np.random.default_rng(0).random((e, e))
    matrix = (matrix + matrix.T) / 2
    right = np.ones((e, b))

    def front():
        start = time.perf_counter()
        factor = np.linalg.cholesky(matrix)
        _ = factor @ right
        _ = right.T @ right
        return time.perf_counter() - start

    # The two products do twice the flops that a triangular solve and a symmetric update need.
    return min(front() for _ in range(5)) / (e**3 / 3 + 2 * e**2 * b + 2 * e * b**2)


def memory_bandwidth():
    """Bytes/s of reading a factor that is in no cache (one thread)."""
    data = np.ones(1 << 25)

    def sweep():
        start = time.perf_counter()
        data.sum()
        return time.perf_counter() - start

    return data.nbytes / min(sweep() for _ in range(5))


def owners(tree, work, ranks):
    """Owner of every node: subtrees are split, the one with most work first, until there are enough
    pieces; they are dealt out, that with most work first, to the rank with least. A front above them
    belongs to the rank of its child with most work."""
    below = tree.children()
    pieces = [(-work[-1], len(tree.parent) - 1)]
    done = []
    while pieces and len(pieces) + len(done) < ranks:
        _, node = heapq.heappop(pieces)
        if node < tree.leaves:
            done.append(node)
            continue
        for child in below[node]:
            heapq.heappush(pieces, (-work[child], child))
    roots = sorted([node for _, node in pieces] + done, key=lambda node: -work[node])
    owner = np.full(len(tree.parent), -1)
    loads = [(0.0, rank) for rank in range(ranks)]
    for node in roots:
        load, rank = heapq.heappop(loads)
        heapq.heappush(loads, (load + work[node], rank))
        owner[node] = rank
    for node in range(len(owner) - 1, -1, -1):
        if owner[node] < 0 and tree.parent[node] >= 0 and owner[tree.parent[node]] >= 0:
            owner[node] = owner[tree.parent[node]]
    for node in range(tree.leaves, len(owner)):
        if owner[node] < 0:
            owner[node] = owner[max(below[node], key=lambda child: work[child])]
    return owner


def predict(tree, rates, ranks):
    """Times of one run, in s, and what is sent. The tree is worked off children first, every rank one
    node at a time; a front starts when its children's S have come."""
    below = tree.children()
    leaf = tree.leaf_flops() * rates.leaf_flop + tree.dofs * rates.leaf_dof
    front = tree.front_flops() * rates.front_flop
    # Extend-add: every S below is read, and added to what is written.
    for node in range(tree.leaves, len(front)):
        front[node] += sum(2 * tree.message()[child] for child in below[node]) * rates.memory_byte
    own = front.copy()
    own[: tree.leaves] = leaf
    work = own.copy()
    for node, parent in enumerate(tree.parent):
        if parent >= 0:
            work[parent] += work[node]
    owner = owners(tree, work, ranks)

    free = np.zeros(ranks)
    ready = np.zeros(len(own))
    root = len(own) - 1
    # Fronts that a rank has to itself come first, then those shared with others.
    for node in range(len(own)):
        at = free[owner[node]]
        for child in below[node]:
            arrival = ready[child]
            if owner[child] != owner[node]:
                arrival += rates.latency + tree.message()[child] * rates.network_byte
            at = max(at, arrival)
        ready[node] = free[owner[node]] = at + own[node]
    leaf_of_rank = np.bincount(owner[: tree.leaves], leaf, ranks)

    # Solves go up and down the tree: every factor is read once, every child's trace is sent.
    e, b = tree.eliminated.astype(float), tree.kept.astype(float)
    entries = 8 * (e * (e + 1) / 2 + e * b) * rates.memory_byte
    entries[: tree.leaves] = 0
    down = np.zeros(len(own))
    free = np.zeros(ranks)
    for node in range(root, -1, -1):
        parent = tree.parent[node]
        at = down[parent] if parent >= 0 else 0.0
        if parent >= 0 and owner[parent] != owner[node]:
            at += rates.latency + 8 * b[node] * rates.network_byte
        down[node] = free[owner[node]] = max(at, free[owner[node]]) + entries[node]
    # The start, Newton's step, the final displacement.
    solves = 3 * down.max()

    crossing = [n for n in range(root) if owner[n] != owner[tree.parent[n]]]
    dofs = 2 * tree.points
    result_bytes = 13 * 8 * tree.points + 15 * 8 * tree.cells
    remote = 1 - 1 / ranks
    times = {
        "leaves": leaf_of_rank.max(),
        "merges": max(ready[root] - own[root] - leaf_of_rank.max(), 0.0),
        "root": own[root],
        "sweeps": rates.sweeps,
        "solves": solves,
        "recover": np.bincount(owner[: tree.leaves], tree.dofs * rates.recover_dof, ranks).max(),
        "read": dofs * rates.read_dof / min(ranks, rates.readers),
        "write": dofs * rates.write_dof + result_bytes * remote * rates.network_byte,
    }
    times["solve"] = sum(times[key] for key in ("leaves", "merges", "root", "sweeps", "solves", "recover"))
    times["total"] = times["solve"] + times["read"] + times["write"]
    times["bytes"] = float(sum(tree.message()[n] for n in crossing))
    times["idle"] = ranks - len(set(owner.tolist()))
    return times


HEADS = ["ranks", "leaves", "merges", "root", "sweeps", "solves", "recover", "solve phases", "efficiency",
         "read", "write", "whole run", "efficiency", "MB sent"]


def row(ranks, times, first):
    def efficiency(key):
        return f"{100 * first[key] / ranks / times[key]:.0f} %"

    return [
        ranks, *(f"{times[key]:.3g}" for key in ("leaves", "merges", "root", "sweeps", "solves", "recover", "solve")),
        efficiency("solve"), f"{times['read']:.2g}", f"{times['write']:.2g}", f"{times['total']:.3g}",
        efficiency("total"), f"{times['bytes'] / 1e6:.3g}",
    ]


def print_table(rows):
    print("| " + " | ".join(HEADS) + " |\n|" + "--:|" * len(HEADS))
    for cells in rows:
        print("| " + " | ".join(map(str, cells)) + " |")
    print()


def bottleneck(all_times):
    """From how many ranks on the parts that don't get less with more of them are more than half."""
    parts = [
        ("the root's front and sweeps", ("root", "sweeps"), "solve", "solve phases"),
        ("with the fronts on the way to the root they", ("root", "sweeps", "merges"), "solve", "solve phases"),
        ("the root's front, sweeps and writing", ("root", "sweeps", "write"), "total", "whole run"),
    ]
    printed = []
    for words, keys, of, whole in parts:
        half = (n for n, times in all_times if sum(times[key] for key in keys) > times[of] / 2)
        at = next(half, None)
        where = f"from {at} ranks on" if at else f"nowhere up to {all_times[-1][0]} ranks"
        printed.append(f"{words} are more than half of the {whole} {where}")
    text = "; ".join(printed)
    print(f"{text[0].upper()}{text[1:]}.")


def check_belongs(printed, problem, arguments):
    """Raises `Unfit` unless the report is that of a run of the problem on one rank."""
    for name, expected in [*problem.items(), ("ranks", 1)]:
        if printed[name] != expected:
            raise Unfit(
                f"{arguments.report}: {name.replace('_', ' ')}: {shown(printed[name])}; expected {shown(expected)}, the "
                f"report of a run of {arguments.problem} on one rank"
            )


def shown(value):
    return (", ".join(value) or "none") if isinstance(value, list) else value


def main():
    # Where nobody reads on, as behind `| head`, there is nothing more to do.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    parser = argparse.ArgumentParser(prog="scaling predict", description=__doc__.splitlines()[0])
    parser.add_argument("problem", type=pathlib.Path, help="problem file")
    parser.add_argument("report", type=pathlib.Path, help="report of its run on one rank")
    parser.add_argument("--ranks", default="16,64,256,1024", help="by commas (default: %(default)s)")
    parser.add_argument("--bandwidth", type=float, default=12.5, help="of the network, GB/s (default: %(default)s)")
    parser.add_argument("--latency", type=float, default=2.0, help="of the network, µs (default: %(default)s)")
    parser.add_argument("--readers", type=int, default=16,
                        help="ranks that the file system serves at full speed at once (default: %(default)s)")
    arguments = parser.parse_args()

    try:
        tree, problem = read_tree(arguments.problem)
        report, printed = read_report(arguments.report)
        check_belongs(printed, problem, arguments)
    except Unfit as error:
        print(f"scaling predict: {error}", file=sys.stderr)
        sys.exit(2)
    seconds = report["seconds"]
    # Phases don't tell fronts from leaves: the speed of a front is measured here.
    front_flop = dense_flop()
    flops = tree.front_flops()
    leaf_seconds = max(seconds["factorize"] - front_flop * flops.sum(), 0.1 * seconds["factorize"])
    rates = measured_rates(tree, report, arguments, leaf_seconds, front_flop)
    print(
        f"Tree: {tree.leaves} leaves, {len(tree.parent) - tree.leaves} fronts, {flops.sum() / 1e9:.3g} GFlop in fronts, "
        f"{flops[-1] / 1e9:.3g} in the root's (e = {tree.eliminated[-1]}, b = {tree.kept[-1]}), "
        f"{tree.leaf_flops().sum() / 1e9:.3g} in leaves by the formula; {tree.conditions} contact conditions.\n"
        f"Rates: leaves {1e-9 / rates.leaf_flop:.3g} GFlop/s, fronts {1e-9 / front_flop:.3g} GFlop/s, "
        f"memory {1e-9 / rates.memory_byte:.3g} GB/s, network {arguments.bandwidth:g} GB/s and "
        f"{arguments.latency:g} µs, assembly {1e9 * rates.leaf_dof:.0f} ns, recovery {1e9 * rates.recover_dof:.0f} ns, "
        f"reading {1e9 * rates.read_dof:.0f} ns, writing {1e9 * rates.write_dof:.0f} ns a dof.\n"
    )
    counts = [1, *(int(n) for n in arguments.ranks.split(","))]
    times = [(n, predict(tree, rates, n)) for n in counts]
    print_table([row(n, t, times[0][1]) for n, t in times])
    idle = [f"{t['idle']} of {n}" for n, t in times if t["idle"]]
    if idle:
        print(f"Ranks without work, for want of leaves: {', '.join(idle)}.\n")
    solve = sum(seconds[phase] for phase in runs.SOLVE_PHASES)
    print(f"Measured on one rank: solve phases {solve:.3f} s, whole run {seconds['total']:.3f} s.\n")
    doubled = [1 << i for i in range(1, 21) if 1 << i <= 2 * tree.leaves]
    bottleneck([(n, predict(tree, rates, n)) for n in doubled])


main()
