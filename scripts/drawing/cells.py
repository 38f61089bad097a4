"""Cells of a grid in VTKHDF."""

import numpy as np


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
