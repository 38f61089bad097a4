"""Predicts the solver's times on ranks that aren't there; run it by `scripts/scaling predict`.

Takes a problem file, the report of a run of it on one rank, and a network; docs/scaling.md says what
is assumed. The tree is the problem file's /hierarchy, or halves by position where it has none.
"""

import argparse
import csv
import dataclasses
import heapq
import json
import math
import pathlib
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


def read_tree(path):
    with h5py.File(path) as file:
        grid = file["VTKHDF"]
        points = grid["NumberOfPoints"][:].astype(np.int64)
        count = len(points)
        start = np.concatenate([[0], np.cumsum(points)])
        middle = np.add.reduceat(grid["Points"][:, :2], start[:-1]) / points[:, None]
        cells = int(grid["NumberOfCells"][:].sum())
        group = file["subdomains/group"][:]
        offset = file["interface/offset"][:] if "interface" in file else np.zeros(count + 1, int)
        numbers = file["interface/interface"][:] if "interface" in file else np.zeros(0, int)
        rows = np.diff(file["contact/group_offset"][:]) if "contact" in file else np.zeros(0, int)
        parent = file["hierarchy/parent"][:] if "hierarchy" in file else None

    # A unit is a group, or a subdomain without contact.
    alone = group < 0
    unit = np.where(alone, len(rows) + np.cumsum(alone) - 1, group)
    units = len(rows) + int(alone.sum())
    conditions = np.zeros(units, dtype=np.int64)
    conditions[: len(rows)] = rows
    weight = np.bincount(unit, points, units)
    place = np.stack([np.bincount(unit, middle[:, i] * points, units) for i in range(2)], 1)
    place /= weight[:, None]
    pairs = np.unique(
        np.stack([np.repeat(unit, np.diff(offset)), numbers], 1), axis=0
    )
    if parent is None:
        parents = halves(place, weight)
    else:
        parents = contracted(parent, unit, units)
    return fronts(parents, units, pairs, 2 * weight.astype(np.int64), conditions, int(points.sum()), cells), (
        "the problem file's hierarchy" if parent is not None else "halves by position"
    )


def halves(place, weight):
    """Parents of a tree of halves, each cut across its longer side."""
    parents = [-1] * len(place)

    def cut(members):
        if len(members) == 1:
            return members[0]
        axis = np.ptp(place[members], axis=0).argmax()
        order = members[np.argsort(place[members, axis], kind="stable")]
        below = np.cumsum(weight[order])
        at = int(np.clip(np.searchsorted(below, below[-1] / 2) + 1, 1, len(order) - 1))
        children = [cut(order[:at]), cut(order[at:])]
        parents.append(-1)
        for child in children:
            parents[child] = len(parents) - 1
        return len(parents) - 1

    cut(np.arange(len(place)))
    return parents


def contracted(parent, unit, units):
    """The file's tree with every group as one leaf and one root above all."""
    count, total = len(unit), len(parent)
    members = [set() for _ in range(total)]
    for subdomain in range(count):
        node = subdomain
        while node >= 0:
            members[node].add(int(unit[subdomain]))
            node = parent[node]
    # Inner nodes with two or more units below are the fronts; the others are parts of a leaf.
    inner = [node for node in range(count, total) if len(members[node]) > 1]
    new = {node: units + i for i, node in enumerate(inner)}
    root = units + len(inner)

    def above(node):
        node = parent[node]
        while node >= 0 and node not in new:
            node = parent[node]
        return new[node] if node >= 0 else root

    parents = [root] * units + [above(node) for node in inner]
    for subdomain in range(count):
        parents[unit[subdomain]] = above(subdomain)
    if parents.count(root) == 1:
        # There is one root already.
        return [-1 if node == root else node for node in parents]
    return [*parents, -1]


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


def regular_tree(leaves, dofs, conditions):
    """A square of `leaves` (a power of 2) equal subdomains with `dofs` dofs in all and two cracks,
    each of them in one leaf."""
    across = 1 << (leaves.bit_length() // 2)
    up = leaves // across
    nodes_x, nodes_y = math.sqrt(dofs / 2) / across, math.sqrt(dofs / 2) / up
    cracked = {(0, up // 2): conditions // 2, (across - 1, up // 2): conditions - conditions // 2}
    leaf_rows, inner_rows = [], []

    def cut(x0, x1, y0, y1):
        length_x, length_y = (x1 - x0) * nodes_x, (y1 - y0) * nodes_y
        around = ((x0 > 0) + (x1 < across)) * length_y + ((y0 > 0) + (y1 < up)) * length_x
        own = sum(c for (x, y), c in cracked.items() if x0 <= x < x1 and y0 <= y < y1)
        if (x1 - x0) * (y1 - y0) == 1:
            # A piece along a crack has the crack's length to either side.
            leaf_rows.append((0, round(2 * around) + 3 * own))
            return ("leaf", len(leaf_rows) - 1)
        if length_x >= length_y and x1 - x0 > 1 or y1 - y0 == 1:
            middle, separator = (x0 + x1) // 2, length_y
            children = cut(x0, middle, y0, y1), cut(middle, x1, y0, y1)
        else:
            middle, separator = (y0 + y1) // 2, length_x
            children = cut(x0, x1, y0, middle), cut(x0, x1, middle, y1)
        inner_rows.append((round(2 * separator), round(2 * around) + own, children))
        return ("inner", len(inner_rows) - 1)

    cut(0, across, 0, up)
    parents = np.full(leaves + len(inner_rows), -1)
    for i, (_, _, children) in enumerate(inner_rows):
        for kind, child in children:
            parents[child + (leaves if kind == "inner" else 0)] = leaves + i
    rows = np.array([row[:2] for row in leaf_rows + inner_rows])
    return Tree(parents, leaves, np.full(leaves, dofs // leaves), rows[:, 0], rows[:, 1], conditions, dofs // 2, dofs)


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
    sweeps: float           # of the measured run
    conditions: int
    inner_steps: int
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
        conditions=max(report["contact_conditions"], 1),
        inner_steps=max(report["inner_steps"], 1),
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


def owners(tree, work, ranks, pieces_per_rank):
    """Owner of every node: subtrees are split, the one with most work first, until there are enough
    pieces; they are dealt out, that with most work first, to the rank with least. A front above them
    belongs to the rank of its child with most work."""
    below = tree.children()
    pieces = [(-work[-1], len(tree.parent) - 1)]
    done = []
    while pieces and len(pieces) + len(done) < (ranks * pieces_per_rank if ranks > 1 else 1):
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


def predict(tree, rates, ranks, passes=3, pieces_per_rank=1):
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
    owner = owners(tree, work, ranks, pieces_per_rank)

    free = np.zeros(ranks)
    ready = np.zeros(len(own))
    root = len(own) - 1
    # What a rank owns whole comes first, then the fronts in which others have a part.
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
    solves = passes * down.max()

    crossing = [n for n in range(root) if owner[n] != owner[tree.parent[n]]]
    dofs = 2 * tree.points
    result_bytes = 13 * 8 * tree.points + 15 * 8 * tree.cells
    # The root's contact problem: dense factorizations, and products for the rest.
    dense = rates.inner_steps * rates.front_flop * np.array([tree.conditions, rates.conditions]) ** 3 / 3
    rest = max(rates.sweeps - dense[1], 0.0)
    sweeps = min(rates.sweeps, dense[1]) * (dense[0] / dense[1]) + rest * (tree.conditions / rates.conditions) ** 2
    remote = 1 - 1 / ranks
    times = {
        "leaves": leaf_of_rank.max(),
        "merges": max(ready[root] - own[root] - leaf_of_rank.max(), 0.0),
        "root": own[root],
        "sweeps": sweeps,
        "solves": solves,
        "recover": np.bincount(owner[: tree.leaves], tree.dofs * rates.recover_dof, ranks).max(),
        "read": dofs * rates.read_dof / min(ranks, rates.readers),
        "write": dofs * rates.write_dof + result_bytes * remote * rates.network_byte,
    }
    times["solve"] = sum(times[key] for key in ("leaves", "merges", "root", "sweeps", "solves", "recover"))
    times["total"] = times["solve"] + times["read"] + times["write"]
    times["serial"] = times["root"] + times["sweeps"]
    times["bytes"] = float(sum(tree.message()[n] for n in crossing))
    times["largest"] = float(max((tree.message()[n] for n in crossing), default=0.0))
    times["idle"] = ranks - len(set(owner.tolist()))
    return times


def row(ranks, dofs, times, first, ideal):
    def efficiency(key):
        return f"{100 * ideal(first[key]) / times[key]:.0f} %"

    return [
        ranks, runs.name_of(round(dofs)),
        *(f"{times[key]:.3g}" for key in ("leaves", "merges", "root", "sweeps", "solves", "recover", "solve")),
        efficiency("solve"), f"{100 * times['serial'] / times['solve']:.0f} %",
        f"{times['read']:.2g}", f"{times['write']:.2g}", f"{times['total']:.3g}", efficiency("total"),
        f"{times['bytes'] / 1e6:.3g}", f"{times['largest'] / 1e6:.3g}",
    ]


HEADS = ["ranks", "dofs", "leaves", "merges", "root", "sweeps", "solves", "recover", "solve phases", "efficiency",
         "root's share", "read", "write", "whole run", "efficiency", "MB sent", "largest S, MB"]


def print_table(rows):
    print("| " + " | ".join(HEADS) + " |\n|" + "--:|" * len(HEADS))
    for cells in rows:
        print("| " + " | ".join(map(str, cells)) + " |")
    print()


def bottleneck(name, all_times):
    """From how many ranks on the parts that don't get less with more of them are more than half."""
    parts = [
        ("the root's front and sweeps", ("root", "sweeps"), "solve", "solve phases"),
        ("they and the fronts on the way to the root", ("root", "sweeps", "merges"), "solve", "solve phases"),
        ("the root's front, sweeps and writing", ("root", "sweeps", "write"), "total", "whole run"),
    ]
    said = []
    for words, keys, of, whole in parts:
        half = (n for n, times in all_times if sum(times[key] for key in keys) > times[of] / 2)
        at = next(half, None)
        where = f"from {at} ranks on" if at else f"nowhere up to {all_times[-1][0]} ranks"
        said.append(f"{words} are more than half of the {whole} {where}")
    print(f"{name} scaling: {'; '.join(said)}.\n")


def compare(path, report, strong):
    """Times measured by scripts/scaling beside the predicted, where they are of this problem."""
    with open(path) as file:
        rows = [row for row in csv.DictReader(file) if row["kind"] == "strong" and int(row["dofs"]) == report["dofs"]]
    for measured in rows:
        times = strong(int(measured["ranks"]))
        print(
            f"{measured['ranks']} ranks measured: solve phases {float(measured['solve']):.3f} s "
            f"({times['solve']:.3f} predicted), whole run {float(measured['total']):.3f} s "
            f"({times['total']:.3f} predicted), {measured['bytes_sent'] or 'no'} bytes counted "
            f"({times['bytes']:.0f} predicted)\n"
        )


def draw(path, strong, weak):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "model", "font.size": 9})
    figure, panels = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
    parts = ["leaves", "recover", "merges", "solves", "root", "sweeps", "read", "write"]
    colors = ["#5b8ff9", "#3a9d5d", "#1f5fa8", "#a7c7f9", "#d62728", "#ff9d4d", "#9aa5b1", "#6b7785"]
    for axes, (name, times) in zip(panels, (("Strong", strong), ("Weak", weak))):
        ranks = np.array([n for n, _ in times])
        values = np.array([[t[part] for _, t in times] for part in parts])
        axes.stackplot(ranks, values / values.sum(axis=0), labels=parts, colors=colors)
        for key, style in (("solve", "k-o"), ("total", "k--s")):
            first = times[0][1][key] * times[0][0]
            scale = ranks if name == "Strong" else np.full(len(ranks), times[0][0])
            efficiency = first / (scale * np.array([t[key] for _, t in times]))
            label = "efficiency, " + ("solve phases" if key == "solve" else "whole run")
            axes.plot(ranks, efficiency, style, ms=3.5, lw=1.3, label=label)
        axes.set_xscale("log", base=2)
        axes.set_xticks(ranks, [str(n) for n in ranks])
        axes.minorticks_off()
        axes.set_ylim(0, 1.05)
        axes.set_xlabel("ranks")
        axes.set_title(f"{name} scaling, predicted: shares of the time")
        axes.spines[["top", "right"]].set_visible(False)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncol=5, frameon=False)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Date": None})
    print(f"picture: {path}\n")


def main():
    parser = argparse.ArgumentParser(prog="scaling predict", description=__doc__.splitlines()[0])
    parser.add_argument("problem", type=pathlib.Path, help="problem file")
    parser.add_argument("report", type=pathlib.Path, help="report of its run on one rank")
    parser.add_argument("--ranks", default="16,64,256,1024", help="by commas (default: %(default)s)")
    parser.add_argument("--bandwidth", type=float, default=12.5, help="of the network, GB/s (default: %(default)s)")
    parser.add_argument("--latency", type=float, default=2.0, help="of the network, µs (default: %(default)s)")
    parser.add_argument("--readers", type=int, default=16,
                        help="ranks that the file system serves at full speed at once (default: %(default)s)")
    parser.add_argument("--front-gflops", type=float,
                        help="speed of a front (default: the report's, or a dense one's here without hierarchy)")
    parser.add_argument("--fronts-in", choices=["interface", "factorize"], default="interface",
                        help="phase of the report that holds the fronts (default: %(default)s)")
    parser.add_argument("--weak", type=float, help="dofs for each rank of the growing problem "
                        "(default: those of the problem on 64 ranks)")
    parser.add_argument("--leaves-per-rank", type=int, default=2, help="of the growing problem (default: 2)")
    parser.add_argument("--pieces-per-rank", type=int, default=1, help="subtrees (default: 1)")
    parser.add_argument("--passes", type=int, default=3, help="solves up and down the tree (default: 3)")
    parser.add_argument("--measured", type=pathlib.Path, help="scaling.csv to compare with")
    parser.add_argument("--svg", type=pathlib.Path, help="picture to draw")
    arguments = parser.parse_args()

    report = json.loads(arguments.report.read_text())
    if report["ranks"] != 1:
        parser.error(f"{arguments.report}: the report has to be of a run on one rank")
    tree, origin = read_tree(arguments.problem)
    seconds = report["seconds"]
    flops = tree.front_flops().sum()
    leaf_seconds = seconds["factorize"]
    if arguments.front_gflops:
        front_flop, source = 1e-9 / arguments.front_gflops, "given"
    elif arguments.fronts_in == "interface" and origin.startswith("the problem") and flops > 0:
        front_flop, source = seconds["interface"] / flops, "from the report"
    else:
        front_flop, source = dense_flop(), "of a dense front here"
    if arguments.fronts_in == "factorize":
        leaf_seconds = max(leaf_seconds - front_flop * flops, 0.1 * leaf_seconds)
    rates = measured_rates(tree, report, arguments, leaf_seconds, front_flop)
    root = len(tree.parent) - 1
    print(
        f"Tree: {origin}; {tree.leaves} leaves, {len(tree.parent) - tree.leaves} fronts, "
        f"{tree.front_flops().sum() / 1e9:.3g} GFlop in fronts, {tree.front_flops()[root] / 1e9:.3g} in the root's "
        f"(e = {tree.eliminated[root]}, b = {tree.kept[root]}), {tree.leaf_flops().sum() / 1e9:.3g} in leaves by "
        f"the formula; {tree.conditions} contact conditions.\n"
        f"Rates: leaves {1e-9 / rates.leaf_flop:.3g} GFlop/s, fronts {1e-9 / front_flop:.3g} GFlop/s ({source}), "
        f"memory {1e-9 / rates.memory_byte:.3g} GB/s, network {arguments.bandwidth:g} GB/s and "
        f"{arguments.latency:g} µs, assembly {1e9 * rates.leaf_dof:.0f} ns, recovery {1e9 * rates.recover_dof:.0f} ns, "
        f"reading {1e9 * rates.read_dof:.0f} ns, writing {1e9 * rates.write_dof:.0f} ns a dof.\n"
    )

    def strong(ranks):
        return predict(tree, rates, ranks, arguments.passes, arguments.pieces_per_rank)

    def weak_tree(ranks):
        dofs = round(per_rank * ranks)
        conditions = round(tree.conditions * math.sqrt(dofs / report["dofs"]))
        return regular_tree(arguments.leaves_per_rank * ranks, dofs, conditions)

    def weak(ranks):
        return predict(weak_tree(ranks), rates, ranks, arguments.passes, arguments.pieces_per_rank)

    per_rank = arguments.weak or report["dofs"] / 64
    counts = [1, *(int(n) for n in arguments.ranks.split(","))]
    strong_times = [(n, strong(n)) for n in counts]
    weak_times = [(n, weak(n)) for n in counts]

    print("### Strong scaling, predicted\n")
    first = strong_times[0][1]
    print_table([row(n, report["dofs"], t, first, lambda s, n=n: s / n) for n, t in strong_times])
    idle = [f"{t['idle']} of {n}" for n, t in strong_times if t["idle"]]
    if idle:
        print(f"Ranks without work, for want of leaves: {', '.join(idle)}.\n")
    solve = sum(report["seconds"][phase] for phase in runs.SOLVE_PHASES)
    print(f"Measured on one rank: solve phases {solve:.3f} s, whole run {report['seconds']['total']:.3f} s.\n")
    if arguments.measured:
        compare(arguments.measured, report, strong)
    print("### Weak scaling, predicted\n")
    first = weak_times[0][1]
    print_table([row(n, per_rank * n, t, first, lambda s: s) for n, t in weak_times])
    doubled = [1 << i for i in range(1, 21)]
    bottleneck("Strong", [(n, strong(n)) for n in doubled if n <= 2 * tree.leaves])
    bottleneck("Weak", [(n, weak(n)) for n in doubled if n <= 16384])
    if arguments.svg:
        draw(arguments.svg, strong_times, weak_times)


main()
